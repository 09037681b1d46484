"""Runs whose label does not fit their data: a wrong mass, gain or stiffness, a turned or scaled channel, a skew.

Each run is simulated by the fitted model with its labels changed, one at a time, over a ladder of values. A run is a
suspect where its error is an outlier among the runs and one change of a label removes most of the excess.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy  # optimize, which takes a tenth of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.chain.conditions import conditions
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.result import LabelErrors, Suspect
from ident.parallel import each
from ident.rounding import EPSILON
from ident.run import Run
from ident.simulation.simulate import Simulation
from ident.statistics.robust import robust_deviation
from ident.words.error import error_said

Array = NDArray[np.float64]
_MILLISECONDS = 1e3
"""Of a second. No answer depends on it: a unit."""
_LABELS = {"mass": "mL", "stiffness": "k", "gain": "Kp"}
_UNITS = {"mass": "kg", "stiffness": "N/m", "gain": "1"}


def label_suspects(models: CandidateModels, fitted: FittedModel, floors: Mapping[str, float | None]) -> list[Suspect]:
    """The estimation runs of the matrix with doubtful labels, worst first.

    `floors` is the noise floor of each run, as a fraction like eq. (17); the usual error of a run is in proportion.
    """
    runs = models.matrix.of_use("fit")
    if len(runs) < CRITERIA.labels.fewest_runs:
        return []
    errors = dict(
        zip((run.id for run in runs), each(lambda run: _errors(models, fitted, run, {})[0], runs), strict=True)
    )
    known = all(floors.get(run.id) for run in runs)
    scale = {run.id: (floors[run.id] or 1.0) if known else 1.0 for run in runs}
    ratios = np.log([max(errors[run.id], EPSILON) / scale[run.id] for run in runs])
    usual = float(np.median(ratios))
    spread = robust_deviation(ratios - usual)
    outside = [
        run
        for run, ratio in zip(runs, ratios, strict=True)
        if ratio - usual > max(np.log(CRITERIA.labels.least_excess), CRITERIA.labels.outlier * spread)
    ]
    if len(outside) > max(1, CRITERIA.labels.most * len(runs)):
        return []

    def suspect_of(run: Run) -> Suspect | None:
        return _label_suspect(models, fitted, run, float(np.exp(usual)) * scale[run.id], errors[run.id])

    found = [suspect for suspect in each(suspect_of, outside) if suspect is not None]
    return sorted(found, key=lambda s: (s.error.usual or 0.0) / (s.error.as_labelled or 1.0))


def _label_suspect(
    models: CandidateModels, fitted: FittedModel, run: Run, usual: float, error: float
) -> Suspect | None:
    """The change of a label that explains most of a run's excess, if one explains enough."""
    changes = [_label(models, fitted, run, what) for what in _LABELS] + _of_channel(models, fitted, run)
    what, stated, found, mended = min(changes, key=lambda change: change[3])
    if error**2 - mended**2 < CRITERIA.labels.explained * (error**2 - usual**2):
        return None
    unit, errors = _UNITS.get(what, "s" if what == "delay" else "1"), LabelErrors(error, usual, mended)
    return Suspect(
        run.id, what, stated, found, unit, errors, _evidence(what, stated, found, unit, error, usual, mended)
    )


def _evidence(what: str, stated: float, found: float, unit: str, error: float, usual: float, mended: float) -> str:
    """The evidence for a suspect, in a sentence."""
    label = f"with {what} {found:.4g} {unit} in place of {stated:.4g} {unit}"
    of_channel = {
        "sign": "turned in sign",
        "unit": f"multiplied by {found:.4g}",
        "delay": f"shifted by {_MILLISECONDS * found:.3g} ms",
    }
    return (
        f"the run's error is {error_said(error)}, where {error_said(usual)} would be usual; "
        f"{of_channel.get(what, label)} it is {error_said(mended)}"
    )


