"""The chain of a fitted model as a drawing: its places, what each hands on, the effects that live there."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from app.pages.effect_view import Member, member
from ident.custom.definition import preset_with, read_effect
from ident.effects import CATALOGUE
from ident.equations.equation import Equation
from ident.equations.grammar import DYNAMIC
from ident.errors import Unusable
from ident.fit.identification import check_settings
from ident.fit.result import FitResult
from ident.fit.settings import Settings

_STEP, _WIDTH, _TOP, _LINE = 136, 108, 34, 15  # px of the drawing
_LETTERS = 17  # that fit into a box
_BACK = (("P", "pressure", "flow"), ("v", "load", "pressure"), ("y", "sensor", "controller"))
"""What may run back against the chain: signal, from, to; it is drawn where the model reads it there."""


@dataclass(frozen=True)
class Place:
    """A place: where it is drawn, the signal that the next one reads, its effects that are on and those to add.

    `core` is what it is without effects.
    """

    name: str
    x: int
    signal: str
    core: str
    on: tuple[Member, ...]
    off: tuple[Member, ...]

    @property
    def label(self) -> str:
        """The place for a reader who does not see the drawing."""
        on = ", ".join(one.title for one in self.on) or "none"
        return f"{self.name}: switched on {on}; {len(self.off)} more to add"

    @property
    def lines(self) -> tuple[str, ...]:
        """What is written into the box: the effects that are on, shortened to it."""
        names = [one.title if len(one.title) <= _LETTERS else f"{one.title[: _LETTERS - 1]}…" for one in self.on]
        return (*names[:2], f"and {len(names) - 2} more") if len(names) > 3 else tuple(names)


@dataclass(frozen=True)
class Feedback:
    """A signal that runs back, as the corners of its line and of its arrow's tip."""

    signal: str
    path: str
    tip: str
    x: float
    y: float


@dataclass(frozen=True)
class Drawing:
    """The whole drawing and its size."""

    places: tuple[Place, ...]
    back: tuple[Feedback, ...]
    box: int
    width: int
    height: int
    step: int = _STEP
    wide: int = _WIDTH
    top: int = _TOP
    line: int = _LINE


def drawing(fit: FitResult) -> Drawing:
    """The chain of a fit with its effects."""
    own = {str(definition["name"]): definition for definition in fit.settings.get("custom", ())}
    model = preset_with(fit.model, fit.effects, tuple(own.values()))
    names = tuple(dict.fromkeys(stage.place for stage in model.chain.stages))
    signals = (*(_handed_on(model.core.equations, *two) for two in pairwise(names)), "")
    on, off = tuple(_on(fit, own)), tuple(_off(fit))
    places = tuple(
        Place(
            name=name,
            x=10 + _STEP * number,
            signal=signals[number],
            core=_core(model.core.equations, name),
            on=tuple(one for one in on if one.place == name),
            off=tuple(one for one in off if one.place == name),
        )
        for number, name in enumerate(names)
    )
    box = 30 + _LINE * max(2, *(len(place.lines) for place in places))
    back = tuple(_back(places, model.chain.equations, _TOP + box))
    return Drawing(places, back, box, _STEP * len(places) + 10, _TOP + box + 22 * len(back) + 18)


def _on(fit: FitResult, own: Mapping[str, Any]) -> Iterator[Member]:
    """The effects of the fit with the strengths that were found."""
    known = {effect.name: effect for effect in CATALOGUE}
    for name in fit.effects:
        effect = known[name] if name in known else read_effect(own[name])
        yield member(name, effect, fit.parameters, own.get(name))


def _off(fit: FitResult) -> Iterator[Member]:
    """The effects of the catalogue that the fit would take if it were made again with one of them."""
    settings = Settings.from_json(fit.settings) if fit.settings else Settings(model=fit.model)
    for effect in CATALOGUE:
        if effect.name in fit.effects:
            continue
        try:
            check_settings(replace(settings, effects=(*fit.effects, effect.name)))
        except Unusable:
            continue  # it acts on what this model has not
        yield member(effect.name, effect, {}, None)


def _core(equations: Sequence[Equation], place: str) -> str:
    """Whether a place is linear without effects: its equations call no function but what remembers, off in a core."""
    trees = (equation.tree for equation in equations if equation.place == place)
    called = {node.func.id for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Call)}  # type: ignore[attr-defined]
    return "nonlinear" if called - set(DYNAMIC) else "linear"


def _handed_on(equations: Sequence[Equation], place: str, behind: str) -> str:
    """The signal of a place that the place behind it reads first."""
    own = {equation.target for equation in equations if equation.place == place}
    return next((name for e in equations if e.place == behind for name in sorted(e.names & own)), "")


def _back(places: Sequence[Place], equations: Sequence[Equation], below: int) -> Iterator[Feedback]:
    """Lines under the boxes, the longest one lowest; those of neighbours leave room for each other."""
    at = {place.name: place.x for place in places}
    for level, (signal, start, end) in enumerate(each for each in _BACK if _handed_on(equations, *each[1:])):
        y, aside = below + 18 + 22 * level, 0.15 if end != "controller" else 0.0
        x0, x1 = at[start] + _WIDTH * (0.5 - aside), at[end] + _WIDTH * (0.5 + aside)
        path, tip = f"M{x0:g} {below}V{y}H{x1:g}V{below + 6}", f"M{x1:g} {below}l-4 7h8z"
        yield Feedback(signal, path, tip, (x0 + x1) / 2, y)
