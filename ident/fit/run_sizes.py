"""The sizes of a matrix's runs: what the ranges of a search are measured by."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ident.chain.conditions import conditions
from ident.matrix import Matrix
from ident.run import Run


def run_sizes(matrix: Matrix, runs: Sequence[Run], band: float) -> dict[str, float]:
    """The mean conditions of the runs and :data:`ident.stages.scale.OF_THE_RUNS`, SI: all that a scale may read.

    `band` is the angular frequency up to which the command excites the machine, rad/s.
    """
    each = [conditions(run, matrix.actuator) for run in runs]
    mean = {name: float(np.mean([values[name] for values in each])) for name in each[0]}
    mean["Kp"] = float(np.exp(np.mean([np.log(abs(values["Kp"])) for values in each])))
    mean |= {
        "X": _size(runs, lambda run: float(np.std(run.measured))),
        "U": _size(runs, lambda run: run.drive),
        "L": float(np.mean([run.motion for run in runs])),
        "M": max(float(np.max(np.abs(run.command))) for run in runs),
        "W": band,
        "H": max(run.dwell for run in runs),
    }
    mean["V"] = _speed(runs) or band * mean["L"]
    return mean | {"mL": mean["mL"] or 1.0}


def measured_by(runs: Sequence[Run]) -> str:
    """The channel by which a machine is measured: the displacement where one run records it."""
    return "displacement" if any(run.output == "displacement" for run in runs) else runs[0].output


def _speed(runs: Sequence[Run]) -> float:
    """The deviation of the speed where it was recorded; zero where not."""
    known = all("velocity" in run.channels for run in runs)
    return float(np.mean([np.std(run.channels["velocity"]) for run in runs])) if known else 0.0


def _size(runs: Sequence[Run], of: Callable[[Run], float]) -> float:
    """Of the displacements, where some runs record them and others something else; else of the first run's output."""
    first = measured_by(runs)
    return float(np.mean([of(run) for run in runs if run.output == first]))
