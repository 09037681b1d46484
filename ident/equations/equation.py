"""An equation of the program, and what can be read off it.

An equation is one line of text:

    q' = (e - q) / tau                a rate of a state
    w = q                             a signal
    p := clip(p, q - b, q + b)        a memory: on the right, p is its value at the start of the step

Its right-hand side is an expression of :mod:`ident.equations.grammar`: parsed, checked node by node, and never handed
to the interpreter as it came. Simulation, frequency response, documentation and the page's mathematics all come from
this one text.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import CodeType
from typing import Any

from ident.cached import cached_property
from ident.equations.grammar import ARITHMETIC, parsed, reads, refused, tree_of


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

    @cached_property
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

    @cached_property
    def _left(self) -> str:
        return self.text.partition("=")[0].strip()

    @cached_property
    def tree(self) -> ast.expr:
        """The right-hand side as a checked syntax tree."""
        left, equals, _ = self.text.partition("=")
        if not equals or not self.target.isidentifier():
            raise refused(0, "an equation reads NAME = , NAME' = or NAME := EXPRESSION", "begin it so")
        return _tree(self.text, len(left) + 1)

    @cached_property
    def names(self) -> frozenset[str]:
        """The quantities on the right, functions left out."""
        return reads(self.tree)[0]

    def renamed(self, names: Mapping[str, str], target: str) -> Equation:
        """The same equation with other names for what it reads, and another target."""
        read = self.names & names.keys()
        if target == self.target and not read:
            return self
        return _renamed(self, tuple(sorted((name, names[name]) for name in read)), target)

    def with_values(self, values: Mapping[str, ast.expr]) -> Equation:
        """The same equation with expressions in place of names."""
        if not self.names & values.keys():
            return self
        left, _, _ = self.text.partition("=")
        return Equation(f"{left}= {_replaced(self.python, values)}", self.place, self.meaning)

    def value(self, known: Mapping[str, Any]) -> Any:
        """The right-hand side where every quantity it reads has a value: numbers or arrays that broadcast."""
        # The tree passed the grammar, so nothing but arithmetic on `known` can happen here.
        return eval(_code(self.text), ARITHMETIC, known)

    @cached_property
    def python(self) -> str:
        """The right-hand side as Python source, to be put into a generated function."""
        return ast.unparse(self.tree)


@lru_cache(maxsize=8192)
def _tree(text: str, first: int) -> ast.expr:
    """The right-hand side from its first character on; the same few thousand lines are read again and again."""
    return parsed(text, first)


@lru_cache(maxsize=8192)
def _renamed(equation: Equation, names: tuple[tuple[str, str], ...], target: str) -> Equation:
    """An equation with other names: those of an effect are the same in every chain that holds it."""
    values = {name: ast.Name(other, ast.Load()) for name, other in names}
    sign = "' = " if equation.is_rate else " := " if equation.is_memory else " = "
    return Equation(f"{target}{sign}{_replaced(equation.python, values)}", equation.place, equation.meaning)


@lru_cache(maxsize=8192)
def _code(text: str) -> CodeType:
    """The right-hand side compiled for Python."""
    return compile(ast.Expression(Equation(text).tree), "<equation>", "eval")


def _replaced(text: str, values: Mapping[str, ast.expr]) -> str:
    class Replace(ast.NodeTransformer):
        def visit_Name(self, node: ast.Name) -> ast.expr:
            return values.get(node.id, node)

    return ast.unparse(Replace().visit(tree_of(text)))
