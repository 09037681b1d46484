"""A sentence is one message: its text stands in one place, whole, and its values are named."""

from __future__ import annotations

import ast
import re
import string
from collections.abc import Iterator
from pathlib import Path

import pytest

from ident.words.message import KINDS, Message, message, said
from ident.words.messages import MESSAGES

ROOT = Path(__file__).parents[2]
CHECKS = tuple(sorted(str(path.relative_to(ROOT)) for path in (ROOT / "ident/checks").glob("*.py")))
ROOMS = ("ident/diagnosis/sentences.py", "ident/diagnosis/summary.py", *CHECKS)
"""Files that say everything by messages: no prose stands in them."""
PROSE = re.compile(r"[A-Za-z]{2,},? [a-z]|^[,;:.]? [a-z]{2}|[a-z] $")
"""Words in a row, or a piece that is to be joined to words."""


def program() -> list[Path]:
    """The files of the library and of the service."""
    return sorted(path for folder in ("ident", "app") for path in (ROOT / folder).rglob("*.py"))


def fields(key: str) -> dict[str, str]:
    """The values that a text names, with the kind of each."""
    return {name: kind for _, name, kind, _ in string.Formatter().parse(MESSAGES[key]) if name}


def calls() -> Iterator[tuple[str, list[str], set[str], bool]]:
    """Every message of the program: where, the keys it may have, its named values, and whether these are all."""
    for path in program():
        source = path.read_text(encoding="utf-8")
        if "message(" not in source:
            continue
        for node in ast.walk(ast.parse(source)):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id == "message"
                and node.args
            ):
                names = [one.value for one in ast.walk(node.args[0]) if isinstance(one, ast.Constant)]
                given = {one.arg for one in node.keywords if one.arg}
                whole = all(one.arg for one in node.keywords)
                yield f"{path.name}:{node.lineno}", [n for n in names if isinstance(n, str)], given, whole


def test_every_message_has_a_text_that_names_its_values_and_no_others():
    for where, keys, given, whole in calls():
        for key in keys:
            assert key in MESSAGES, where
            wanted = set(fields(key))
            assert (given == wanted) if whole else (given <= wanted), f"{where}: {key}"


def test_every_text_is_said_somewhere():
    sources = [
        p.read_text("utf-8")
        for folder in ("ident", "app")
        for p in (ROOT / folder).rglob("*.py")
        if p.name != "messages.py"
    ]
    unsaid = [key for key in MESSAGES if not any(f'"{key}"' in source for source in sources)]
    assert not unsaid


def test_every_value_is_of_a_kind_that_is_known():
    for key in MESSAGES:
        for name, kind in fields(key).items():
            assert not kind or kind in KINDS or re.fullmatch(r"[+#]?(\.\d+)?[gfed%]?", kind), f"{key}: {name}"


def pieces(source: str) -> list[str]:
    """What of a file is prose: strings with words in a row, but for docstrings and those of a type."""
    tree = ast.parse(source)
    documents = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    texts = [n for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)]
    return [one.value for one in texts if id(one) not in documents and PROSE.search(one.value)]


@pytest.mark.parametrize("room", ROOMS)
def test_no_sentence_is_joined_from_parts(room):
    assert pieces((ROOT / room).read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "source",
    [
        'said = f"with {them} the error falls"',
        'text = "The model" + " lacks " + name',
        'parts.append("Something is left")',
        'found = "{} ({} on verify runs)".format(a, b)',
    ],
)
def test_what_is_joined_from_parts_is_seen(source):
    assert pieces(source)


KEPT = {
    "ident/export/fmu.py": "names of a platform",
    "app/report/workbook.py": "XML",
    "app/pages/manual.py": "HTML",
    "ident/words/arguments.py": "a type in words, of its parts",
    "ident/design/experiment.py": "the unit of a time",
    "ident/fit/result.py": "the unit of a time",
    "ident/comparison/side_by_side.py": "a list: model, and what was held",
}
"""Files in which strings are joined that are no sentences, and what they are."""
_WORD = re.compile(r"[A-Za-z]{2,}")


