"""Units as powers of m, kg and s that are calculated with like numbers: an equation that mixes them up raises."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from ident.equations.equation import Equation

Powers = tuple[Fraction, Fraction, Fraction]


class Mixed(Exception):
    """Two units where one should stand."""


@dataclass(frozen=True)
class Dimension:
    """Powers of m, kg, s; None where they are not known yet."""

    powers: Powers | None

    def __mul__(self, other: Dimension | float) -> Dimension:
        return self._joined(other, 1)

    def __truediv__(self, other: Dimension | float) -> Dimension:
        return self._joined(other, -1)

    def __rtruediv__(self, _number: float) -> Dimension:
        return PLAIN / self

    def __pow__(self, exponent: Dimension | float) -> Dimension:
        if isinstance(exponent, Dimension):
            same(self, exponent, PLAIN)
            return PLAIN
        return Dimension(self.powers and tuple(Fraction(exponent) * power for power in self.powers))

    def __add__(self, other: Dimension | float) -> Dimension:
        return same(self, PLAIN if isinstance(other, float | int) and other else other)

    def __neg__(self) -> Dimension:
        return self

    __rmul__, __radd__, __sub__, __rsub__ = __mul__, __add__, __add__, __add__

    def _joined(self, other: Dimension | float, sign: int) -> Dimension:
        if not isinstance(other, Dimension):
            return self
        if self.powers is None or other.powers is None:
            return UNKNOWN
        return Dimension(tuple(a + sign * b for a, b in zip(self.powers, other.powers, strict=True)))


def same(*values: Dimension | float) -> Dimension:
    """The one dimension of all of them; a plain number in a limit or a comparison may be of any."""
    known = {value for value in values if isinstance(value, Dimension) and value.powers is not None}
    if len(known) > 1:
        raise Mixed(" and ".join(sorted(map(str, known))))
    return next(iter(known), UNKNOWN if any(isinstance(value, Dimension) for value in values) else PLAIN)


def plain(*values: Dimension | float) -> Dimension:
    """What takes and gives plain numbers."""
    same(PLAIN, *values)
    return PLAIN


def sign(*values: Dimension | float) -> Dimension:
    """What compares one kind, and gives a plain number."""
    same(*values)
    return PLAIN


def table(x: Dimension, *nodes: Dimension | float) -> Dimension:
    """Nodes of x and of values, in turn."""
    same(x, *nodes[::2])
    return same(*nodes[1::2])


def lag(x: Dimension, *coefficients: Dimension) -> Dimension:
    """Times, their powers rising."""
    for power, coefficient in enumerate(coefficients, 1):
        same(coefficient, of("s") ** power)
    return x


def dry(limit: Dimension, speed: Dimension, acceleration: Dimension, mass: Dimension) -> Dimension:
    """A force."""
    same(speed, of("m/s"))
    return same(limit, mass * acceleration)


FUNCTIONS: Mapping[str, Callable[..., Dimension]] = {
    "abs": same, "clip": same, "max": same, "min": same, "where": lambda _condition, a, b: same(a, b), "sgn": sign,
    "exp": plain, "sin": plain, "cos": plain, "tanh": plain, "sqrt": lambda x: x**0.5, "lines": table,
    "monotone": table, "lag": lag, "lag2": lag, "delay": lag, "dry": dry, "compared": sign,
}  # fmt: skip
_BASE = {"m": (1, 0, 0), "kg": (0, 1, 0), "s": (0, 0, 1), "N": (1, 1, -2), "Pa": (-1, 1, -2)}


def of(unit: str) -> Dimension:
    """The dimension of an SI unit as the program writes it."""
    known = {name: Dimension(tuple(map(Fraction, powers))) for name, powers in _BASE.items()}
    found = eval(unit.replace("^", "**"), {"__builtins__": {}}, known)
    return found if isinstance(found, Dimension) else PLAIN


PLAIN, UNKNOWN = Dimension((Fraction(0),) * 3), Dimension(None)


class _Called(ast.NodeTransformer):
    """A comparison as a call, for a dimension is neither greater nor less."""

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        self.generic_visit(node)
        return ast.Call(ast.Name("compared", ast.Load()), [node.left, *node.comparators], [])


def check(equations: Iterable[Equation], known: Mapping[str, Dimension]) -> None:
    """Raise Mixed where an equation mixes units; what is not known is what the equations make it."""
    lines, found = list(equations), dict(known)
    for _ in range(len(lines) + 1):
        for equation in lines:
            tree = ast.fix_missing_locations(
                ast.Expression(_Called().visit(ast.parse(equation.python, mode="eval").body))
            )
            names = {name: found.get(name, UNKNOWN) for name in equation.names}
            try:
                made = eval(compile(tree, "<dimension>", "eval"), {"__builtins__": {}, **FUNCTIONS}, names)
                left = (made if isinstance(made, Dimension) else PLAIN) * (of("s") if equation.is_rate else 1.0)
                number = isinstance(made, float | int)  # alone: a constant of the unit that its quantity has
                target = found.get(equation.target, UNKNOWN)
                found[equation.target] = target if number else same(target, left)
            except Mixed as error:
                raise Mixed(f"{equation.text}: {error}") from None
