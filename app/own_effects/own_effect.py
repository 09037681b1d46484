"""An effect of one's own that is kept under a name: its definition, where it comes from, who can use it.

The same on a service, as a row, and on a machine, as a file.
"""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from itertools import chain, count
from typing import Any

from app.catalogue.service import view as effect_view
from ident.custom.definition import definition_of, is_name, read_effect
from ident.custom.names import refuse_symbol
from ident.diagnosis.result import Diagnosis
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.plain import written
from ident.presets import PRESETS
from schemas.catalogue import EffectView, OwnEffectView

WRITTEN = "written"
SEARCHED = "proposed by search"
"""Where an effect comes from; its definition says it as its `source`, wherever it goes."""
_ARTICLES = (["a"], ["an"], ["the"])
_WORDS = 40  # characters of a name that is made of a meaning


@dataclass(frozen=True, kw_only=True)
class OwnEffect:
    """An effect by its name; `model` is the one that it was made for, None for any that can read it.

    Of one that was `proposed by search`: the diagnosis, the data's hash, by how many `nats` it was confirmed and how
    many were asked for, and the forms that those data could not tell from it (`alike`).
    """

    name: str
    definition: Mapping[str, Any]
    model: str | None = None
    meaning: str = ""
    origin: str = WRITTEN
    diagnosis: str | None = None
    data_hash: str | None = None
    nats: float | None = None
    bar: float | None = None
    alike: tuple[str, ...] = ()
    version: str = field(default_factory=lambda: version("servoident"))
    created_at: str = ""

    def effect(self) -> Effect:
        """The effect in the model that it was made for. Raises Unusable where this version cannot read it."""
        return read_effect(self.definition, model=self.model or "")

    def suits(self, model: str) -> bool:
        """Whether a model can take it: it has what the equations name, in the units for which they were made."""
        try:
            found, made = read_effect(self.definition, model=model), self.effect()
        except Unusable:
            return False
        return self.model is None or found.units == made.units


def usable_on(entries: Iterable[OwnEffect], model: str) -> Iterator[OwnEffect]:
    """Those that a model can take."""
    return (entry for entry in entries if entry.suits(model))


def written_down(definition: Mapping[str, Any] | str, name: str, meaning: str = "", model: str = "") -> OwnEffect:
    """A definition under a name. Raises Unusable where it cannot be read, or the name is not free for an effect."""
    data = definition_of(definition) | {"name": name} | ({"meaning": meaning} if meaning else {})
    try:
        data = json.loads(json.dumps(data, default=str, allow_nan=False))
    except ValueError:
        raise Unusable("bad-number", "a number is not finite", "definition", "write a finite one") from None
    effect = read_effect(data, model=model)
    refuse_symbol(name, tuple(PRESETS.values()))
    origin = SEARCHED if effect.source == SEARCHED else WRITTEN
    return OwnEffect(name=name, definition=data, model=model or None, meaning=effect.meaning, origin=origin)


def proposed(found: Diagnosis, rank: int, name: str, meaning: str = "", diagnosis: str | None = None) -> OwnEffect:
    """A term that a diagnosis proposes, counted from 0, under a name. Raises Unusable where there is no such term."""
    terms = found.proposals or ()
    if not 0 <= rank < len(terms):
        there = f"give 0 to {len(terms) - 1}" if terms else "search for terms first"
        raise Unusable("no-such-proposal", f"of {len(terms)} terms none is number {rank}", "proposal", there)
    term = terms[rank]
    said = meaning or meaning_of(term.meaning, term.place)
    made = written_down({**term.effect, "source": SEARCHED}, name, said, found.model)
    return OwnEffect(
        name=name,
        definition=made.definition,
        model=found.model,
        meaning=made.meaning,
        origin=SEARCHED,
        diagnosis=diagnosis,
        data_hash=found.data_hash,
        nats=term.nats,
        bar=term.bar,
        alike=term.alike,
        version=found.version,
    )


def meaning_of(said: str, places: Iterable[str]) -> str:
    """What a term would mean, in words."""
    return said or f"a term at the {' and '.join(places)}"


def suggested(meaning: str, taken: Collection[str] = ()) -> str:
    """A free name for what is meant so: the words before its first stop, numbered where they are taken."""
    words: list[str] = re.findall(r"[a-z0-9]+", re.split(r"[^\w\s'’-]", meaning)[0].lower())
    words = words[words[:1] in _ARTICLES :] or ["own"]
    name, *rest = words if words[0][0].isalpha() else ("term", *words)
    for word in rest:
        if len(name) + len(word) >= _WORDS:
            break
        name += f"_{word}"
    tried = chain([name[:_WORDS]], (f"{name[:_WORDS]}_{number}" for number in count(2)))
    return next(one for one in tried if one not in taken and _free(one))


def _free(name: str) -> bool:
    """Whether neither the catalogue nor an equation has the name."""
    try:
        refuse_symbol(name, tuple(PRESETS.values()))
    except Unusable:
        return False
    return is_name(name) and name not in {effect.name for effect in CATALOGUE}


def view(kept: OwnEffect) -> OwnEffectView:
    """A kept effect as it is sent; of one that this version cannot read, why."""
    said, refused = {"class" if name == "alike" else name: entry for name, entry in written(kept).items()}, ""
    try:
        shown = effect_view(kept.effect())
    except Unusable as error:
        shown, refused = _unread(kept), str(error)
    return OwnEffectView(**said | shown.model_dump(), refused=refused)


def _unread(kept: OwnEffect) -> EffectView:
    return EffectView(
        name=kept.name,
        place=str(kept.definition.get("place", "")),
        meaning=kept.meaning,
        looks="",
        source=kept.origin,
        parameters=[],
        equations=[],
    )
