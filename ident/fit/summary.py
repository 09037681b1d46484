"""From an optimum to a result in the contract's words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.fit.objective import UNSTABLE, Local, Objective
from ident.fit.record import Moments
from ident.fit.result import Combination, Estimate, FitResult, Generation, RunError, Undetermined
from ident.fit.settings import Settings
from ident.fit.uncertainty import DETERMINED, Covariance, covariance, determined_combinations
from ident.matrix import Run
from ident.noise import noise_floor

Array = NDArray[np.float64]


def summarise(
    objective: Objective, settings: Settings, point: Array, here: Local, state: Mapping[str, Any], seconds: float
) -> FitResult:
    """The result of a fit that ended at `point`, where the objective is `here`."""
    space, matrix, preset = objective.space, objective.matrix, objective.preset
    values = {name: float(found[0]) for name, found in space.values(point[None]).items()}
    verify_runs = matrix.of_use("verify")
    verify = replace(objective, runs=verify_runs).exact(point, sensitivities=False).runs if verify_runs else ()
    fit_errors, verify_errors = _run_errors(objective.runs, here.runs), _run_errors(verify_runs, verify)
    found = covariance(here, space.values, point, space.names) if space.axes else Covariance((), np.empty((0, 0)))
    weak = [name for name in space.names if found.relative({name: 1}) > DETERMINED]
    if space.convention:
        weak.append(space.convention)
    floors = {"fit": _floor(objective.runs, objective.basis.band), "verify": _floor(verify_runs, objective.basis.band)}
    label = _labels(objective)
    return FitResult(
        model=preset.name,
        effects=settings.effects,
        parameters={label[name][0]: _estimate(objective, name, values, found, point) for name in space.order},
        correlation=_renamed(found.correlation(), label),
        determined=tuple(_combinations(objective, found, weak, values)),
        undetermined=tuple(Undetermined(label[name][0], _reason(objective, name, found)) for name in weak),
        error={"fit": _mean(fit_errors, "error"), "held_out": None, "verify": _mean(verify_errors, "error")},
        offset={"fit": _mean(fit_errors, "offset"), "verify": _mean(verify_errors, "offset")},
        noise_floor=floors,
        runs=(*fit_errors, *verify_errors),
        method=settings.method,
        seed=settings.seed,
        evaluations=objective.evaluations,
        seconds=seconds,
        version=version("servoident"),
        data_hash=matrix.data_hash,
        notes=tuple(_notes(objective, floors, here)),
        settings=settings.to_json(),
        searched=tuple(label[name][0] for name in space.names),
        evolution=_evolution(objective, state),
    )


def _run_errors(runs: Sequence[Run], found: Sequence[Moments]) -> tuple[RunError, ...]:
    return tuple(
        RunError(run.id, run.use, min(m.error, UNSTABLE), float(np.clip(m.offset, -UNSTABLE, UNSTABLE)))
        for run, m in zip(runs, found, strict=True)
    )


def _mean(runs: Sequence[RunError], what: str) -> float | None:
    return float(np.mean([getattr(run, what) for run in runs])) if runs else None


def _floor(runs: Sequence[Run], band: float) -> float | None:
    floors = [noise_floor(run, band) for run in runs]
    known = [floor for floor in floors if floor is not None]
    return float(np.mean(known)) if known and len(known) == len(floors) else None


def _labels(objective: Objective) -> dict[str, tuple[str, str]]:
    """Name and unit under which a parameter is reported: a ratio to the area where the area is unknown."""
    plain = {parameter.name: (parameter.name, parameter.unit) for parameter in objective.preset.parameters}
    known = objective.matrix.actuator.piston_area is not None
    return plain if known else plain | dict(objective.preset.without_area or {})


def _estimate(
    objective: Objective, name: str, values: Mapping[str, float], found: Covariance, point: Array
) -> Estimate:
    parameter, value = objective.preset.parameter(name), values[name]
    unit = _labels(objective)[name][1]
    if name not in objective.space.names:
        return Estimate(value, unit, None, value, value, False, parameter.symbol, parameter.meaning, fixed=True)
    lower, upper = objective.space.bounds(values)[name]
    relative = found.relative({name: 1})
    place = float(point[objective.space.names.index(name)])
    return Estimate(
        value, unit, value * relative if relative < DETERMINED else None, lower, upper,
        not 1e-6 < place < 1 - 1e-6, parameter.symbol, parameter.meaning,
    )  # fmt: skip


def _combinations(
    objective: Objective, found: Covariance, weak: Sequence[str], values: Mapping[str, float]
) -> list[Combination]:
    label = _labels(objective)
    convention = objective.space.convention
    if convention:  # along the convention every force scales with it, and the data do not see it
        found = _with_convention(objective, found)
    known = [name for name in found.names if name not in weak]
    singles = [] if not weak else [
        Combination(label[name][0], values[name], label[name][1], values[name] * found.relative({name: 1}))
        for name in known
    ]  # fmt: skip
    return singles + [
        Combination(_formula(exponents, label), value, _unit(exponents, label), value * error)
        for exponents, value, error in determined_combinations(found, weak, values)
    ]


def _with_convention(objective: Objective, found: Covariance) -> Covariance:
    """The covariance with the conventional mass set free: (m0, c0) times s and (Ka, Cl) over s change nothing."""
    names = (*found.names, objective.space.convention or "")
    scaling = {"m0": 1.0, "c0": 1.0, "Ka": -1.0, "Cl": -1.0}
    log = np.zeros((len(names), len(names)))
    log[:-1, :-1] = found.log
    direction = np.array([scaling.get(name, 0.0) for name in names])
    return Covariance(names, log + 1e8 * np.outer(direction, direction))


def _formula(exponents: Mapping[str, int], label: Mapping[str, tuple[str, str]]) -> str:
    """m0*Ka/A^2 and the like, numerator first."""
    top = [label[name][0] for name, power in exponents.items() if power > 0]
    bottom = [label[name][0] for name, power in exponents.items() if power < 0]
    return "*".join(top) + "".join(f"/({name})" if "/" in name else f"/{name}" for name in bottom)


def _unit(exponents: Mapping[str, int], label: Mapping[str, tuple[str, str]]) -> str:
    return "*".join(f"({label[name][1]})" + ("" if power == 1 else f"^{power}") for name, power in exponents.items())


def _reason(objective: Objective, name: str, found: Covariance) -> str:
    if name == objective.space.convention:
        return "no specimen of known mass, stiffness or damping gives forces a scale; held at 1 kg by convention"
    if objective.space.convention and name in ("c0", "Ka", "Cl"):
        return "known only as a ratio to the mass, which is a convention here"
    relative = found.relative({name: 1})
    size = "not seen by these runs" if relative > 10 else f"standard error {relative:.0%} of the value"
    return f"{size}; other parameters make up for it (see the determined combinations)"


def _renamed(
    correlation: Mapping[str, Mapping[str, float]], label: Mapping[str, tuple[str, str]]
) -> dict[str, dict[str, float]]:
    return {label[a][0]: {label[b][0]: value for b, value in row.items()} for a, row in correlation.items()}


def _notes(objective: Objective, floors: Mapping[str, float | None], here: Local) -> list[str]:
    notes = list(objective.matrix.notices)
    if objective.space.scale_free and objective.space.axes:
        notes.append(
            f"Bounds of the preset {objective.preset.name} were not used: they hold for another machine, or piston "
            "area, gain or specimen are not stated. The search was over scale-free ratios."
        )
    if objective.matrix.actuator.piston_area is None and objective.preset.without_area:
        notes.append("Piston area unknown: only ratios to it are determined, and parameters are given as such.")
    if floors["fit"] is None:
        notes.append("Noise floor unknown: the command has power up to nearly half the sample rate, "
                     "so no part of the spectrum shows the noise alone; repeat a run to measure it.")  # fmt: skip
    else:
        notes.append("Noise floor from the spectrum above the command's band, taken as white: a lower bound.")
    if objective.unstable:
        notes.append(f"{objective.unstable} of the tried parameter vectors made the loop unstable; they cost, no more.")
    if not np.isfinite(here.error):
        notes.append("The model is unstable at these values: its error is reported as 1000.")
    return notes


def _evolution(objective: Objective, state: Mapping[str, Any]) -> tuple[Generation, ...]:
    """The generations with their populations in SI, to five digits: enough to draw."""
    out = []
    for index, entry in enumerate(state["history"]):
        values = objective.space.values(np.array(entry["population"]))
        columns = [[float(f"{v:.5g}") for v in values[name]] for name in objective.space.names]
        errors = tuple(float(f"{e:.6g}") for e in entry["errors"])
        stable = [error for error in errors if error < UNSTABLE] or [UNSTABLE]
        mean = float(np.mean(stable))
        out.append(Generation(index + 1, min(errors), mean, tuple(zip(*columns, strict=True)), errors))
    return tuple(out)
