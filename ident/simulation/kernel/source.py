"""Expressions of the grammar as lines of source for the lanes of a kernel.

Comparisons stand for min, max, abs and sgn, multiplications for small powers, and what depends on symbols only is
computed once for each lane: only so does the compiler put the lanes side by side.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from types import CodeType
from typing import Any

from ident.chain.chain import INPUT, INPUT_RATE, MEASURED, STEP, Chain
from ident.equations.grammar import ARITHMETIC, DYNAMIC, TABLES, TIME, reads, tree_of
from ident.equations.interpolation import coefficient
from ident.errors import Unusable

WRITTEN_OUT = (0.25, 0.5, 1.0, 2.0, 3.0, 4.0)
"""Exponents for which roots and products stand in the code: a number there is worth code of its own."""


@dataclass
class Source:
    """The lines of a kernel's loop over the lanes, and the rows of its buffer that they read."""

    chain: Chain
    output: str
    plain: Mapping[str, float]
    lines: list[str] = field(default_factory=list)
    constants: dict[str, tuple[int, ast.expr]] = field(default_factory=dict)
    rows: int = 0
    temporaries: int = 0
    written: set[str] = field(default_factory=set)

    def _row(self, count: int = 1) -> int:
        self.rows += count
        return self.rows - count

    def _dynamic(self, name: str, arguments: Sequence[ast.expr], stage: str) -> str:
        """What a function that remembers is at a stage."""
        raise NotImplementedError

    def _write(self, target: str, value: str) -> None:
        self.written.add(target)
        self.lines.append(f"{target} = {value}")

    def _temporary(self, value: str) -> str:
        self.temporaries += 1
        self._write(f"t{self.temporaries}", value)
        return f"t{self.temporaries}"

    def _text(self, text: str) -> str:
        return self._constant(tree_of(text))

    def _constant(self, node: ast.expr) -> str:
        """The local name of an expression of symbols only, which is computed once for each lane, outside the loop."""
        key = ast.unparse(node)
        if key not in self.constants:
            self.constants[key] = (self._row(), node)
        return f"c{self.constants[key][0]}"

    def _name(self, name: str, stage: str) -> str:
        if name in self._symbols:
            return repr(float(self.plain[name])) if name in self.plain else self._constant(named(name))
        if name.endswith("__old"):
            return name
        if stage == "f" and (name in self.chain.states or name in (INPUT, INPUT_RATE, *MEASURED, TIME)):
            return f"{name}_1"
        if stage == "m" and f"{name}_m" not in self.written:
            return f"{name}_1"
        return f"{name}_{stage}"

    @property
    def _symbols(self) -> frozenset[str]:
        return frozenset((*self.chain.symbols, STEP))

    def _lower(self, node: ast.expr, stage: str) -> str:
        """An expression of the grammar as source for one stage."""
        if isinstance(node, ast.Constant):
            return repr(float(node.value))  # type: ignore[arg-type]
        if isinstance(node, ast.Name):
            return self._name(node.id, stage)
        if self._is_constant(node):
            return self._constant(node)
        match node:
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._power(self._lower(left, stage), _folded(right, self.plain), stage)
            case ast.BinOp(left=left, op=ast.Div(), right=right) if self._is_constant(right):
                inverse = ast.BinOp(ast.Constant(1.0), ast.Div(), right)
                return f"({self._lower(left, stage)} * {self._constant(inverse)})"
            case ast.BinOp(left=left, op=op, right=right):
                return f"({self._lower(left, stage)} {_SIGNS[type(op)]} {self._lower(right, stage)})"
            case ast.UnaryOp(op=op, operand=operand):
                return f"({'-' if isinstance(op, ast.USub) else '+'}{self._lower(operand, stage)})"
            case ast.Compare():
                return f"(1.0 if {self._condition(node, stage)} else 0.0)"
            case ast.Call(func=ast.Name(id=name), args=arguments) if name in DYNAMIC:
                return self._dynamic(name, arguments, stage)
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return self._call(name, arguments, stage)
        raise TypeError(f"{ast.dump(node)} passed the grammar but cannot be compiled")

    def _is_constant(self, node: ast.expr) -> bool:
        names, called = reads(node)
        return bool(names) and names <= self._symbols and called.isdisjoint(DYNAMIC)

    def _condition(self, node: ast.expr, stage: str) -> str:
        if isinstance(node, ast.Compare):
            left, right = self._lower(node.left, stage), self._lower(node.comparators[0], stage)
            return f"{left} {_SIGNS[type(node.ops[0])]} {right}"
        return f"{self._lower(node, stage)} != 0.0"

    def _call(self, name: str, arguments: Sequence[ast.expr], stage: str) -> str:
        if name in TABLES:
            return self._table(name, arguments, stage)
        if name == "where":
            a, b = (self._temporary(self._lower(argument, stage)) for argument in arguments[1:])
            return f"({a} if {self._condition(arguments[0], stage)} else {b})"
        x, *more = (self._temporary(self._lower(argument, stage)) for argument in arguments)
        match name, more:
            case "abs", []:
                return f"({x} if {x} >= 0.0 else -{x})"
            case "sgn", []:
                return f"(1.0 if {x} > 0.0 else (-1.0 if {x} < 0.0 else 0.0))"
            case "clip", [low, high]:
                return f"({high} if {x} > {high} else ({low} if {x} < {low} else {x}))"
            case "max", [y]:
                return f"({x} if {x} > {y} else {y})"
            case "min", [y]:
                return f"({x} if {x} < {y} else {y})"
            case "exp", []:
                return self._exponential(x)
            case _:
                return f"{name}({x})"

    def _table(self, kind: str, arguments: Sequence[ast.expr], stage: str) -> str:
        """A table as the sum over its pieces of their cubics in clip(x, xi, xi+1) − xi: no branch, no search."""
        x, table = self._temporary(self._lower(arguments[0], stage)), list(arguments[1:])
        if not all(self._stays(node) for node in table):
            text = f"equation {ast.unparse(ast.Call(named(kind), list(arguments), []))[:80]!r}"
            raise Unusable("bad-equation", "a node of the table changes with time", text, "use numbers and parameters")
        count, nodes = len(table) // 2, [self._known(node) for node in table[::2]]

        def known(piece: int, power: int) -> str:
            return self._constant(
                ast.Call(named("coefficient"), [*(ast.Constant(value) for value in (kind, piece, power)), *table], [])
            )

        low, high = nodes[0], nodes[-1]
        terms = [known(0, 0)]
        terms.append(f"{known(0, 1)} * ({x} - {low} if {x} < {low} else 0.0)")
        terms.append(f"{known(count - 2, -1)} * ({x} - {high} if {x} > {high} else 0.0)")
        for i in range(count - 1):
            a, b = nodes[i], nodes[i + 1]
            t = self._temporary(f"({b} if {x} > {b} else ({a} if {x} < {a} else {x})) - {a}")
            if kind == "lines":
                terms.append(f"{t} * {known(i, 1)}")
            else:
                terms.append(f"{t} * ({known(i, 1)} + {t} * ({known(i, 2)} + {t} * {known(i, 3)}))")
        return f"({' + '.join(terms)})"

    def _stays(self, node: ast.expr) -> bool:
        """Whether an expression is one of numbers and symbols only."""
        return self._is_constant(node) or not reads(node)[0]

    def _known(self, node: ast.expr) -> str:
        """A number or an expression of symbols, as it stands in the loop."""
        return repr(float(node.value)) if isinstance(node, ast.Constant) else self._constant(node)  # type: ignore[arg-type]

    def _exponential(self, x: str) -> str:
        """exp(x) as the 32nd power of a polynomial in x/32, |x| ≤ 60: relative error 3e-6 at |x| = 3, 4e-8 at 1.

        A call of a mathematics library would be scalar, one lane after the other.
        """
        z = self._temporary(f"0.03125 * (60.0 if {x} > 60.0 else (-60.0 if {x} < -60.0 else {x}))")
        power = self._temporary(
            f"1.0 + {z} * (1.0 + {z} * (0.5 + {z} * ({1 / 6!r} + {z} * ({1 / 24!r} + {z} * {1 / 120!r}))))"
        )
        for _ in range(5):
            power = self._temporary(f"{power} * {power}")
        return power

    def _power(self, base: str, exponent: ast.expr, stage: str) -> str:
        if not isinstance(exponent, ast.Constant):
            return f"pow({base}, {self._lower(exponent, stage)})"
        value = float(exponent.value)  # type: ignore[arg-type]
        if value not in WRITTEN_OUT:
            return f"pow({base}, {value!r})"
        if value == 1.0:
            return base
        if value > 1.0:
            x = self._temporary(base)
            return "(" + " * ".join([x] * int(value)) + ")"
        return f"sqrt({base})" if value == 0.5 else f"sqrt(sqrt({base}))"


