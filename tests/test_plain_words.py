"""What a user reads has the field's terms and short sentences: templates, string literals, help and documents."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

import pytest

from tests.words.old_texts import GONE, KEPT, has

ROOT = Path(__file__).resolve().parents[1]
BANNED = {
    "mend": "edit, correct", "mended": "corrected", "foretell": "predict", "foretells": "predicts", "anew": "again",
    "foretold": "predicted", "farther": "further", "turned round": "inverted", "as it came": "unchanged",
    "for want of": "because … is missing", "nobody": "no user", "bears": "has", "hands on": "output",
    "stands for": "is, means", "no list holds": "unknown", "runs to verify": "validation data",
    "runs to fit": "estimation data", "verify runs": "validation data", "fit runs": "estimation data",
    "what is left": "residual", "something is left": "unmodelled dynamics remain", "in force": "approved",
    "who bears": "owner", "hangs on": "depends on", "tell apart": "separate", "tells apart": "separates",
    "beside the command": "in addition to the command", "beside the catalogue": "in addition to the library",
}  # fmt: skip
"""Words of the old texts, each with the word that replaces it."""
LONGEST = {
    "README.md": 18.0,
    "docs/index.md": 20.0,
    "docs/which-machine.md": 20.0,
    "docs/accuracy.md": 20.0,
    "docs/glossary.md": 20.0,
    "docs/diagnosis.md": 20.0,
    "docs/lab.md": 20.0,
    "docs/cli.md": 20.0,
    "CONTRIBUTING.md": 20.0,
}
"""Words of a sentence in the mean of a page, at most; other pages join as they are rewritten."""
RECORDS = {
    "measured.md",
    "measured-cases.md",
    "blind-trials.md",
    "diagnosis-trials.md",
    "benchmarks.md",
    "criteria.md",
    "faults.md",
}
"""Pages that quote what earlier versions said, or that a measurement or a comment of the source writes."""
PAGE = 20.0
"""The same of the sentences of a template."""


class Text(HTMLParser):
    """What a reader of a template reads: text, and the attributes that browsers show or read out."""

    BLOCKS = frozenset(
        "p li td th h1 h2 h3 h4 label button summary caption legend dd dt option div section".split()  # noqa: SIM905
    )

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Attributes; a block ends a sentence."""
        if tag in self.BLOCKS:
            self.found.append("\n\n")
        for name, value in attrs:
            if name in ("title", "aria-label", "placeholder", "alt") and value:
                self.found.append(f"\n\n{value}\n\n")

    def handle_data(self, data: str) -> None:
        """Text."""
        self.found.append(data)


QUOTED = re.compile(r'"((?:[^"\\\n]|\\.)*)"|`((?:[^`\\]|\\.)*)`')
"""A string in an expression of a template or in a script."""


def quoted(text: str) -> list[str]:
    """The strings of a text that are words: with a space in them, or a capital in front; others are names."""
    found = ["".join(pair) for pair in QUOTED.findall(text)]
    return [said for said in found if " " in said or said[:1].isupper()]


@cache
def template(file: Path) -> str:
    """The text of a template: what is filled in counts as a word, and the strings in its expressions follow."""
    whole = re.sub(r"\{#.*?#\}", " ", file.read_text(encoding="utf-8"), flags=re.DOTALL)
    filled = re.findall(r"\{\{.*?\}\}|\{%.*?%\}", whole, flags=re.DOTALL)
    reader = Text()
    reader.feed(re.sub(r"\{\{.*?\}\}", "x", re.sub(r"\{%.*?%\}", " ", whole, flags=re.DOTALL), flags=re.DOTALL))
    return "\n\n".join(["".join(reader.found), *(said for part in filled for said in quoted(part))])


def script(file: Path) -> str:
    """The strings of a script, without its comments."""
    text = re.sub(r"/\*.*?\*/|(?<!:)//.*?$", " ", file.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    return "\n\n".join(quoted(text))


def literals(file: Path) -> Iterator[str]:
    """String literals of a module that are words, without its docstrings; those of a command are its help."""
    nodes = list(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))
    docstrings = {
        id(line.value)
        for node in nodes
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
        for line in node.body
        if isinstance(line, ast.Expr)
    }
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
            yield node.value


