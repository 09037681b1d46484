"""A figure by name: what draws it of a fit beside its data, and the options that it takes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ident.figures.look import Look
from ident.figures.render import Chart
from ident.figures.study import Study
from ident.presets.model import Kind

Options = Mapping[str, Any]


@dataclass(frozen=True)
class Drawing:
    """A figure: the name that a reader asks for, the title of its tab, what draws it, and its options.

    Every model of the kind `of` has it, but for models whose preset names other figures.
    """

    name: str
    title: str
    draw: Callable[[Study, Look, Options], Chart]
    options: tuple[str, ...] = ()
    of: Kind = "chain"
