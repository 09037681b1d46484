"""A lab's own effects as the pages tell of them, and what a proposed term is kept as."""

from __future__ import annotations

import json
from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass

from markupsafe import Markup

from app.own_effects.own_effect import SEARCHED, OwnEffect, meaning_of, suggested, view
from app.pages.diagnosis_view import MissingView
from ident.presets import preset
from ident.words.number import plain
from ident.words.titles import title


@dataclass(frozen=True)
class KeptRow:
    """An own effect in a list; `evidence` is that of one which a search proposed, `refused` why it cannot be used.

    `there`: the fit that the list stands beside has it already.
    """

    name: str
    title: str
    place: str
    meaning: str
    equations: tuple[Markup, ...]
    definition: str
    origin: str
    searched: bool
    evidence: str
    model: str
    made: str
    refused: str
    there: bool


def kept_rows(kept: Iterable[OwnEffect], there: Container[str] = ()) -> Iterator[KeptRow]:
    """A row for each, `there` being the effects of the fit that they stand beside."""
    for one in kept:
        shown, searched = view(one), one.origin == SEARCHED
        told = searched and one.nats is not None and one.bar is not None
        yield KeptRow(
            name=one.name,
            title=title(one.name),
            place=shown.place,
            meaning=one.meaning,
            equations=tuple(Markup(line.mathml) for line in shown.equations),
            definition=json.dumps(dict(one.definition)),
            origin=one.origin,
            searched=searched,
            evidence=f"{plain(one.nats or 0.0, 3)} nats, threshold {plain(one.bar or 0.0, 3)}" if told else "",
            model=preset(one.model).title if one.model and not shown.refused else one.model or "any",
            made=one.created_at,
            refused=shown.refused,
            there=one.name in there,
        )


@dataclass(frozen=True)
class Keeping:
    """A proposed term: the name that is suggested for it, and the one that it is kept under, "" where it is not."""

    suggested: str
    kept: str


def keeping(lacks: MissingView, kept: Iterable[OwnEffect]) -> Iterator[Keeping]:
    """One for each term that a diagnosis proposes."""
    kept = tuple(kept)
    taken = {one.name for one in kept}
    for term in (lacks.found.proposals or ()) if lacks.found else ():
        mine = (one.name for one in kept if (one.diagnosis, _lines(one)) == (lacks.id, term.effect["equation"]))
        yield Keeping(suggested(meaning_of(term.meaning, term.place), taken), next(mine, ""))


def _lines(one: OwnEffect) -> object:
    return one.definition.get("equation")