_SIGNS: dict[type[ast.AST], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
}


def _folded(node: ast.expr, plain: Mapping[str, float]) -> ast.expr:
    """The expression with the plain symbols as numbers."""
    if isinstance(node, ast.Name) and node.id in plain:
        return ast.Constant(float(plain[node.id]))
    return node


_KNOWN = {**ARITHMETIC, "coefficient": coefficient}


def constant(node: ast.expr, values: Mapping[str, Any]) -> Any:
    """The value of an expression of symbols for all lanes."""
    return evaluated(_code(node), values)


def constants(nodes: Sequence[ast.expr]) -> CodeType:
    """Expressions of symbols as code whose value, of :func:`evaluated`, is the values of all of them in turn."""
    return _code(ast.Tuple(list(nodes), ast.Load()))


def evaluated(code: CodeType, values: Mapping[str, Any]) -> Any:
    """The value of compiled expressions of symbols for all lanes."""
    return eval(code, _KNOWN, values)


@lru_cache(maxsize=8192)
def _code(node: ast.expr) -> CodeType:
    """An expression that passed the grammar, compiled for Python: the same ones are asked for in every simulation."""
    return compile(ast.Expression(ast.fix_missing_locations(node)), "<constant>", "eval")


def named(name: str) -> ast.Name:
    """A name as an expression."""
    return ast.Name(name, ast.Load())
