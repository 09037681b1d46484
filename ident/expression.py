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
    "lag": lambda x, T: x,
    "lag2": lambda x, a1, a2: x,
    "delay": lambda x, T: x,
    "dry": lambda limit, speed, acceleration, mass: 0.0 * limit,
}
"""Functions an equation may call, with their numpy meaning for signals that stand still.

Those that remember are exact for a strength of zero: `lag` is x/(T s + 1), `lag2` x/(a2 s² + a1 s + 1), `delay`
x(t − T), and `dry` the friction force that takes at most `limit`, and at most what stops `mass` within the step.
"""

DYNAMIC = ("lag", "lag2", "delay", "dry")
"""The functions that remember."""

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


# MathML -----------------------------------------------------------------------------------------------------------

_GREEK = {
    "tau": "τ", "omega": "ω", "zeta": "ζ", "xi": "ξ", "beta": "β", "kappa": "κ", "alpha": "α", "sigma": "σ", "mu": "μ",
}  # fmt: skip
_BINARY = {ast.Add: "+", ast.Sub: "−", ast.Mult: "·", ast.Lt: "&lt;", ast.LtE: "≤", ast.Gt: "&gt;", ast.GtE: "≥"}
_RANK = {ast.Add: 1, ast.Sub: 1, ast.Mult: 2, ast.Div: 2, ast.USub: 3, ast.UAdd: 3, ast.Pow: 4}


def mathml(text: str) -> str:
    """An equation of the grammar as a MathML element, for the documentation and the page."""
    equation = Equation(text)
    left = _symbol(equation.target)
    if equation.is_rate:
        left = f"<mover>{left}<mo>˙</mo></mover>"
    equals = "≔" if equation.is_memory else "="
    return f"<math display='block'><mrow>{left}<mo>{equals}</mo>{_render(equation.tree)}</mrow></math>"


def _symbol(name: str) -> str:
    """``m0`` → m with subscript 0, ``tau`` → τ, ``y_fb`` → y with subscript fb."""
    head, _, tail = name.partition("_")
    if not tail and len(name) > 1 and name not in _GREEK:
        head, tail = name[0], name[1:]
    letter = f"<mi>{_GREEK.get(head, head)}</mi>"
    return f"<msub>{letter}<mi>{tail}</mi></msub>" if tail else letter


def _render(node: ast.expr) -> str:
    match node:
        case ast.Constant(value=int() | float() as value):
            return f"<mn>{float(value):g}</mn>"
        case ast.Name(id=name):
            return _symbol(name)
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            return f"<mfrac><mrow>{_render(left)}</mrow><mrow>{_render(right)}</mrow></mfrac>"
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            return f"<msup>{_inside(left, 5)}<mrow>{_render(right)}</mrow></msup>"
        case ast.BinOp(left=left, op=op, right=right):
            rank = _RANK[type(op)]
            tight = rank + 1 if isinstance(op, ast.Sub) else rank
            return f"{_inside(left, rank)}<mo>{_BINARY[type(op)]}</mo>{_inside(right, tight)}"
        case ast.UnaryOp(op=op, operand=operand):
            return f"<mo>{'−' if isinstance(op, ast.USub) else '+'}</mo>{_inside(operand, 3)}"
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            return f"{_render(left)}<mo>{_BINARY[type(op)]}</mo>{_render(right)}"
        case ast.Call(func=ast.Name(id="sqrt"), args=[argument]):
            return f"<msqrt>{_render(argument)}</msqrt>"
        case ast.Call(func=ast.Name(id="abs"), args=[argument]):
            return f"<mrow><mo>|</mo>{_render(argument)}<mo>|</mo></mrow>"
        case ast.Call(func=ast.Name(id="lag"), args=[x, T]):
            return _filtered(x, f"<mn>1</mn><mo>+</mo>{_inside(T, 2)}<mo>·</mo><mi>s</mi>")
        case ast.Call(func=ast.Name(id="lag2"), args=[x, a1, a2]):
            first, second = (
                f"{_inside(a1, 2)}<mo>·</mo><mi>s</mi>",
                f"{_inside(a2, 2)}<mo>·</mo><msup><mi>s</mi><mn>2</mn></msup>",
            )
            return _filtered(x, f"<mn>1</mn><mo>+</mo>{first}<mo>+</mo>{second}")
        case ast.Call(func=ast.Name(id="delay"), args=[x, T]):
            return f"{_inside(x, 9)}<mo>⁡</mo><mrow><mo>(</mo><mi>t</mi><mo>−</mo>{_inside(T, 2)}<mo>)</mo></mrow>"
        case ast.Call(func=ast.Name(id=name), args=arguments):
            listed = "<mo>,</mo>".join(map(_render, arguments))
            return f"<mi>{name}</mi><mo>⁡</mo><mrow><mo>(</mo>{listed}<mo>)</mo></mrow>"
        case _:
            raise TypeError(f"{ast.dump(node)} passed the grammar but has no MathML")


def _filtered(x: ast.expr, denominator: str) -> str:
    return f"<mfrac><mn>1</mn><mrow>{denominator}</mrow></mfrac><mo>·</mo>{_inside(x, 2)}"


def _inside(node: ast.expr, rank: int) -> str:
    """The operand, in parentheses where it binds weaker than `rank`."""
    own = _RANK[type(node.op)] if isinstance(node, ast.BinOp | ast.UnaryOp) else 9
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
        own = 9  # a fraction needs no parentheses
    text = _render(node)
    return f"<mrow><mo>(</mo>{text}<mo>)</mo></mrow>" if own < rank else f"<mrow>{text}</mrow>"