@cache
def shown() -> dict[str, str]:
    """What a user meets, by the file that has it."""
    templates = (ROOT / "app" / "pages" / "templates").glob("*.html")
    found = {str(file.relative_to(ROOT)): template(file) for file in templates}
    for file in (ROOT / "app" / "pages" / "static").glob("*.js"):
        found[str(file.relative_to(ROOT))] = script(file)
    for folder in ("app", "ident"):
        for file in (ROOT / folder).rglob("*.py"):
            found[str(file.relative_to(ROOT))] = "\n\n".join(literals(file))
    pages = [*(file for file in (ROOT / "docs").glob("*.md") if file.name not in RECORDS), *map(ROOT.joinpath, LONGEST)]
    return found | {str(file.relative_to(ROOT)): file.read_text(encoding="utf-8") for file in pages}


def sentences(text: str) -> list[list[str]]:
    """The words of each sentence of running text: no listings, tables, headings, or lines of fewer than four words."""
    text = re.sub(r"```.*?```|<!--.*?-->|<[^>]+>", " ", text, flags=re.DOTALL)
    found = []
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[*-]|\d+\.) )|\n(?=#)", text):
        if re.match(r"\s*[|#!]", block.lstrip("\n")) or block.startswith("    "):
            continue
        plain = re.sub(r"`[^`]*`", "x", re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", block))
        for sentence in re.split(r"(?<=[.!?:])\s+", plain.strip()):
            words = re.findall(r"[^\W_][\w'’.,-]*", sentence)
            if len(words) > 3:
                found.append(words)
    return found


def mean(text: str) -> float:
    """Words of a sentence, in the mean."""
    found = sentences(text)
    return sum(map(len, found)) / max(len(found), 1)


def test_no_text_has_a_word_that_was_given_up():
    """Case does not count, nor does what is part of a longer word."""
    held = re.compile(rf"\b({'|'.join(sorted(BANNED, key=len, reverse=True))})\b", re.IGNORECASE)
    found = [
        f"{name}: {at[0]!r}, say {BANNED[at[0].lower()]}: {text[max(0, at.start() - 30) : at.end() + 30]!r}"
        for name, text in shown().items()
        for at in held.finditer(text)
    ]
    assert not found, "\n".join(found)


def test_no_text_that_readers_stumbled_over_comes_back():
    found = [f"{name}: {part!r}" for name, text in shown().items() for part in GONE if has(text, part)]
    assert not found, "\n".join(found)


@pytest.mark.parametrize("part", KEPT)
def test_what_is_kept_with_a_reason_is_still_there(part):
    assert any(has(text, part) for text in shown().values())


def test_a_text_that_came_back_is_seen_over_lines_and_as_a_label():
    assert has("Effects: a start that waits\n  for enough drive.", "a start that waits for enough drive")
    assert has("\n\n  Mend…\n\n", "Mend…")
    assert not has("mend.html, Mend… it", "Mend…")


@pytest.mark.parametrize("name", LONGEST)
def test_the_sentences_of_a_page_are_short(name):
    assert mean((ROOT / name).read_text(encoding="utf-8")) <= LONGEST[name]


def test_the_sentences_of_a_template_are_short():
    """Where it has any."""
    templates = {name: text for name, text in shown().items() if name.endswith(".html") and sentences(text)}
    assert len(templates) > 20
    assert not {name: round(mean(text), 1) for name, text in templates.items() if mean(text) > PAGE}


def test_a_term_on_a_page_is_in_the_glossary():
    """A template names it as the glossary does; a document links to its heading."""
    text = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    terms = {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in re.findall(r"^#+ (.+)$", text, re.M)}
    templates = "".join(file.read_text("utf-8") for file in (ROOT / "app" / "pages" / "templates").glob("*.html"))
    documents = "".join(file.read_text("utf-8") for file in [*(ROOT / "docs").glob("*.md"), ROOT / "README.md"])
    named = {name.replace(" ", "-") for name in re.findall(r"\{\{ term\(\"([^\"]+)\"", templates)}
    linked = set(re.findall(r"glossary(?:\.md)?#([\w-]+)", documents))
    assert len(named) > 8
    assert linked
    assert not (named | linked) - terms
    assert 'href="/manual/glossary#' in templates


@pytest.mark.parametrize(
    ("text", "words"),
    [("One two three four. Five six seven eight nine.", 4.5), ("# A heading of many words\n\nOne `x y` three four", 4)],
)
def test_a_sentence_is_counted_as_a_reader_would(text, words):
    assert mean(text) == words
