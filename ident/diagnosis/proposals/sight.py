"""What a model that ended above the noise offers to be added at its places."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.chain.conditions import CONDITIONS
from ident.diagnosis.family import ModelFamily
from ident.diagnosis.proposals import free_curves
from ident.diagnosis.proposals.candidate import Candidate, offered
from ident.diagnosis.proposals.recorded import recorded_beside, units_of
from ident.diagnosis.proposals.records import paths, records
from ident.diagnosis.proposals.regression import regression
from ident.diagnosis.proposals.softness import OIL
from ident.diagnosis.proposals.terms import ALONE, Library
from ident.diagnosis.refit import Refit
from ident.effects.effect import Effect
from ident.parameter import Parameter
from ident.presets import Preset

Array = NDArray[np.float64]
_PLACES = {
    "e": "controller", "dq": "valve", "w": "spool", "Q": "flow", "R": "load", "y_fb": "sensor", "y": "sensor",
}  # fmt: skip
_READ, _LOOP = "y_fb", "y_in"  # what the transducer reads is another place than the record where a loop uses it
_SIGNALS = ("w", "Q", "P", "v", "x", "F")
_VARIED = ("Kp", "mL", "k")  # conditions of a run
_PROPORTIONAL = 1.0 - 1e-6  # cosine of signals that are one


@dataclass(frozen=True)
class Sight:
    """The candidates, best first, and how many were looked at; samples of the signals they are of, and their units."""

    candidates: tuple[Candidate, ...]
    looked_at: int
    typical: Mapping[str, Array]
    units: Mapping[str, str]


def sight(models: ModelFamily, base: Refit, instead_of: Effect | None = None, curves: bool = False) -> Sight:
    """Of a model that was refitted to the runs that search; what could be there `instead_of` an effect that it has.

    Terms, or free `curves`.
    """
    preset = models.preset
    named = {equation.target for equation in preset.core.equations if not equation.is_rate} | {*preset.core.states}
    names = [name for name in _SIGNALS if name in named]
    places = {at: place for at, place in _PLACES.items() if at in named and (at != _READ or _LOOP in named)}
    numbers = [p.in_equations for p in instead_of.added] if instead_of else []
    runs = records(base, list(dict.fromkeys((*names, *places, *(named & {OIL})))), numbers)
    typical = {name: np.concatenate([record.signals[name] for record in runs]) for name in runs[0].signals}
    units = {name: quantity.unit for name, quantity in CONDITIONS.items()}
    units |= {**units_of(models.runs[0]), **preset.chain.units}
    shortest = min(run.duration for run in models.runs)
    varied = [name for name in _VARIED if np.ptp(typical[name]) > 0]
    names = _distinct(names, typical)
    library = Library(
        places, _there(preset, places, names), typical, units, models.band, shortest, varied, recorded_beside(models)
    )
    responses = {at: paths(preset, base.values, models.matrix.actuator, at, runs) for at in places}
    if curves:
        drawn = free_curves.free_curves(library)
        hats = [hat for curve in drawn for hat in curve.hats()]
        candidates = free_curves.offered(regression(hats, runs, responses, models.band), drawn) if hats else ()
        return Sight(candidates, len(drawn), typical, units)
    found = regression(list(library.terms()), runs, responses, models.band)
    candidates, looked_at = offered(found, units)
    return Sight(candidates, looked_at, typical, units)


def _there(preset: Preset, places: Mapping[str, str], names: Sequence[str]) -> dict[str, list[str]]:
    """The signals that terms which add to each signal may be of."""
    return {
        at: [at] if place == ALONE else [name for name in names if _known_there(preset, place, at, name)]
        for at, place in places.items()
    }


def _known_there(preset: Preset, place: str, at: str, name: str) -> bool:
    """Whether a signal is known where a term adds to another: it does not follow from that one at once."""
    probe = Effect("probe", place, "", Parameter("s", "s", "1", -1.0, 1.0, 0.0, ""), (f"{at} = {at} + s * {name}",))
    return preset.takes(probe)


def _distinct(names: Sequence[str], typical: Mapping[str, Array]) -> list[str]:
    """The signals that move, without those that are another one in other units."""
    kept: list[str] = []
    for name in names:
        x = typical[name]
        if np.ptp(x) > 0 and not any(_cosine(x, typical[other]) > _PROPORTIONAL for other in kept):
            kept.append(name)
    return kept


def _cosine(a: Array, b: Array) -> float:
    return abs(float(a @ b)) / float(np.linalg.norm(a) * np.linalg.norm(b))
