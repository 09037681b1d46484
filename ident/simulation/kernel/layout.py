"""Where things are in a kernel's buffer: rows of lanes."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import CodeType

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import INPUT, Chain
from ident.simulation.kernel.machine_code import WIDE, Advance, Fed, address, advance
from ident.simulation.kernel.source import constants, evaluated

HELD, SHARE = "held", "share"
"""Rows that the packing fills: 1 where a lane's command is held between samples; the delay's fraction of a step."""

BEYOND = "beyond"
"""The input that says by how much the mean of the command over a step is beyond that of its ends: see ident.slopes."""


@dataclass(frozen=True)
class Filter:
    """One `lag` or `lag2` of the equations: its order, its input, its coefficients, and where its rows begin."""

    order: int
    input: ast.expr
    coefficients: tuple[ast.expr, ...]  # T, or a1 and a2: expressions of symbols only
    first: int  # of the rows that it has in the buffer


@dataclass(frozen=True)
class Kernel:
    """The generated kernel of a chain and one output, and where things are in its buffer (rows of lanes).

    `advance(b, commands, forces, command_at, force_at, first, last, every, out, stride)` takes eight lanes, those with
    which the buffer b begins, over the steps first to last − 1 and writes the output of every `every`-th of them to the
    flat array out, rows `stride` apart. Step k of a lane begins at commands[command_at[lane] + k], which its delay
    shifts, and at row force_at[lane] + k of the forces, which have a column for each measured input, and reads up to
    the next value.
    """

    chain: Chain
    output: str
    lines: tuple[str, ...]
    rows: int
    constants: tuple[tuple[int, ast.expr], ...]
    filters: tuple[Filter, ...]
    states: Mapping[str, int]
    memories: Mapping[str, int]
    inputs: Mapping[str, int]  # the rows previous, current, next begin here, one triple an input
    shift: ast.expr | None  # delay of the command
    shown: int  # the row of the output
    beside: Mapping[str, int] = field(default_factory=dict)  # rows of further channels, as at the begin of the step

    @cached_property
    def advance(self) -> Advance:
        """The compiled function."""
        return advance(self.lines, self._fed, self.shown, WIDE)

    def address(self, lanes: int) -> tuple[int, object]:
        """Where the machine code of :attr:`advance` stands for the first `lanes` alone, and what keeps it there."""
        return address(self.lines, self._fed, self.shown, lanes)

    def fill_constants(self, rows: NDArray[np.float64], values: Mapping[str, NDArray[np.float64]]) -> None:
        """Put what depends on symbols alone into its rows of a buffer (rows, lanes), by `values` of each symbol."""
        for (row, _), value in zip(self.constants, evaluated(self._constants, values), strict=True):
            rows[row] = value

    @cached_property
    def _constants(self) -> CodeType:
        return constants([node for _, node in self.constants])

    @property
    def _fed(self) -> tuple[Fed, ...]:
        measured = self.measured
        return tuple(
            (row + 2, "commands", 0, 1) if name == INPUT else (row + 2, "forces", measured.index(name), len(measured))
            for name, row in self.inputs.items()
        )

    @property
    def measured(self) -> tuple[str, ...]:
        """The inputs beside the command, in the order of the columns of `forces`."""
        return tuple(name for name in self.inputs if name != INPUT)


def filter_rows(order: int) -> int:
    """Rows of a filter in the buffer: its states, then its gains at the start, over half a step and over the whole."""
    return order + order * sum(order + inputs for inputs in (1, 2, 3))
