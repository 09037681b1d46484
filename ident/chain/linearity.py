"""Whether equations are linear in the states and the command, read off their text."""

from __future__ import annotations

import ast
from collections.abc import Mapping

ZERO, CONSTANT, LINEAR, OTHER = -1, 0, 1, 2
"""What an expression is in the states and inputs: nothing, without them, of the first degree, anything else."""


def degree(node: ast.expr, known: Mapping[str, int]) -> int:
    """Of an expression, where `known` holds the degrees of the quantities it reads; others are constants.

    A sum of a constant and a signal is not linear: it does not pass through the origin.
    """
    match node:
        case ast.Constant(value=value):
            return CONSTANT if value else ZERO
        case ast.Name(id=name):
            return known.get(name, CONSTANT)
        case ast.UnaryOp(operand=operand):
            return degree(operand, known)
        case ast.BinOp(left=left, op=op, right=right):
            return _combined(degree(left, known), op, degree(right, known))
    parts = [degree(part, known) for part in ast.iter_child_nodes(node) if isinstance(part, ast.expr)]
    return CONSTANT if all(part <= CONSTANT for part in parts) else OTHER


def _combined(left: int, op: ast.operator, right: int) -> int:
    match op:
        case ast.Add() | ast.Sub():
            return max(left, right) if left == right or ZERO in (left, right) else OTHER
        case ast.Mult():
            return ZERO if ZERO in (left, right) else min(left + right, OTHER)
        case ast.Div():
            return left if right == CONSTANT or left == ZERO else OTHER
    return CONSTANT if max(left, right) <= CONSTANT else OTHER
