"""The documentation on the service's own pages: the Markdown of `docs`, where the program runs beside it."""

from __future__ import annotations

import re
from collections.abc import Iterator, MutableMapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import urldefrag

from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token
from markdown_it.utils import OptionsDict
from markupsafe import Markup

DOCS = Path(__file__).resolve().parents[2] / "docs"
"""In a checkout and in the image; a wheel has none."""
AT = "/manual/"
FIRST = "index"
PICTURES = {".png": "image/png", ".svg": "image/svg+xml"}
"""Kinds of pictures that a page may show, by the ends of their names."""
_DIRECTIVE = re.compile(r"```\{(?!toctree)")  # what only Sphinx makes: such a page is in the site alone
_COMMENT = re.compile(r"^<!--.*?-->\n", re.MULTILINE | re.DOTALL)
_TOCTREE = re.compile(r"```\{toctree\}\n:caption: (?P<caption>.+)\n:hidden:\n\n(?P<names>[^`]+)```")


@dataclass(frozen=True)
class ManualPage:
    """A page of the documentation as HTML; `contents` are the groups of pages, each name with its title."""

    title: str
    text: Markup
    contents: tuple[tuple[str, tuple[tuple[str, str], ...]], ...]


def is_there() -> bool:
    """Whether the documentation lies beside the program."""
    return (DOCS / f"{FIRST}.md").is_file()


def file_of(name: str) -> Path | None:
    """The Markdown of a page, or a picture, by its name below `docs`; None where there is none."""
    path = DOCS / (name if name.endswith(tuple(PICTURES)) else f"{name}.md")
    inside = ".." not in PurePosixPath(name).parts and not name.startswith("/")
    if not inside or not path.is_file() or (path.suffix == ".md" and _DIRECTIVE.search(path.read_text("utf-8"))):
        return None
    return path


@cache
def manual_page(path: Path) -> ManualPage:
    """A page of the documentation; what it links to outside of it is no link here."""
    text = _COMMENT.sub("", path.read_text("utf-8"))
    parser = MarkdownIt("commonmark", {"html": False}, renderer_cls=_Renderer).enable("table")
    tokens = parser.parse(text)
    name = path.relative_to(DOCS).with_suffix("").as_posix()
    for token in tokens:
        _place(token, tokens)
        for child in token.children or ():
            _lead(child, name)
    return ManualPage(_title(text), Markup(parser.renderer.render(tokens, parser.options, {})), _contents())


class _Renderer(RendererHTML):
    def fence(self, tokens: Sequence[Token], idx: int, options: OptionsDict, env: MutableMapping[str, Any]) -> str:
        """A listing; a directive of the site is left out."""
        return "" if tokens[idx].info.startswith("{") else super().fence(tokens, idx, options, env)

    def table_open(self, tokens: Sequence[Token], idx: int, options: OptionsDict, env: MutableMapping[str, Any]) -> str:
        """A table scrolls inside the page."""
        return '<div class="scroll" tabindex="0">' + self.renderToken(tokens, idx, options, env)

    def table_close(
        self, tokens: Sequence[Token], idx: int, options: OptionsDict, env: MutableMapping[str, Any]
    ) -> str:
        """The end of what scrolls."""
        return self.renderToken(tokens, idx, options, env) + "</div>"


def _place(token: Token, tokens: Sequence[Token]) -> None:
    """Name a heading as the site does, so that links into a page lead there."""
    if token.type == "heading_open":
        words = tokens[tokens.index(token) + 1].content.lower()
        token.attrSet("id", re.sub(r"[^\w\- ]", "", words).replace(" ", "-"))


def _lead(token: Token, page: str) -> None:
    """Point a link or picture to where it is here."""
    kind = {"link_open": "href", "image": "src"}.get(token.type)
    if kind is None:
        return
    target, place = urldefrag(str(token.attrs[kind]))
    if re.match(r"\w+:", target) or not target:
        return
    name = _resolved(page, target)
    if name is not None and file_of(name) is not None:
        token.attrSet(kind, AT + name + (f"#{place}" if place else ""))
    elif token.type == "link_open":
        del token.attrs[kind]


def _resolved(page: str, target: str) -> str | None:
    """The name below `docs` of what a page names relative to itself."""
    path = (DOCS / page).parent / target
    path = path / "index.md" if path.is_dir() else path
    try:
        name = path.resolve().relative_to(DOCS).as_posix()
    except ValueError:
        return None
    return name.removesuffix(".md")


@cache
def _contents() -> tuple[tuple[str, tuple[tuple[str, str], ...]], ...]:
    return tuple(_groups((DOCS / f"{FIRST}.md").read_text("utf-8")))


def _groups(text: str) -> Iterator[tuple[str, tuple[tuple[str, str], ...]]]:
    """The captions of the index and the pages below each."""
    for group in _TOCTREE.finditer(text):
        found = [(name, file_of(name)) for name in group["names"].split()]
        yield group["caption"], tuple((name, _title(path.read_text("utf-8"))) for name, path in found if path)


def _title(text: str) -> str:
    return next(line.removeprefix("# ") for line in text.splitlines() if line.startswith("# "))
