"""Equations as MathML, for the documentation and the page."""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping, Sequence
from copy import deepcopy

from ident.equations.equation import Equation

_GREEK = {
    "tau": "τ",
    "omega": "ω",
    "zeta": "ζ",
    "xi": "ξ",
    "beta": "β",
    "kappa": "κ",
    "alpha": "α",
    "sigma": "σ",
    "mu": "μ",
}
_WORD = 4  # letters: fewer are a symbol and its index
_BINARY: dict[type[ast.AST], str] = {
    ast.Add: "+",
    ast.Sub: "−",
    ast.Mult: "·",
    ast.Lt: "&lt;",
    ast.LtE: "≤",
    ast.Gt: "&gt;",
    ast.GtE: "≥",
}
_RANK: dict[type[ast.AST], int] = {
    ast.Add: 1,
    ast.Sub: 1,
    ast.Mult: 2,
    ast.Div: 2,
    ast.USub: 3,
    ast.UAdd: 3,
    ast.Pow: 4,
}


def mathml(text: str, curves: Mapping[str, str] | None = None) -> str:
    """An equation of the grammar as a MathML element, for the documentation and the page.

    `curves` names the signal of each symbol that stands for a curve: h of P is written h(P).
    """
    equation = Equation(text)
    left = _symbol(equation.target)
    if equation.is_rate:
        left = f"<mover>{left}<mo>˙</mo></mover>"
    tree = _Curves(curves or {}).visit(deepcopy(equation.tree))
    equals = "≔" if equation.is_memory else "="
    return f"<math display='block'><mrow>{left}<mo>{equals}</mo>{_render(tree)}</mrow></math>"


class _Curves(ast.NodeTransformer):
    """Writes the signal of a curve behind its symbol."""

    def __init__(self, of: Mapping[str, str]) -> None:
        self.of = of

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """A symbol, or a curve of a signal."""
        return ast.Call(node, [ast.Name(self.of[node.id])], []) if node.id in self.of else node


def letter_and_index(name: str) -> tuple[str, str]:
    """``m0`` → m and 0, ``tau`` → τ and nothing, ``y_fb`` → y and fb; a word, such as ``flow``, has no index."""
    head, _, tail = name.partition("_")
    word = len(head) >= _WORD and head.isalpha() and head.islower()
    if not tail and len(name) > 1 and name not in _GREEK and not word:
        head, tail = name[0], name[1:]
    return _GREEK.get(head, head), tail


def _symbol(name: str) -> str:
    head, tail = letter_and_index(name)
    letter = f"<mi>{head}</mi>"
    return f"<msub>{letter}<mi>{tail}</mi></msub>" if tail else letter


def _render(node: ast.expr) -> str:
    match node:
        case ast.Constant(value=math.pi):
            return "<mi>π</mi>"
        case ast.Constant(value=int() | float() as value):
            return f"<mn>{float(value):g}</mn>"
        case ast.Name(id=name):
            return _symbol(name)
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            return f"<mfrac><mrow>{_render(left)}</mrow><mrow>{_render(right)}</mrow></mfrac>"
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            return f"<msup>{_base(left)}<mrow>{_render(right)}</mrow></msup>"
        case ast.BinOp(left=left, op=op, right=right):
            rank = _RANK[type(op)]
            tight = rank + 1 if isinstance(op, ast.Sub) else rank
            return f"{_inside(left, rank)}<mo>{_BINARY[type(op)]}</mo>{_inside(right, tight)}"
        case ast.UnaryOp(op=op, operand=operand):
            return f"<mo>{'−' if isinstance(op, ast.USub) else '+'}</mo>{_inside(operand, 3)}"
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            return f"{_render(left)}<mo>{_BINARY[type(op)]}</mo>{_render(right)}"
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return _call(name, arguments)
        case _:
            raise TypeError(f"{ast.dump(node)} passed the grammar but has no MathML")


def _call(name: str, arguments: Sequence[ast.expr]) -> str:
    match name, arguments:
        case "sqrt", [argument]:
            return f"<msqrt>{_render(argument)}</msqrt>"
        case "abs", [argument]:
            return f"<mrow><mo>|</mo>{_render(argument)}<mo>|</mo></mrow>"
        case "lag", [x, T]:
            return _filtered(x, f"<mn>1</mn><mo>+</mo>{_inside(T, 2)}<mo>·</mo><mi>s</mi>")
        case "lag2", [x, a1, a2]:
            first, second = (
                f"{_inside(a1, 2)}<mo>·</mo><mi>s</mi>",
                f"{_inside(a2, 2)}<mo>·</mo><msup><mi>s</mi><mn>2</mn></msup>",
            )
            return _filtered(x, f"<mn>1</mn><mo>+</mo>{first}<mo>+</mo>{second}")
        case "delay", [x, T]:
            return f"{_base(x)}<mo>⁡</mo><mrow><mo>(</mo><mi>t</mi><mo>−</mo>{_inside(T, 2)}<mo>)</mo></mrow>"
        case "lines" | "monotone", [x, *table]:
            pairs = zip(table[::2], table[1::2], strict=True)
            rows = "".join(f"<mtr><mtd>{_render(a)}</mtd><mtd>{_render(b)}</mtd></mtr>" for a, b in pairs)
            return (
                f"<mi>{name}</mi><mo>⁡</mo><mrow><mo>(</mo>{_render(x)}<mo>;</mo>"
                f"<mtable>{rows}</mtable><mo>)</mo></mrow>"
            )
        case _:
            listed = "<mo>,</mo>".join(map(_render, arguments))
            return f"<mi>{name}</mi><mo>⁡</mo><mrow><mo>(</mo>{listed}<mo>)</mo></mrow>"


def _filtered(x: ast.expr, denominator: str) -> str:
    return f"<mfrac><mn>1</mn><mrow>{denominator}</mrow></mfrac><mo>·</mo>{_inside(x, 2)}"


def _base(node: ast.expr) -> str:
    """What a power or a time belongs to as a whole: in parentheses where it is a sum, a product or a fraction."""
    fraction = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div)
    return _bracketed(_render(node)) if fraction else _inside(node, 5)


def _inside(node: ast.expr, rank: int) -> str:
    """The operand, in parentheses where it binds weaker than `rank`."""
    own = _RANK[type(node.op)] if isinstance(node, ast.BinOp | ast.UnaryOp) else 9
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
        own = 9  # a fraction needs no parentheses
    text = _render(node)
    return _bracketed(text) if own < rank else f"<mrow>{text}</mrow>"


def _bracketed(text: str) -> str:
    return f"<mrow><mo>(</mo>{text}<mo>)</mo></mrow>"
