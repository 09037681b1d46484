"""How far the characteristic of a model with proposed terms is from the true equation's.

The characteristic is the law that moves the machine: the flow that compresses the oil and moves the piston, Q − L, and
the force that resists, dry friction with it, R + f, both along the runs that were measured. It is compared with that of
the oracle, the true equation refitted to the same data, over the samples where pressure, speed and position lie within
what 5 to 95 % of them visit; of the two the one that is farther off counts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.custom.definition import preset_with
from ident.diagnosis.result import Diagnosis
from ident.fit.simulated_runs import SimulatedRuns
from ident.matrix import Matrix
from ident.preprocessing import prepare
from ident.residuals.traces import inside

Array = NDArray[np.float64]
_ALONG, _VISITED = ("P", "v", "x"), (0.05, 0.95)
_READ = (*_ALONG, "Q", "L", "R", "f")


def off(matrix: Matrix, model: str, true: tuple[Mapping[str, Any], Mapping[str, float]], found: Diagnosis) -> float:
    """The root mean square of the difference over that of the oracle's, of the law that is farther off.

    `true` are the definition of the true equation and the values of its fit by the parameters' names.
    """
    own, values = true
    oracle = _laws(matrix, model, (str(own["name"]),), (own,), values)
    ours = _laws(matrix, model, *ending(found))
    inner = np.all([_within(oracle[name]) for name in _ALONG], axis=0)
    pairs = [(one["Q"] - one["L"], one["R"] + one["f"]) for one in (oracle, ours)]
    return max(_rms((b - a)[inner]) / _rms(a[inner]) for a, b in zip(*pairs, strict=True))


def ending(found: Diagnosis) -> tuple[list[str], list[Mapping[str, Any]], dict[str, float]]:
    """What a diagnosis ends with, its proposals added: effects, definitions of one's own, values by name."""
    proposed = found.proposals or ()
    custom = [one.effect for one in proposed]
    parameters = proposed[-1].parameters if proposed else found.ladder[-1].parameters
    beside = proposed[-1].beside if proposed else found.verdict.effects
    return [*beside, *(str(one["name"]) for one in custom)], custom, {n: one.value for n, one in parameters.items()}


def _laws(
    matrix: Matrix, model: str, effects: Sequence[str], custom: Sequence[Mapping[str, Any]], known: Mapping[str, float]
) -> dict[str, Array]:
    """The signals inside a model, all runs one behind the other."""
    preset, driven = prepare(preset_with(model, effects, custom), matrix)
    values = {p.in_equations: known.get(p.name, p.value) for p in preset.parameters}
    runs = driven.of_use("fit")
    traces = inside(SimulatedRuns(preset, driven, runs, np.inf), values, _READ)
    return {name: np.concatenate([traces[name][run.id] for run in runs]) for name in _READ}


def _within(signal: Array) -> NDArray[np.bool_]:
    low, high = np.quantile(signal, _VISITED)
    return np.asarray((signal >= low) & (signal <= high))


def _rms(x: Array) -> float:
    return float(np.sqrt(np.mean(x**2)))
