"""The lines of a kernel as C: the very equations that are simulated here, for one machine instead of sixteen lanes."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator, Sequence

from ident.equations.grammar import statement_of
from ident.simulation.kernel import LANES

_SIGNS: dict[type[ast.operator] | type[ast.cmpop], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


def c_lines(lines: Sequence[str], rows: Collection[int]) -> list[str]:
    """The statements by which a kernel fills these rows of its buffer, the array b of C, and none beside.

    The grammar of the lines is that of :mod:`ident.simulation.kernel.machine_code`.
    """
    declared: set[str] = set()
    return [_c_statement(node, declared) for node in _needed(lines, rows)]


def number(value: float) -> str:
    """A number of C to its last bit."""
    return repr(float(value))


def comment(text: str) -> str:
    """A text that cannot leave the comment of C that it stands in."""
    return re.sub(r"[^ -~]", "-", text).replace("*/", "* /").replace("/*", "/ *").replace("\\", "/")


def _needed(lines: Sequence[str], rows: Collection[int]) -> list[ast.Assign]:
    """The assignments that these rows depend on, in order."""
    kept: list[ast.Assign] = []
    wanted: set[str] = set()
    for line in reversed(lines):
        node = statement_of(line)
        if not isinstance(node, ast.Assign):
            raise TypeError(f"{line!r} is not a line of a kernel")
        (place,) = node.targets
        if place.id in wanted if isinstance(place, ast.Name) else _row(place) in rows:
            kept.append(node)
            wanted |= set(_names(node.value))
    return kept[::-1]


def _names(node: ast.expr) -> Iterator[str]:
    return (each.id for each in ast.walk(node) if isinstance(each, ast.Name))


def _row(node: ast.expr) -> int:
    """The row in ``b[NUMBER + lane]``."""
    match node:
        case ast.Subscript(slice=ast.BinOp(left=ast.Constant(value=int(offset)))):
            return offset // LANES
    raise TypeError(f"{ast.unparse(node)!r} is not a place of the buffer")


def _c_statement(node: ast.Assign, declared: set[str]) -> str:
    (place,) = node.targets
    value = _c(node.value)
    if not isinstance(place, ast.Name):
        return f"b[{_row(place)}] = {value};"
    if place.id in declared:
        return f"{place.id} = {value};"
    declared.add(place.id)
    return f"double {place.id} = {value};"


def _c(node: ast.expr) -> str:
    """An expression in C."""
    match node:
        case ast.Constant(value=int() | float() as value):
            return number(value)
        case ast.Name(id=name):
            return name
        case ast.Subscript():
            return f"b[{_row(node)}]"
        case ast.UnaryOp(op=op, operand=operand):
            return f"({'-' if isinstance(op, ast.USub) else '+'}{_c(operand)})"
        case ast.BinOp(left=left, op=op, right=right):
            return f"({_c(left)} {_SIGNS[type(op)]} {_c(right)})"
        case ast.IfExp(test=ast.Compare(left=left, ops=[relation], comparators=[right]), body=body, orelse=other):
            return f"({_c(left)} {_SIGNS[type(relation)]} {_c(right)} ? {_c(body)} : {_c(other)})"
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return f"{name}({', '.join(map(_c, arguments))})"
    raise TypeError(f"{ast.unparse(node)!r} is nothing that a kernel can do")