def _label(models: CandidateModels, fitted: FittedModel, run: Run, what: str) -> tuple[str, float, float, float]:
    """The best value of one label: its name, the stated value, the best value, and the error with it.

    A ladder of values, those of other runs among them, is tried; then the error is minimised between the neighbours of
    the best (Brent 1973), and the value there is taken where the errors do not tie.
    """
    name = _LABELS[what]
    stated = conditions(run, models.matrix.actuator)[name]
    others = {conditions(other, models.matrix.actuator)[name] for other in models.matrix.runs}
    tried = np.array(sorted({*others, *(stated * np.array(CRITERIA.labels.factors))} - {stated}))
    if not len(tried):
        return what, stated, stated, np.inf
    errors = _errors(models, fitted, run, {name: tried})
    best = int(np.argmin(errors))
    ladder = sorted({stated, *tried.tolist()})
    place = ladder.index(tried[best])
    lower, upper = ladder[max(place - 1, 0)], ladder[min(place + 1, len(ladder) - 1)]

    def error(value: float) -> float:
        return float(_errors(models, fitted, run, {name: np.array([value])})[0])

    near = {"xatol": CRITERIA.equality.tie * (upper - lower)}
    with np.errstate(invalid="ignore", over="ignore"):  # an unstable model has an infinite error
        between = scipy.optimize.minimize_scalar(error, bounds=(lower, upper), method="bounded", options=near)
    if CRITERIA.equality.practically_equal * float(between.fun) < errors[best]:
        return what, stated, float(between.x), float(between.fun)
    return what, stated, float(tried[best]), float(errors[best])


def _of_channel(models: CandidateModels, fitted: FittedModel, run: Run) -> list[tuple[str, float, float, float]]:
    """The label changes of a displacement: turned in sign, scaled or shifted."""
    y = _outputs(models, fitted, run, {})[:, 0]
    measured = run.centred
    power, model = float(measured @ measured), y - y.mean()
    if not np.all(np.isfinite(model)) or not model.any():
        return [("unit", 1.0, 1.0, np.inf)]
    factor = float(measured @ model / (measured @ measured))
    left = float(np.sqrt(np.sum((factor * measured - model) ** 2) / power)) / abs(factor) if factor else np.inf
    scaled = ("sign" if factor < -0.5 else "unit", 1.0, factor, left)
    lag = _shift(measured, model)
    late = float(np.std(measured - _later(model, lag)) * np.sqrt(len(model) / power))
    return [scaled, ("delay", 0.0, lag / run.sample_rate, late)]


def _shift(measured: Array, model: Array) -> float:
    """The samples by which a model's output has to be later, by the method of Gauss and Newton."""
    lag = 0.0
    for _ in range(CRITERIA.labels.shift_rounds):
        moved = _later(model, lag)
        slope = np.gradient(moved)
        lag += float(-(measured - moved) @ slope / (slope @ slope))
    return lag


def _later(samples: Array, lag: float) -> Array:
    """Samples that come so many samples later."""
    places = np.arange(len(samples))
    return np.asarray(np.interp(places - lag, places, samples))


def _errors(models: CandidateModels, fitted: FittedModel, run: Run, changed: Mapping[str, Array]) -> Array:
    """Eq. (17) of a run for each value of a changed label, (v,)."""
    with np.errstate(over="ignore", invalid="ignore"):
        left = fitted.fitness.left(run, _outputs(models, fitted, run, changed))
        errors = np.sqrt(np.mean(left**2, axis=0)) / run.measured.std()
    return np.where(np.isfinite(errors), errors, np.inf)


def _outputs(models: CandidateModels, fitted: FittedModel, run: Run, changed: Mapping[str, Array]) -> Array:
    """The model's outputs for a run with changed labels, (n, v)."""
    fitness = fitted.fitness
    known = {name: np.array([[value]]) for name, value in conditions(run, models.matrix.actuator).items()}
    found = {**fitness.space.fixed, **fitted.values}
    known |= {name: np.array([[value]]) for name, value in found.items()}
    known |= {name: np.asarray(values)[None] for name, values in changed.items()}
    vectors = max(np.shape(value)[1] for value in known.values())
    fresh = replace(fitness, runs=(run,), starts=dict(fitness.starts))
    fresh.begin(fitted.values)
    steps = int(fitness.steps({name: np.array([value]) for name, value in found.items()}).max())
    values = {name: np.broadcast_to(known[name], (1, vectors)) for name in fitness.chain.symbols}
    simulation = Simulation(fitness.chain, (run,), values, steps, fresh.first_states(run, values))
    return np.concatenate([rows[:, 0] for rows, _, _ in simulation.outputs()])
