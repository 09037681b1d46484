"""A plan on disk: command files, plan.json, and the matrix.yaml that the measured answers drop into.

commands/ID.csv         time in s and the command, with a line of names that hold the units; or .mat, .tdms
plan.json               every run: amplitude, share of the tightest limit, laws of a control unit
matrix.yaml             names runs/ID.csv of every run, with its columns and units
runs/                   empty: what is measured goes here
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.matrix import Actuator
from ident.planning.law import TEXTS
from ident.planning.planned_run import PlannedRun
from ident.progress import Progress, Report, silent
from ident.rig.limits import UNITS, RigLimits
from ident.synthesis.bench_matrix import RATE
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
Columns = Mapping[str, Array]
_MILLI = {"m": (1e3, "mm")}
_OF_LAW = {"time": (1.0, "s"), "set_position": (1e3, "mm"), "way": (1e3, "mm"), "current": (1e2, "percent")}
_RECORDED = {"current": "%", "displacement": "mm", "pressure_a": "MPa", "pressure_b": "MPa"}


def write_folder(
    out: Path,
    runs: Sequence[PlannedRun],
    plan: Mapping[str, Any],
    measured: str,
    formats: tuple[str, ...],
    report: Report = silent,
) -> None:
    """Write planned runs to the folder `out`, which must not exist or be empty. Raises Unusable.

    `plan` is the JSON data of the plan, `measured` the text of matrix.yaml.
    """
    if strange := [name for name in formats if name not in WRITERS]:
        raise Unusable(
            "unknown-format", f"no command files as {strange[0]!r}", "format", did_you_mean(strange[0], WRITERS)
        )
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise Unusable("folder-in-use", "the folder is not empty", str(out), "name a new one")
    for folder in ("commands", "runs"):
        (out / folder).mkdir(parents=True)
    for number, run in enumerate(runs):
        report(Progress("write", number, len(runs)))
        columns, rate = columns_of(run)
        for name in formats:
            WRITERS[name](out / "commands" / f"{run.id}.{name}", columns, rate)
    report(Progress("write", len(runs), len(runs)))
    (out / "plan.json").write_text(
        json.dumps(explained(plan, runs), indent=2, allow_nan=False) + "\n", encoding="utf-8"
    )
    (out / "matrix.yaml").write_text(measured, encoding="utf-8")


def columns_of(run: PlannedRun) -> tuple[dict[str, Array], float]:
    """The columns of a command file, named with their units, and its sample rate (Hz)."""
    if run.law is not None:
        scaled = {name: (_OF_LAW[name], values) for name, values in run.law.columns().items()}
        return {f"{name}_{unit}": scale * values for name, ((scale, unit), values) in scaled.items()}, RATE
    assert run.signal is not None
    scale, unit = _MILLI.get(run.signal.unit, (1.0, run.signal.unit))
    command = scale * run.signal.command()
    rate = run.signal.sample_rate
    return {"time_s": np.arange(len(command)) / rate, f"command_{unit}": command}, rate


def explained(plan: Mapping[str, Any], runs: Sequence[PlannedRun]) -> dict[str, Any]:
    """The JSON data of a plan, with what the control unit does for each law, and the units."""
    entries = [dict(data) for data in plan["runs"]]
    for data, run in zip(entries, runs, strict=True):
        if run.law is not None:
            data["law"] = {**data["law"], "named": run.law.named, "text": TEXTS[run.law.number]}
    return {
        **plan,
        "runs": entries,
        "units": {"peaks": dict(UNITS), "currents": "rated currents", "lengths": "m", "times": "s"},
    }


def description(own: Actuator, limits: RigLimits, runs: Sequence[PlannedRun]) -> str:
    """The matrix.yaml of what will be measured on an actuator, within the limits of its rig."""
    sizes = {"piston_area": "m^2", "stroke": "m", "supply_pressure": "Pa", "volume": "m^3"}
    actuator = {"serial": own.serial, "name": own.name, "batch": own.batch, "servo_valve": own.servo_valve}
    actuator = {name: text for name, text in actuator.items() if text}
    actuator |= {
        name: f"{value:.12g} {unit}" for name, unit in sizes.items() if (value := getattr(own, name)) is not None
    }
    whole: dict[str, Any] = {"actuator": actuator}
    if limits:
        whole["rig"] = {name: f"{value:.12g} {UNITS[name]}" for name, value in limits.stated.items()}
    whole["runs"] = [entry(run) for run in runs]
    head = "# Put what is measured at runs/, under these names and columns; then: servoident check, fit.\n"
    return head + yaml.safe_dump(whole, sort_keys=False, allow_unicode=True)


def entry(run: PlannedRun) -> dict[str, Any]:
    """A run as matrix.yaml wants it."""
    found: dict[str, Any] = {"id": run.id, "file": f"runs/{run.id}.csv"}
    if run.law is not None:
        found |= {"sample_rate": f"{RATE:g} Hz", "kind": run.kind, "rated_current": "100 %"}
        if run.law.position_range:
            found["position_range"] = [f"{1e3 * end:g} mm" for end in run.law.position_range]
        if run.kind == "frequency":
            named = run.law.named
            found |= {"frequency": f"{named['frequency']:g} Hz", "amplitude": f"{100 * named['amplitude']:.6g} %"}
        return {**found, "channels": {name: {"column": name, "unit": unit} for name, unit in _RECORDED.items()}}
    assert run.signal is not None
    scale, unit = _MILLI.get(run.signal.unit, (1.0, run.signal.unit))
    found |= {"sample_rate": f"{run.signal.sample_rate:g} Hz"}
    if run.specimen is not None:
        s = run.specimen
        found["specimen"] = {
            "mass": f"{s.mass:g} kg",
            "stiffness": f"{s.stiffness / 1e3:g} kN/m",
            "damping": f"{s.damping:g} N*s/m",
        }
    if run.gain is not None:
        found["gain"] = run.gain
    found |= {"amplitude": f"{scale * run.signal.amplitude:.9g} {unit}", "kind": run.kind, "use": run.use}
    return {
        **found,
        "channels": {
            "command": {"column": f"command_{unit}", "unit": unit},
            "displacement": {"column": "displacement_mm", "unit": "mm"},
        },
    }


def _csv(path: Path, columns: Columns, _: float) -> None:
    """A line of names, then a row a sample."""
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, "%.9g", ",", header=",".join(columns), comments="")


def _mat(path: Path, columns: Columns, rate: float) -> None:
    """A column a variable, and `sample_rate` in Hz."""
    from scipy.io import savemat  # noqa: PLC0415

    savemat(path, {**columns, "sample_rate": rate}, oned_as="column", do_compression=True)


def _tdms(path: Path, columns: Columns, rate: float) -> None:
    """A channel a column in the group `command`: a waveform whose increment is the sample time has no column of it."""
    from nptdms import ChannelObject, TdmsWriter  # noqa: PLC0415

    timed = {"wf_increment": 1.0 / rate, "wf_start_offset": 0.0, "wf_samples": 1} if "time_s" in columns else {}
    channels = [
        ChannelObject("command", name, values, {**timed, "unit_string": name.rpartition("_")[2]})
        for name, values in columns.items()
        if name != "time_s"
    ]
    with TdmsWriter(path) as writer:
        writer.write_segment(channels)


WRITERS: Mapping[str, Callable[[Path, Columns, float], None]] = {"csv": _csv, "mat": _mat, "tdms": _tdms}
"""The formats of command files, by the ending of their names."""
