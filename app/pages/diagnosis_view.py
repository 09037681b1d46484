"""A diagnosis as the page of its fit shows it: the verdict, a card an effect or group, suspects, the residual."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from app.diagnoses.service import Stored
from app.pages.effect_view import Member, member
from app.pages.evidence_view import evidence, known_effect
from app.pages.job_view import JobPageView, job_page
from app.pages.proposed_view import ProposedCard, proposed
from ident.diagnosis.discovery.term_count_curve import TermCount, term_count_curve
from ident.diagnosis.result import Diagnosis, Ranked, Suspect
from ident.words.engineering import quantity
from ident.words.error import ErrorOf
from ident.words.number import plain
from ident.words.percent import percent_in_print, probability_said
from ident.words.titles import title
from schemas.fit import JobView
from schemas.matrix import RunView

_LABELS = {"mass": "kg", "stiffness": "N/m", "gain": ""}
"""Labels that a revision can mend, with the unit that it writes."""
_USES = ("fit", "held_out", "verify")


@dataclass(frozen=True)
class Card:
    """An effect that the model lacks, or a group that the data cannot tell apart, the best first.

    `confirmed`: a refit helped beyond chance; `chosen`: the diagnosis would add it; `gauge`: see the page;
    `evidence`: name and query of the figure that shows it.
    """

    rank: int
    title: str
    members: tuple[Member, ...]
    predicted: float | None
    error: Mapping[str, ErrorOf]
    words: str
    looks: str
    confirmed: bool
    chosen: bool
    gauge: tuple[float, float, float]
    evidence: tuple[str, str] | None
    probability: str

    @property
    def group(self) -> bool:
        """True where it is more than one effect."""
        return len(self.members) > 1

    @property
    def determined(self) -> bool:
        """Whether the data determine the strength of what the card would add."""
        return all(member.determined for member in self.addable)

    @property
    def addable(self) -> tuple[Member, ...]:
        """The members that can be added."""
        return tuple(member for member in self.members if member.known)


@dataclass(frozen=True)
class SuspectCard:
    """A run whose label is doubted; `mend` is the revision that writes what the data say, as JSON, "" for none."""

    run: str
    what: str
    stated: str
    found: str
    words: str
    mend: str


@dataclass(frozen=True)
class Rung:
    """A step that the diagnosis would take; `nats` by which it made the held-out data more likely."""

    added: str
    error: Mapping[str, ErrorOf]
    nats: str


@dataclass(frozen=True)
class MissingView:
    """The section *Missing effects* of a fit; without a diagnosis only the button, or the job that makes one."""

    job: JobPageView | None
    found: Diagnosis | None
    id: str = ""
    made: str = ""
    seconds: str = ""
    would_add: tuple[Member, ...] = ()
    cards: tuple[Card, ...] = ()
    chance: tuple[Card, ...] = ()
    suspects: tuple[SuspectCard, ...] = ()
    ladder: tuple[Rung, ...] = ()
    left: str = ""
    proposed: tuple[ProposedCard, ...] = ()
    choices: tuple[TermCount, ...] = ()
    refused: tuple[str, ...] = ()


def missing(stored: Stored | None, job: JobView | None, run: RunView | None = None) -> MissingView:
    """The section for the newest diagnosis of a fit and the newest job that was to make one.

    `run` is the one that shows what no curve does.
    """
    shown = job_page(job) if job is not None and job.state != "succeeded" else None
    if stored is None:
        return MissingView(shown, None)
    found, cards = stored.found, tuple(_cards(stored, run))
    return MissingView(
        job=shown,
        found=found,
        id=stored.id,
        made=stored.created_at,
        seconds=quantity(found.seconds, "s"),
        would_add=_would_add(cards, found.verdict.effects),
        cards=tuple(card for card in cards if card.confirmed),
        chance=tuple(card for card in cards if not card.confirmed),
        suspects=tuple(map(_suspect, found.verdict.suspects)),
        ladder=tuple(_ladder(found)),
        left=_left(found) if found.verdict.unexplained else "",
        proposed=tuple(proposed(stored, run)),
        choices=term_count_curve(found.proposals or (), found.ladder),
        refused=found.notes,
    )


def _would_add(cards: tuple[Card, ...], names: tuple[str, ...]) -> tuple[Member, ...]:
    """The members of that name that can be added, in the order of the verdict."""
    members = {member.name: member for card in cards for member in card.addable}
    return tuple(members[name] for name in names if name in members)


def _cards(stored: Stored, run: RunView | None) -> Iterator[Card]:
    """A card for each candidate; those of a group share the card of the best."""
    candidates = stored.found.candidates
    by_name = {candidate.effect: candidate for candidate in candidates}
    shown: set[str] = set()
    rank = 0
    for candidate in candidates:
        if candidate.effect in shown:
            continue
        others = [name for name in candidate.group if name != candidate.effect and name in by_name]
        together = [candidate, *(by_name[name] for name in others)]
        shown |= {member.effect for member in together}
        rank += 1
        yield _card(rank, together, stored, run)


def _card(rank: int, together: list[Ranked], stored: Stored, run: RunView | None) -> Card:
    found, best = stored.found, together[0]
    own = {str(definition["name"]): definition for definition in found.settings.get("custom", ())}
    looks = str(best.evidence.get("looks", ""))
    return Card(
        rank=rank,
        title=" or ".join(title(candidate.effect) for candidate in together),
        members=tuple(_member(candidate, own.get(candidate.effect)) for candidate in together),
        predicted=best.predicted_error,
        error={use: best.error_of(use) for use in _USES},
        words=best.why,
        looks="" if looks in best.why else looks,
        confirmed=bool(best.evidence.get("beyond_chance")),
        chosen=any(candidate.effect in found.verdict.effects for candidate in together),
        gauge=_gauge(best, found),
        evidence=evidence(best, stored, own.get(best.effect), run),
        probability=_probability(found, together),
    )


def _probability(found: Diagnosis, together: list[Ranked]) -> str:
    """How probable it is that the effect, or one of the group, is missing; "" where an earlier version did not ask."""
    verdict, names = found.verdict, {candidate.effect for candidate in together}
    of_groups = zip(verdict.indistinguishable, verdict.group_probabilities, strict=False)
    of_group = next((p for group, p in of_groups if names == {*group}), None)
    known = together[0].probability if of_group is None else of_group
    return "" if known is None else probability_said(known)


def _gauge(best: Ranked, found: Diagnosis) -> tuple[float, float, float]:
    """Confirmed error, predicted error and noise floor in per cent of the error without the effect."""
    before = found.baseline.error.get("held_out") or 1.0
    floor = found.noise_floor.get("fit")
    parts = (best.error.get("held_out"), best.predicted_error, floor)
    confirmed, predicted, lowest = (min(100.0, 100 * (part or 0.0) / before) for part in parts)
    return round(confirmed, 1), round(predicted, 1), round(lowest, 1)


def _member(candidate: Ranked, own: Mapping[str, Any] | None) -> Member:
    effect = known_effect(candidate.effect, own)
    return member(candidate.effect, effect, candidate.parameters, own)


def _suspect(entry: Suspect) -> SuspectCard:
    return SuspectCard(
        run=entry.run,
        what=entry.what,
        stated=quantity(entry.stated, entry.unit),
        found=quantity(entry.found, entry.unit),
        words=entry.evidence,
        mend=_mend(entry),
    )


def _mend(entry: Suspect) -> str:
    """What a revision of the matrix would change."""
    if entry.what not in _LABELS or entry.found is None:
        return ""
    unit = _LABELS[entry.what]
    label = (
        {"specimen": {entry.what: f"{entry.found:.4g} {unit}"}} if unit else {entry.what: float(f"{entry.found:.4g}")}
    )
    return json.dumps({"runs": {entry.run: label}})


def _ladder(found: Diagnosis) -> Iterator[Rung]:
    for rung in found.ladder:
        said = "–" if rung.nats is None else plain(rung.nats, 3)
        errors = {use: rung.error_of(use) for use in _USES}
        yield Rung(title(rung.added) if rung.added else "current fit", errors, said)


def _left(found: Diagnosis) -> str:
    """What stays unexplained, in a sentence."""
    error, floor = found.confirmed_ladder[-1].error_of("fit").in_print(), found.noise_floor.get("fit")
    after = " with all recommended effects" if len(found.confirmed_ladder) > 1 else ""
    if floor is None:
        return f"The error is {error}{after}, and the residual is not white."
    return f"The error is {error}{after}, above the noise floor of {percent_in_print(floor)}."
