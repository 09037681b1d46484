"""What an effect writes with lag, lag2 and delay, as equations of states: so written, its chain can be linearised."""

from __future__ import annotations

import ast
from dataclasses import replace

from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.equations.grammar import tree_of


def with_states(effect: Effect, sections: int = 1) -> Effect:
    """The effect with a state or two of its own for each operator that remembers.

    lag(x, T):       z' = (x − z)/T, read as z
    lag2(x, a1, a2): z' = w, w' = (x − z − a1 w)/a2, read as z
    delay(x, T):     z and w of lag2(x, T/2, T²/12), read as x − T w: the Padé approximant of second order

    A delay is divided into so many `sections` behind each other, each its share: with four the phase of one of half a
    period is right to 0.1°, with one to 13°.
    """
    writer = _States(sections)
    texts = [_written(writer, text) for text in effect.texts]
    return replace(effect, texts=(*writer.rates, *texts)) if writer.rates else effect


def _written(writer: _States, text: str) -> str:
    left, _, _ = text.partition("=")
    count, tree = len(writer.rates), tree_of(Equation(text).python)
    body = writer.visit(tree)
    return text if len(writer.rates) == count else f"{left}= {ast.unparse(body)}"


class _States(ast.NodeTransformer):
    """Puts states in place of the operators, and writes down their rates.

    These stand before the equation that they come from, so that they read a signal as it was before it.
    """

    def __init__(self, sections: int) -> None:
        self.rates: list[str] = []
        self._count, self._sections = 0, sections

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """A call of an operator becomes its state; any other stays."""
        self.generic_visit(node)
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name not in ("lag", "lag2", "delay"):
            return node
        x, *times = (f"({ast.unparse(argument)})" for argument in node.args)
        if name == "lag":
            z, _ = self._names()
            self.rates.append(f"{z}' = ({x} - {z}) / {times[0]}")
            return tree_of(z)
        if name == "lag2":
            return tree_of(self._second_order(x, *times)[0])
        share = f"({times[0]} / {self._sections})"
        for _ in range(self._sections):
            _, w = self._second_order(x, f"({share} / 2)", f"({share} * {share} / 12)")
            x = f"({x} - {share} * {w})"
        return tree_of(x)

    def _second_order(self, x: str, a1: str, a2: str) -> tuple[str, str]:
        """The states z and w of a lag of second order."""
        z, w = self._names()
        self.rates += [f"{z}' = {w}", f"{w}' = ({x} - {z} - {a1} * {w}) / {a2}"]
        return z, w

    def _names(self) -> tuple[str, str]:
        """Of the next two states."""
        self._count += 1
        return f"zlag{self._count - 1}", f"wlag{self._count - 1}"
