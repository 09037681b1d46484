"""The names in a user's equations: each is a signal of the model, something of the run, or the effect's own."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from ident.chain.chain import INPUT, INPUT_RATE, STEP
from ident.chain.channels import READABLE
from ident.chain.conditions import CONDITIONS
from ident.equations.grammar import ALIASES, CONSTANTS, FUNCTIONS, TIME, parsed
from ident.errors import Unusable
from ident.presets import Preset
from ident.stages import PLACES
from ident.words.nearest import did_you_mean

RESERVED = frozenset({*FUNCTIONS, *ALIASES, *CONSTANTS, TIME, STEP})
"""Names that mean something in every equation."""


@dataclass(frozen=True)
class Line:
    """One line of a definition: the field it stands in, its left and right side, where the right one begins.

    A line that `is_written` by nobody stands for its field: no character of it is at fault.
    """

    where: str
    left: str
    right: str
    first: int
    text: str
    is_written: bool = True

    @property
    def equation(self) -> str:
        """The line as the program writes it."""
        equals = " := " if self.left.endswith(":") else " = "
        return f"{self.left.rstrip(' :')}{equals}{self.right.strip()}"

    @property
    def target(self) -> str:
        """The quantity on the left."""
        return self.left.rstrip(" :'")

    @property
    def names(self) -> frozenset[str]:
        """The quantities on the right."""
        tree = parsed(self.text, self.first)
        called = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
        return frozenset(n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and id(n) not in called)

    def at(self, name: str) -> str:
        """Where a name stands, in words; a target is sought on the left."""
        if not self.is_written:
            return self.where
        first = 0 if name == self.target else self.first
        found = re.compile(rf"\b{re.escape(name)}\b").search(self.text, first)
        return f"{self.where}, character {found.start() + 1 if found else 1}"


def check_names(lines: Sequence[Line], place: str, own: Mapping[str, str], models: Sequence[Preset]) -> Preset:
    """The first of the models that has what the lines act on.

    `own` are the symbols of the effect's parameters by field, the strength's first. Raises Unusable for a name that
    is not known, that means two things, or that acts on nothing.
    """
    targets = [line.target for line in lines]
    chosen = next((model for model in models if _signals(model, place) & set(targets)), None)
    if chosen is None:
        there = " ".join(sorted({name for model in models for name in _signals(model, place, exactly=True)}))
        raise Unusable(
            "acts-on-nothing",
            f"{targets[-1]} is not a signal of the place {place} or before it",
            lines[-1].at(targets[-1]),
            f"redefine one of: {there or 'none in this model'}",
        )
    known = _known(chosen)
    _refuse_shadows(lines, place, own, chosen, known)
    allowed = known | set(own.values()) | set(targets) | {TIME, *READABLE}
    for line in lines:
        for name in sorted(line.names - allowed):
            remedy = did_you_mean(name, sorted(allowed))
            raise Unusable("unknown-name", f"there is no quantity {name[:40]!r}", line.at(name), remedy)
    strength = next(iter(own.values()))
    if not any(strength in line.names for line in lines):
        raise Unusable(
            "unused-strength", f"the strength {strength} does not appear", lines[-1].where, "let the equation read it"
        )
    return chosen


def refuse_symbol(name: str, models: Sequence[Preset]) -> None:
    """Raise Unusable where what is to be called so would bear the name of something in an equation of a model."""
    if name in RESERVED:
        raise Unusable("name-taken", f"{name} is a word of the grammar", "effect name", "give it another name")
    for model in models:
        if name in _known(model):
            raise Unusable("name-taken", f"{name} is {_meaning(name, model)}", "effect name", "give it another name")


def _refuse_shadows(
    lines: Sequence[Line], place: str, own: Mapping[str, str], model: Preset, known: frozenset[str]
) -> None:
    seen: dict[str, str] = {}
    of_lines = [(line.at(line.target), line.target) for line in lines if line.target not in _signals(model, place)]
    for where, symbol in (*own.items(), *dict.fromkeys(of_lines)):
        if symbol in known | RESERVED:
            raise Unusable("name-taken", f"{symbol} is {_meaning(symbol, model)}", where, "call it otherwise")
        if seen.get(symbol, where) != where and where in own:
            raise Unusable("name-taken", f"{symbol} has two meanings", where, "call one of them otherwise")
        seen[symbol] = where
    for line in lines:
        if line.target in set(own.values()):
            raise Unusable(
                "name-taken", f"{line.target} is a parameter of the effect", line.at(line.target), "redefine a signal"
            )


def _signals(model: Preset, place: str, exactly: bool = False) -> frozenset[str]:
    """The signals that an effect at this place may redefine."""
    last = PLACES.index(place)
    return frozenset(
        equation.target
        for stage in model.chain.stages
        for equation in stage.equations
        if (PLACES.index(stage.place) <= last and not exactly) or stage.place == place
        if not equation.is_rate
    )


def _known(model: Preset) -> frozenset[str]:
    """Signals, states, inputs, conditions and parameters of a model."""
    targets = {equation.target for equation in model.core.equations}
    return frozenset(targets | {INPUT, INPUT_RATE} | CONDITIONS.keys() | {p.name for p in model.parameters})


def _meaning(symbol: str, model: Preset) -> str:
    """What a name already means."""
    return next(_meanings(symbol, model), "a word of the grammar")


def _meanings(symbol: str, model: Preset) -> Iterator[str]:
    for stage in model.chain.stages:
        yield from (f"the {q.meaning} ({stage.place})" for q in stage.publishes if q.name == symbol)
    if symbol in CONDITIONS:
        yield f"the {CONDITIONS[symbol].meaning}"
    yield from (f"the {p.meaning} (model {model.name})" for p in model.parameters if p.name == symbol)
    if symbol in (INPUT, INPUT_RATE, TIME):
        yield {INPUT: "the command", INPUT_RATE: "the rate of the command", TIME: "the time"}[symbol]
