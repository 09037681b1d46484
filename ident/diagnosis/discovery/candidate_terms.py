"""The candidate terms for the places of a model whose residual is above the noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.chain.conditions import CONDITIONS
from ident.diagnosis.auxiliary_channels import auxiliary_channels, units_of
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.discovery import free_curves
from ident.diagnosis.discovery.compressibility_terms import OIL
from ident.diagnosis.discovery.regression import regression
from ident.diagnosis.discovery.run_data import RunData, run_data, signal_paths
from ident.diagnosis.discovery.term_candidate import TermCandidate, term_candidates
from ident.diagnosis.discovery.term_library import ALONE, TermLibrary
from ident.diagnosis.fitted_model import FittedModel
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.parameter import Parameter
from ident.presets import Preset
from ident.residuals.decimation import Response
from ident.rounding import EPSILON

Array = NDArray[np.float64]
_PLACES = {
    "e": "controller",
    "dq": "valve",
    "w": "spool",
    "Q": "flow",
    "R": "load",
    "y_fb": "sensor",
    "y": "sensor",
}
_READ, _LOOP = "y_fb", "y_in"  # the transducer's signal is another place than the record where a loop uses it
_SIGNALS = ("w", "Q", "P", "v", "x", "F")
_VARIED = ("Kp", "mL", "k")  # conditions of a run


@dataclass(frozen=True)
class CandidateTerms:
    """The candidates, best first, the number of terms `looked_at`, samples of the signals in them, and their units.

    `left_out` counts the terms whose response of the output is not known or not finite.
    """

    candidates: tuple[TermCandidate, ...]
    looked_at: int
    typical: Mapping[str, Array]
    units: Mapping[str, str]
    left_out: int = 0


def candidate_terms(
    models: CandidateModels, base: FittedModel, instead_of: Effect | None = None, curves: bool = False
) -> CandidateTerms:
    """The terms for a model that was refitted to the runs that search, or the terms `instead_of` one of its effects.

    With `curves` the candidates are free curves.
    """
    numbers = [p.in_equations for p in instead_of.added] if instead_of else []
    return terms_of_runs(models, base.values, run_data(base, list(signals_of(models.preset)), numbers), curves)


def terms_of_runs(
    models: CandidateModels, values: Mapping[str, float], runs: Sequence[RunData], curves: bool = False
) -> CandidateTerms:
    """The candidate terms on the records of a model with these `values`, by the equations' names."""
    preset = models.preset
    places, names = places_of(preset), _inside(preset)
    typical = {name: np.concatenate([record.signals[name] for record in runs]) for name in runs[0].signals}
    units = {name: quantity.unit for name, quantity in CONDITIONS.items()}
    units |= {**units_of(models.runs[0]), **preset.chain.units}
    shortest = min(run.duration for run in models.runs)
    with np.errstate(all="ignore"):  # terms that are not finite are left out below
        varied = [name for name in _VARIED if np.ptp(typical[name]) > 0]
        names = _distinct(names, typical)
        there = _there(preset, places, names, typical)
        library = TermLibrary(
            places,
            there,
            typical,
            units,
            models.band,
            shortest,
            varied,
            auxiliary_channels(models.preset, models.matrix.runs, models.runs),
        )
        drawn = free_curves.free_curves(library) if curves else []
        terms = [hat for curve in drawn for hat in curve.hats()] if curves else list(library.terms())
    responses = _responses(models, values, list(dict.fromkeys(term.path for term in terms)), runs)
    if curves:
        followed = [curve for curve in drawn if curve.term.path in responses]
        hats = [hat for curve in followed for hat in curve.hats()]
        found = regression(hats, runs, responses, models.band) if hats else None
        candidates = free_curves.offered(found, followed) if found else ()
        return CandidateTerms(candidates, len(drawn), typical, units, len(drawn) - len(followed))
    followed_terms = [term for term in terms if term.path in responses]
    lost = len(terms) - len(followed_terms)
    if not followed_terms:
        return CandidateTerms((), len(terms), typical, units, lost)
    found = regression(followed_terms, runs, responses, models.band)
    candidates, looked_at = term_candidates(found, units)
    return CandidateTerms(candidates, looked_at, typical, units, lost + found.left_out)


def places_of(preset: Preset) -> dict[str, str]:
    """The signals of a machine that a term may add to, each with its place.

    No state is among them: an effect of a user redefines signals alone, because a state follows its rate.
    """
    signals = _signals(preset)
    return {at: place for at, place in _PLACES.items() if at in signals and (at != _READ or _LOOP in signals)}


def signals_of(preset: Preset) -> tuple[str, ...]:
    """The signals and states that terms read or add to."""
    return tuple(dict.fromkeys((*_inside(preset), *places_of(preset), *(_signals(preset) & {OIL}))))


def _signals(preset: Preset) -> set[str]:
    return {equation.target for equation in preset.core.equations if not equation.is_rate}


def _inside(preset: Preset) -> list[str]:
    """The signals and states that a term may read."""
    named = _signals(preset) | {*preset.core.states}
    return [name for name in _SIGNALS if name in named]


def _responses(
    models: CandidateModels, values: Mapping[str, float], signals: Sequence[str], runs: Sequence[RunData]
) -> dict[str, list[Response]]:
    """The responses from each of these signals to the output of every run; signals without a linear model are
    absent."""
    found = {}
    for at in signals:
        with suppress(Unusable):
            responses = signal_paths(models.preset, values, models.matrix.actuator, at, runs)
            if responses is not None:
                found[at] = responses
    return found


def _there(
    preset: Preset, places: Mapping[str, str], names: Sequence[str], typical: Mapping[str, Array]
) -> dict[str, list[str]]:
    """For each place the signals that terms there may read: a signal that does not move has none."""
    there = {}
    for at, place in places.items():
        if place == ALONE:
            there[at] = [at] if np.any(typical[at] != typical[at][0]) else []
        else:
            there[at] = [name for name in names if _known_there(preset, place, at, name)]
    return there


def _known_there(preset: Preset, place: str, at: str, name: str) -> bool:
    """Whether a term that adds to the signal `at` may read another: it must not follow from `at` at the same
    instant."""
    probe = Effect("probe", place, "", Parameter("s", "s", "1", -1.0, 1.0, 0.0, ""), (f"{at} = {at} + s * {name}",))
    return preset.takes(probe)


def _distinct(names: Sequence[str], typical: Mapping[str, Array]) -> list[str]:
    """The signals that move, without duplicates in other units."""
    kept: list[str] = []
    for name in names:
        x = typical[name]
        moves = bool(np.all(np.isfinite(x))) and np.ptp(x) > 0
        if moves and not any(_cosine(x, typical[other]) > 1.0 - EPSILON for other in kept):
            kept.append(name)
    return kept


def _cosine(a: Array, b: Array) -> float:
    return abs(float(a @ b)) / float(np.linalg.norm(a) * np.linalg.norm(b))
