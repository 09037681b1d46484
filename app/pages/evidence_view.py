"""Which figure shows an effect that a diagnosis found, beside the words of its card."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import urlencode

from app.diagnoses.service import Stored
from ident.custom.definition import read_effect
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.result import Ranked
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.figures import figures_for
from ident.presets import preset
from ident.residuals.views import view_of
from schemas.matrix import RunView

_BY_NAME = {effect.name: effect for effect in CATALOGUE}


def known_effect(name: str, own: Mapping[str, Any] | None) -> Effect | None:
    """An effect of one's own from its definition, or the catalogue's of that name; None where neither is there."""
    return read_effect(own) if own is not None else _BY_NAME.get(name)


def telling_run(runs: Sequence[RunView], errors: Mapping[str, float]) -> RunView | None:
    """Of the runs with the smallest amplitude, where most is nonlinear, the one with the largest error."""
    smallest = min((run.amplitude for run in runs if run.amplitude is not None), default=None)
    small = [run for run in runs if smallest is None or (run.amplitude or 0.0) == smallest]
    return max(small, key=lambda run: errors.get(run.id, 0.0), default=None)


def evidence(
    best: Ranked, found: Stored, own: Mapping[str, Any] | None, run: RunView | None = None
) -> tuple[str, str] | None:
    """The figure in which the effect shows, with what it predicts; None where it was not refitted or there is none.

    Where no curve shows it, because it is none or because what `run` shows is summed up, its Bode plot does. Of a
    diagnosis over windows there is none: over a whole run the machine sums up everything that disturbed it.
    """
    effect, model = known_effect(best.effect, own), preset(found.found.model)
    if effect is None or not best.parameters or found.found.horizon is not None:
        return None
    view = view_of(effect, model)
    return _figure(found, best.effect, view.name if view else "", run)


def proposal_evidence(term: Proposal, found: Stored, run: RunView | None = None) -> tuple[str, str] | None:
    """The same of a proposed term: what is missing at its place, and the term drawn through it."""
    if not term.parameters or found.found.horizon is not None:
        return None
    return _figure(found, str(term.effect["name"]), term.view, run)


def _figure(found: Stored, effect: str, view: str, run: RunView | None) -> tuple[str, str] | None:
    model = preset(found.found.model)
    curved = view and not (run and model.core.integrates(run.output, frozenset()))
    drawn = "residual-curve" if curved else "bode"
    if drawn not in figures_for(model):
        return None
    query = {"candidate": f"{found.id}:{effect}", **({"view": view} if curved else {"run": run.id if run else ""})}
    return drawn, urlencode({name: text for name, text in query.items() if text})