def joined(source: str) -> list[int]:
    """The lines where words are added to words, or a part of a text depends on a condition within it."""
    found = []
    for node in ast.walk(ast.parse(source)):
        parts: list[ast.AST] = []
        if isinstance(node, ast.JoinedStr):
            parts = [one.value for one in node.values if isinstance(one, ast.FormattedValue)]
            parts = [one for one in parts if isinstance(one, ast.IfExp)]
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            parts = [node.left, node.right]
        elif isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add):
            parts = [node.value]
        within = isinstance(node, ast.JoinedStr)
        walked = [list(ast.walk(part)) for part in parts]
        walked = [
            nodes for nodes in walked if not any(isinstance(n, ast.List | ast.Tuple | ast.ListComp) for n in nodes)
        ]
        texts = [one.value for nodes in walked for one in nodes if isinstance(one, ast.Constant)]
        if any(isinstance(text, str) and _WORD.search(text) and (within or " " in text) for text in texts):
            found.append(node.lineno)
    return found


def test_no_sentence_of_the_program_is_joined_from_parts():
    """Everywhere in the library and the service, but where no sentence is made."""
    files = {str(path.relative_to(ROOT)): joined(path.read_text(encoding="utf-8")) for path in program()}
    found = {name: lines for name, lines in files.items() if lines}
    assert {name: lines for name, lines in found.items() if name not in KEPT} == {}
    assert not set(KEPT) - set(found)


@pytest.mark.parametrize(
    "source",
    [
        'said = "The model" + " lacks " + name',
        'said += f" The runs separate them by {so_far}."',
        """said = f"{name} {'is saved' if new else 'was saved'}" """,
    ],
)
def test_a_sentence_that_is_joined_is_seen_anywhere(source):
    assert joined(source)


@pytest.mark.parametrize("source", ['x = [*names] + ["a word here"]', 'size += "mm"', 'f"{one if one else two}"'])
def test_a_list_a_unit_and_a_choice_of_names_are_no_joined_sentences(source):
    assert not joined(source)


def test_a_key_a_channel_and_a_docstring_are_no_prose():
    assert pieces('"""What a run says, in words."""\nkey = "verdict.lacks"\nname = "load_pressure"\n') == []


def test_a_message_is_plain_data_with_those_within_it():
    inner = message("factor.units", value=10.0, units=[("cm", "mm")])
    size = message("unit.size", channel="force", run="b", ratio=10.1, factor=inner, others=["a"])
    assert str(size) == "force of run b is 10.1 times as large as that of a (near 10, the factor between cm and mm)"
    values = size.record()["values"]
    assert values["factor"] == {"key": "factor.units", "values": {"value": 10.0, "units": [["cm", "mm"]]}}


def test_a_value_is_put_into_words_by_its_kind_and_may_be_a_message():
    effects = [
        message("effect.one_of", names=["dead zone", "lap", "underlap"], probability=0.874),
        message("effect", names=["play"]),
    ]
    assert (
        str(message("summary.missing", effects=effects))
        == "Missing: dead zone, lap or underlap (one of them: probability 87 %) and play."
    )
    late = message("late.seconds", value=0.0123, error=0.001)
    assert said([message("delay", time=late, names=["a"]), Message("next.use", {})]) == (
        "At low frequency the output lags the command by 0.0123 ± 0.001 s. These data cannot tell which lag or delay "
        "causes it: a. "
        "Next: use the model as it is."
    )


def test_a_list_of_no_kind_has_all_of_its_items(monkeypatch):
    monkeypatch.setitem(MESSAGES, "shown", "The records show {effects}.")
    assert str(message("shown", effects=["play", "lag"])) == "The records show play and lag."


def test_a_share_has_a_space_before_its_unit():
    """As every number of the program has: Python's own form of per cent sets none."""
    assert KINDS["share"](0.694) == "69 %"
    for path in program():
        assert not re.search(r":[.0-9]*%\}", path.read_text(encoding="utf-8")), path.name
