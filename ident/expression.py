"""The grammar in which every equation of the program is written, and what can be read off an equation.

An equation is one line of text:

    q' = (e - q) / tau                a rate of a state
    w = q                             a signal
    p := clip(p, q - b, q + b)        a memory: on the right, p is its value at the start of the step

Its right-hand side is arithmetic, comparison and a fixed list of functions on named quantities, nothing else: it is
parsed, checked node by node, and never handed to the interpreter as it came. Simulation, frequency response,
documentation and the page's mathematics all come from this one text.
"""

from __future__ import annotations

import ast
import keyword
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.interpolation import interpolated

FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "abs": np.abs,
    "clip": np.clip,
    "cos": np.cos,
    "exp": np.exp,
    "max": np.maximum,
    "min": np.minimum,
    "sgn": np.sign,
    "sin": np.sin,
    "sqrt": np.sqrt,
    "tanh": np.tanh,
    "where": np.where,
    "lag": lambda x, _T: x,
    "lag2": lambda x, _a1, _a2: x,
    "delay": lambda x, _T: x,
    "dry": lambda limit, _speed, _acceleration, _mass: 0.0 * limit,
    "lines": lambda x, *table: interpolated("lines", x, *table),
    "monotone": lambda x, *table: interpolated("monotone", x, *table),
}
"""Functions an equation may call, with their numpy meaning for signals that stand still.

Those that remember are exact for a strength of zero: `lag` is x/(T s + 1), `lag2` x/(a2 s² + a1 s + 1), `delay`
x(t − T), and `dry` the friction force that takes at most `limit`, and at most what stops `mass` within the step.
`lines(x, x1, y1, x2, y2, …)` and `monotone(…)` are tables over rising nodes: straight lines, or cubics without
overshoot (PCHIP), and straight beyond the ends.
"""

DYNAMIC = ("lag", "lag2", "delay", "dry")
"""The functions that remember."""

TABLES = ("lines", "monotone")
"""The functions that are given by a table: x, then two nodes or more."""

_ARGUMENTS = {"clip": 3, "max": 2, "min": 2, "where": 3, "lag": 2, "lag2": 3, "delay": 2, "dry": 4}
_OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.USub, ast.UAdd, ast.Lt, ast.LtE, ast.Gt, ast.GtE)
_NODES = (ast.Expression, ast.BinOp, ast.UnaryOp, ast.Compare, ast.Call, ast.Name, ast.Load, ast.Constant, *_OPERATORS)
_LONGEST = 1000  # characters; a longer text is no equation


@dataclass(frozen=True)
class Equation:
    """One line of the model: `text` in the grammar, the `place` of the chain it belongs to, and what it says.

    Raises Unusable, with the character at fault, where the text is outside the grammar.
    """

    text: str
    place: str = ""
    meaning: str = ""

    def __post_init__(self) -> None:
        _ = self.tree

    @property
    def target(self) -> str:
        """The quantity on the left, without the prime of a rate or the colon of a memory."""
        return self._left.removesuffix("'").removesuffix(":").rstrip()

    @property
    def is_memory(self) -> bool:
        """True for ``x := ...``."""
        return self._left.endswith(":")

    @property
    def is_rate(self) -> bool:
        """True for ``x' = ...``."""
        return self._left.endswith("'")

    @property
    def _left(self) -> str:
        return self.text.partition("=")[0].strip()

    @cached_property
    def tree(self) -> ast.expr:
        """The right-hand side as a checked syntax tree."""
        left, equals, right = self.text.partition("=")
        if not equals or not self.target.isidentifier() or len(self.text) > _LONGEST:
            raise _refused(self.text, 0, "an equation reads NAME = , NAME' = or NAME := EXPRESSION")
        return _parse(right, self.text, len(left) + 1)

    @cached_property
    def names(self) -> frozenset[str]:
        """The quantities on the right, functions left out."""
        called = {node.func.id for node in ast.walk(self.tree) if isinstance(node, ast.Call)}  # type: ignore[attr-defined]
        return frozenset(node.id for node in ast.walk(self.tree) if isinstance(node, ast.Name)) - called

    def renamed(self, names: Mapping[str, str], target: str) -> Equation:
        """The same equation with other names for what it reads, and another target."""
        values = {name: ast.Name(other, ast.Load()) for name, other in names.items()}
        sign = "' = " if self.is_rate else " := " if self.is_memory else " = "
        return Equation(f"{target}{sign}{_replaced(self.python, values)}", self.place, self.meaning)

    def with_values(self, values: Mapping[str, ast.expr]) -> Equation:
        """The same equation with expressions in place of names."""
        if not self.names & values.keys():
            return self
        left, _, _ = self.text.partition("=")
        return Equation(f"{left}= {_replaced(self.python, values)}", self.place, self.meaning)

    def value(self, known: Mapping[str, Any]) -> Any:
        """The right-hand side where every quantity it reads has a value: numbers or arrays that broadcast."""
        namespace = {"__builtins__": {}, **FUNCTIONS}
        # The tree passed the grammar, so nothing but arithmetic on `known` can happen here.
        return eval(compile(ast.Expression(self.tree), "<equation>", "eval"), namespace, dict(known))

    @property
    def python(self) -> str:
        """The right-hand side as Python source, to be put into a generated function."""
        return ast.unparse(self.tree)


def _replaced(text: str, values: Mapping[str, ast.expr]) -> str:
    class Replace(ast.NodeTransformer):
        def visit_Name(self, node: ast.Name) -> ast.expr:
            return values.get(node.id, node)

    return ast.unparse(Replace().visit(ast.parse(text, mode="eval")))


def _parse(right: str, text: str, offset: int) -> ast.expr:
    padding = len(right) - len(right.lstrip())
    try:
        tree = ast.parse(right.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        column = getattr(error, "offset", None) or 1
        raise _refused(text, offset + padding + column - 1, "not an expression") from None
    for node in ast.walk(tree):
        fault = _fault(node)
        if fault:
            raise _refused(text, offset + padding + getattr(node, "col_offset", 0), fault)
    return tree.body


def _fault(node: ast.AST) -> str | None:
    """Why a node is outside the grammar, or None."""
    if isinstance(node, ast.Call):
        if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS or node.keywords:
            return f"unknown function; known are {', '.join(FUNCTIONS)}"
        if node.func.id in TABLES:
            whole = len(node.args) >= 5 and len(node.args) % 2 == 1
            return None if whole else f"{node.func.id} takes x and the pairs x1, y1, x2, y2 of its table"
        wanted = _ARGUMENTS.get(node.func.id, 1)
        return None if len(node.args) == wanted else f"{node.func.id} takes {wanted} argument(s)"
    if isinstance(node, ast.Compare):
        return None if len(node.ops) == 1 else "one comparison at a time"
    if isinstance(node, ast.Constant):
        return None if type(node.value) in (int, float) else "only numbers"
    if isinstance(node, ast.Name):
        return "a reserved word" if keyword.iskeyword(node.id) or node.id.startswith("_") else None
    return None if isinstance(node, _NODES) else "only numbers, names, + - * / **, comparisons and functions"


def _refused(text: str, column: int, reason: str) -> Unusable:
    return Unusable("bad-equation", reason, f"equation {text[:80]!r}, character {column + 1}", "mend it there")
