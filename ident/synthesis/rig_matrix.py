"""A simulated test of a machine that no paper has a matrix for: noise at two gains and two amplitudes, and between.

The values of the parameters are those of the preset, which is a paper's, or are all stated: a machine that is put
together from stages has none of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from ident.comparison.compare import modelled
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.presets import Preset
from ident.presets.rig_test import RigTest
from ident.progress import Progress, Report, silent
from ident.run import Run
from ident.words.number import trimmed
from ident.words.run_name import run_name

Array = NDArray[np.float64]
_BEGUN = 0.1  # s


def write_rig_matrix(
    out: Path,
    model: Preset,
    values: Mapping[str, float],
    test: RigTest,
    seconds: float = 30.0,
    seed: int = 0,
    noise: float = 0.005,
    serial: str = "SIM-0001",
    machine: Mapping[str, Any] | None = None,
    report: Report = silent,
) -> None:
    """Write the matrix of a machine to the folder `out`: `values` by name, SI, `machine` the stages it is made of.

    `noise` is white, its standard deviation relative to each output. Raises Unusable where a value is missing, or the
    folder is in use.
    """
    known = _values(model, values, machine is not None)
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise Unusable("folder-in-use", "the folder is not empty", str(out), "name a new one")
    if not (1 / 16 <= seconds <= 600 and 0 <= noise < 1):
        raise Unusable(
            "bad-value",
            f"{seconds:g} s with noise {noise:g}",
            "simulate",
            "give 0.0625 to 600 seconds and noise from 0 to below 1",
        )
    (out / "runs").mkdir(parents=True, exist_ok=True)
    entries, todo = [], list(_plans(test))
    for index, (name, amplitude, gain, use) in enumerate(todo):
        report(Progress("simulate", index, len(todo)))
        rng = np.random.default_rng([seed, index])
        still = _still(name, test, _noise(round(seconds * test.sample_rate), amplitude, test, rng), gain, model)
        shown = modelled(model, known, Matrix(test.actuator, still.of_outputs(test.outputs)))
        found = dict(zip(test.outputs, shown.values(), strict=True))
        if not all(np.isfinite(one).all() for one in found.values()):
            raise Unusable(
                "unstable-model", f"{run_name(name)} is unstable", "simulate", "take a smaller gain, or other values"
            )
        columns = {key: y + noise * np.std(y) * rng.standard_normal(len(y)) for key, y in found.items()}
        np.savez(out / "runs" / f"{name}.npz", command=still.command, **columns)  # type: ignore[arg-type]
        entries.append(_entry(still, test, use))
    report(Progress("simulate", len(todo), len(todo)))
    stated: dict[str, Any] = {"serial": serial, "name": "simulated"}
    if test.actuator.piston_area is not None:
        stated["piston_area"] = f"{test.actuator.piston_area!r} m^2"
    if test.actuator.supply_pressure is not None:
        stated["supply_pressure"] = f"{test.actuator.supply_pressure!r} Pa"
    told = ", ".join(f"{name} = {value:g}" for name, value in values.items())
    stated["notes"] = f"simulated with the model {model.name}, seed {seed}, noise {noise:g}; {told}; not measured"
    whole = {"actuator": stated, **({"machine": dict(machine)} if machine else {}), "runs": entries}
    (out / "matrix.yaml").write_text(yaml.safe_dump(whole, sort_keys=False), encoding="utf-8")


def _values(model: Preset, given: Mapping[str, float], composed: bool) -> dict[str, float]:
    """Every parameter by the equations' names. Raises Unusable for one without a value."""
    missing = [p.name for p in model.parameters if composed and p.name not in given]
    if missing:
        raise Unusable(
            "not-stated", f"no value of {', '.join(missing)}", "simulate", "state each with --set NAME=VALUE"
        )
    found = {p.in_equations: p.value for p in model.parameters} | dict(model.data.gains)
    return found | {model.parameter(name).in_equations: value for name, value in given.items()}


def _plans(test: RigTest) -> Iterator[tuple[str, float, float | None, str]]:
    """Name, amplitude, gain and use of each run."""
    gains: tuple[float | None, ...] = test.gains or (None,)
    runs = [(amplitude, gain, "fit") for gain in gains for amplitude in test.amplitudes]
    middle = float(np.exp(np.mean(np.log(test.gains)))) if test.gains else None
    runs.append((float(np.exp(np.mean(np.log(test.amplitudes)))), middle, "verify"))
    for number, (amplitude, gain, use) in enumerate(runs, 1):
        yield f"run-{number}", amplitude, gain, use


def _noise(length: int, rms: float, test: RigTest, rng: np.random.Generator) -> Array:
    """Noise from 0 to the edge of the band of exactly the RMS value asked for, begun from rest within 0.1 s."""
    frequency = np.fft.rfftfreq(length, 1 / test.sample_rate)
    used = (frequency > 0) & (frequency <= test.band)
    lines = np.where(used, rng.standard_normal(len(frequency)) + 1j * rng.standard_normal(len(frequency)), 0.0)
    found = np.fft.irfft(lines, length) * np.clip(np.arange(length) / (_BEGUN * test.sample_rate), 0.0, 1.0)
    return np.asarray(found * (rms / np.sqrt(np.mean(found**2))))


def _still(name: str, test: RigTest, command: Array, gain: float | None, model: Preset) -> Run:
    """A run of which nothing but the command is known."""
    channels = {"command": command, **{one: np.zeros_like(command) for one in test.outputs}}
    units = {"command": test.unit, **{one: model.chain.units[model.chain.signal(one)] for one in test.outputs}}
    return Run(
        name, "", test.sample_rate, channels, units, gain=gain, amplitude=float(np.std(command)), output=test.outputs[0]
    )


def _entry(run: Run, test: RigTest, use: str) -> dict[str, Any]:
    found: dict[str, Any] = {
        "id": run.id,
        "file": f"runs/{run.id}.npz",
        "sample_rate": f"{test.sample_rate:g} Hz",
        "use": use,
        "output": list(test.outputs) if len(test.outputs) > 1 else test.outputs[0],
        "channels": {name: {"column": name, "unit": unit} for name, unit in run.units.items()},
    }
    return found if run.gain is None else found | {"gain": float(trimmed(run.gain))}


def with_stated(test: RigTest, **stated: Any) -> RigTest:
    """The test with what is stated of it instead; None leaves it as it is."""
    return replace(test, **{name: value for name, value in stated.items() if value})
