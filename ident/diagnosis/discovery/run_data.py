"""The data of each run for a search for terms: sensitivities, residual, signals inside the model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import linear_model
from ident.chain.conditions import conditions
from ident.diagnosis.auxiliary_channels import channels_of
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.fit.multiple_shooting import ShootingWindows
from ident.fit.responses import Sensitivities
from ident.matrix import Actuator
from ident.parallel import each
from ident.presets import Preset
from ident.residuals.decimation import Response, averaged, stride
from ident.residuals.traces import inside
from ident.residuals.views import injected
from ident.run import Run

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RunData:
    """One run on the coarse clock of `rate` Hz.

    Sensitivities to the parameters (n, p) and to the nuisance parameters of the run, `free` (n, s), and the residual
    (n,), all counted from the beginning of each window of the `anchoring`, where it has windows.

    `signals` are the signals inside the model, the conditions of the run, its auxiliary channels and the time, by name,
    (n,).
    """

    run: Run
    rate: float
    sensitivities: Array
    free: Array
    residual: Array
    anchoring: ShootingWindows
    signals: Mapping[str, Array]


def run_data(refit: FittedModel, names: Sequence[str], instead_of: Sequence[str] = ()) -> tuple[RunData, ...]:
    """The runs that a refit was made for, with the signals of these names.

    Where the search replaces a term, `instead_of` are its strength and its shapes in the equations' names: they are no
    parameters then, and the residual is that without the term.
    """
    fitness, point = refit.fitness, refit.point
    windows = [fitness.anchoring(run).window for run in fitness.runs]
    count = next(n for n in range(stride(fitness.runs), 0, -1) if all(window % n == 0 for window in windows))
    most = samples_of_each(len(fitness.runs))
    sensitivities = Sensitivities.of(fitness, point)
    values = {name: float(value[0]) for name, value in fitness.space.values(point[None]).items()}
    inner = inside(fitness.whole(), values, names)

    kept = [i for i, name in enumerate(refit.space.names) if name not in instead_of]
    put_back = point - refit.space.point({**refit.values, **dict.fromkeys(instead_of[:1], 0.0)})

    def one(run: Run) -> RunData:
        Z = sensitivities.columns[run.id].Z
        coarse = np.array([averaged(row, count)[:most] for row in Z]).T
        shown = {name: averaged(inner[name][run.id], count)[:most] for name in names}
        n, rate = len(coarse), run.sample_rate / count
        known: dict[str, Array] = {
            name: np.full(n, value) for name, value in conditions(run, fitness.matrix.actuator).items()
        }
        known |= {name: averaged(samples, count)[:most] for name, samples in channels_of(run).items()}
        time = {"t": np.asarray((np.arange(n) + 0.5) / rate, float)}
        p = len(point)
        residual = coarse[:, -1] + coarse[:, :p] @ put_back
        return RunData(
            run, rate, coarse[:, kept], coarse[:, p:-2], residual, fitness.anchoring(run, count), known | time | shown
        )

    return tuple(each(one, fitness.runs))


def samples_of_each(runs: int) -> int:
    """The samples on the coarse clock that each of so many runs has at most."""
    return max(CRITERIA.discovery.fewest_samples, CRITERIA.estimation.rough_samples // runs)


def signal_paths(
    preset: Preset, values: Mapping[str, float], actuator: Actuator, at: str, runs: Sequence[RunData]
) -> list[Response] | None:
    """For each record the linear response of the output to an addition to the signal `at`.

    None where the linear model is not finite on a record. Raises Unusable where there is no linear model.
    """
    broken = injected(preset.core, at)
    found: dict[object, Response] = {}
    for record, key in zip(runs, map(_linear_model_key, runs), strict=True):
        if key not in found:
            model = linear_model(broken, values, record.run, actuator)
            if not all(np.all(np.isfinite(of)) for of in (model.A, model.B, model.C, model.D)):
                return None
            found[key] = Response.of([model], record.rate)
    return [found[key] for key in map(_linear_model_key, runs)]


def _linear_model_key(record: RunData) -> object:
    """The properties that determine the linear model of a record."""
    run = record.run
    return run.specimen, run.gain, run.output, record.rate
