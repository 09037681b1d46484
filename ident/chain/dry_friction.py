"""Dry friction in the equations of a chain: its force waits for no acceleration, which is found without it first."""

from __future__ import annotations

import ast

from ident.equations.equation import Equation


def dry_friction(equation: Equation) -> tuple[str, str, str, str] | None:
    """(limit, speed, acceleration, mass) where the equation is ``f = dry(...)``, else None."""
    tree = equation.tree
    if isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and tree.func.id == "dry":
        limit, speed, acceleration, mass = (ast.unparse(argument) for argument in tree.args)
        return limit, speed, acceleration, mass
    return None
