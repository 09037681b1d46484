"""Terms that no list holds, as the page of a fit tells of them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from markupsafe import Markup

from app.diagnoses.service import Stored
from app.pages.evidence_view import proposal_evidence
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.discovery.term_to_effect import curves
from ident.diagnosis.named import Named, named
from ident.diagnosis.result import Rung
from ident.equations.mathml import mathml
from ident.words.error import ErrorOf
from ident.words.message import message
from ident.words.number import plain
from ident.words.plus_minus import UNDETERMINED, determined, plus_minus
from ident.words.titles import title
from schemas.matrix import RunView


@dataclass(frozen=True)
class ProposedCard:
    """A term on top of those before it; `effects` and `definitions` are what a form adds to have all of them."""

    rank: int
    title: str
    equations: tuple[Markup, ...]
    strength: str
    determined: bool
    against: str
    error: Mapping[str, ErrorOf]
    evidence: str
    alike: tuple[str, ...]
    beside: str
    instead_of: str
    shapes: str
    hypothesis: bool
    effects: tuple[str, ...]
    definitions: tuple[str, ...]
    evidence_of: tuple[str, str] | None


def proposed(stored: Stored, run: RunView | None) -> Iterator[ProposedCard]:
    """A card for each term; where no curve shows it, the Bode plot of `run` does."""
    found = stored.found
    for rank, one in enumerate(found.proposals or (), 1):
        added = named(found, str(one.effect["name"])) or Named()
        shapes = (
            f"{symbol} = {entry['value']:.4g} {entry['unit']}" for symbol, entry in one.effect.get("shape", {}).items()
        )
        yield ProposedCard(
            rank=rank,
            title=one.meaning[:1].upper() + one.meaning[1:]
            if one.meaning
            else f"A term at the {' and '.join(one.place)}",
            equations=tuple(Markup(mathml(line, curves(one.effect))) for line in one.effect["equation"]),
            strength=UNDETERMINED if one.std_error is None else plus_minus(one.strength, one.std_error, one.unit),
            determined=one.std_error is not None and determined(one.strength, one.std_error),
            against=str(one.contradicted.message("it")) if one.contradicted else "",
            error={use: one.error_of(use) for use in ("held_out", "fit", "verify")},
            evidence=f"{plain(one.nats, 3)} nats, threshold {plain(one.bar, 3)}",
            alike=one.alike,
            beside=", ".join(map(title, one.beside)),
            instead_of=_instead_of(one, found.ladder),
            shapes="; ".join(shapes),
            hypothesis=one.hypothesis,
            effects=added.effects,
            definitions=tuple(json.dumps(dict(definition)) for definition in added.custom),
            evidence_of=proposal_evidence(one, stored, run),
        )


def _instead_of(one: Proposal, ladder: Sequence[Rung]) -> str:
    """What the catalogue named in its place, and its error on runs to verify."""
    names = ", ".join(map(title, one.instead_of))
    left = ladder[-1].error_of("verify") if ladder else ErrorOf(None)
    if left.is_unstable:
        return str(message("instead.unstable", names=names, unstable=left.in_print()))
    if not names or left.error is None:
        return names
    return str(message("instead.error", names=names, error=left.in_print()))
