"""A machine of each kind of unit is fitted: terminal, JSON, page and figures give a number its channel's unit."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from scipy.signal import lfilter

import ident
from app.fits.rows import error_rows, parameter_rows
from app.matrices.service import _run
from app.pages.run_view import conditions
from ident.design.experiment import Experiment
from ident.figures import figure
from ident.fit.result import FitResult
from ident.matrix import Actuator, Matrix
from ident.preprocessing import prepare
from ident.presets import preset
from ident.presets.record_units import RecordUnits, written
from ident.readers import from_arrays
from ident.run import Run
from ident.units.grammar import powers_of
from ident.words import conditions as lab
from ident.workflows import study
from schemas.matrix import RunView


@dataclass(frozen=True)
class Kind:
    """What is recorded, in which units; and in which each number then stands.

    `si` is the output's unit in JSON, `printed` on paper and `gain` the unit of the static gain; `amplitude` is that of
    the command in words, `clock` of the time constant.
    """

    output: str
    unit: str
    command: str
    rate: str
    si: str
    printed: tuple[str, ...]
    gain: str
    amplitude: str
    clock: str = "s"


KINDS = {
    "length": Kind("displacement", "mm", "mm", "1 kHz", "m", ("mm", "µm"), "1", "2 mm"),
    "angle": Kind("displacement", "deg", "deg", "1 kHz", "rad", ("rad", "mrad"), "1", "0.03491 rad"),
    "velocity": Kind("velocity", "mm/s", "mm/s", "1 kHz", "m/s", ("m/s", "mm/s"), "1", "2 mm/s"),
    "unknown unit": Kind("displacement", "1", "1", "1 kHz", "1", ("",), "1", "2"),
    "unknown period": Kind("displacement", "mm", "mm", "1 1/sample", "m", ("mm", "µm"), "1", "2 mm", "sample"),
    "counts": Kind("displacement", "1", "V", "1 kHz", "1", ("",), "1/V", "2 V"),
    "force": Kind("force", "kN", "V", "1 kHz", "N", ("N", "kN"), "N/V", "2 V"),
    "pressure": Kind("load_pressure", "MPa", "V", "1 kHz", "Pa", ("kPa", "MPa"), "Pa/V", "2 V"),
}
"""One of each kind of unit that a record may have."""
EVERY = pytest.mark.parametrize("name", KINDS)


@cache
def recorded(name: str) -> Matrix:
    """A lag of twenty samples behind a random command of two units RMS, with a noise of 1 %; seeded."""
    kind, random = KINDS[name], np.random.default_rng(len(name))
    command = lfilter([0.1], [1, -0.9], random.standard_normal(1200))
    command *= 2.0 / np.std(command)
    output = lfilter([1 / 20], [1, -19 / 20], command)
    output += 0.01 * np.std(output) * random.standard_normal(len(output))
    return from_arrays(
        {"command": command, kind.output: output},
        units={"command": kind.command, kind.output: kind.unit},
        sample_rate=kind.rate,
        output=kind.output,
        amplitude=f"2 {kind.command}",
        kind="blwn",
    )


@cache
def fitted(name: str) -> FitResult:
    options = {"population": 16, "generations": 5}
    return ident.identify(recorded(name), model="first_order", seed=1, options=options)


@EVERY
def test_in_json_and_on_the_terminal_each_parameter_and_the_residual_have_their_unit(name):
    kind, fit = KINDS[name], fitted(name)
    assert fit.error["fit"] < 0.1
    data = json.loads(json.dumps(fit.to_json()))
    assert data["parameters"]["gain"]["unit"] == kind.gain
    assert data["parameters"]["tau"]["unit"] == kind.clock
    assert (data["rmse_unit"], data["runs"][0]["unit"]) == (kind.si, kind.si)
    tau, gain = (next(line for line in str(fit).splitlines() if line.startswith(p)) for p in ("tau", "gain"))
    assert tau.split()[3] == {"s": "ms", "sample": "sample"}[kind.clock]
    assert {"1": "–"}.get(kind.gain, kind.gain) in gain.split()[3:5]  # behind a power of ten, where it has one
    rmse = ident.compare(recorded(name), fit).runs[0].row[2]
    assert rmse.partition(" ")[2] in kind.printed
    assert fit.parameters["tau"].value == pytest.approx(19.5 if kind.clock == "sample" else 0.0195, rel=0.1)


@EVERY
def test_on_the_page_each_number_has_the_same(name):
    kind, fit = KINDS[name], fitted(name)
    rows = {row.name: row for row in parameter_rows(fit)}
    assert rows["tau"].unit == {"s": "ms", "sample": "sample"}[kind.clock]
    assert rows["gain"].unit.rpartition(" ")[2] == {"1": "–"}.get(kind.gain, kind.gain)
    assert error_rows(fit)[0].size.partition(" ")[2] in kind.printed
    shown = conditions(RunView(**_run(recorded(name).runs[0])))
    assert shown.amplitude == kind.amplitude
    timed = ("1.200 s", "1000 Hz") if kind.clock == "s" else ("1200 samples", "unknown")
    assert (shown.length, shown.rate) == timed


@EVERY
def test_in_figures_axes_and_captions_have_the_same(name):
    kind = KINDS[name]
    text = json.dumps(figure("time", study(recorded(name), fitted(name))).to_dict(), ensure_ascii=False)
    assert f"{kind.amplitude} RMS" in text
    assert "Time (s)" in text if kind.clock == "s" else "Time (samples)" in text
    title = kind.output.replace("_", " ").capitalize()
    assert any(f"{title} ({unit or '–'})" in text for unit in kind.printed), title
    for other in ({"(mm)", "(m)", "(µm)"} if kind.si != "m" else set()) | (
        {"Time (s)"} if kind.clock != "s" else set()
    ):
        assert other not in text


@EVERY
def test_the_next_run_is_asked_for_in_the_unit_of_the_command(name):
    run = recorded(name).runs[0]
    asked = Experiment(
        specimen=None,
        gain=None,
        amplitude=run.amplitude,
        signal="blwn",
        frequency=0.1,
        seconds=100.0,
        sample_rate=1.0,
        unit=run.units["command"],
        time_unit=run.time_unit,
    )
    size = lab.amplitude(float(f"{run.amplitude:.3g}"), run.units["command"])
    assert f"of {size} RMS" in asked.conditions
    assert ("Hz" in asked.conditions) is (run.time_unit == "s")


def units(name: str, model: str) -> dict[str, str]:
    """The units of a machine's parameters as they are shown of records of a kind, its motion as well."""
    matrix = recorded(name)
    if KINDS[name].output in ("force", "load_pressure"):
        matrix = replace(matrix, runs=tuple(replace(run, output="force") for run in matrix.runs))
    known = preset(model)
    model_ = replace(known, display=replace(known.display, recorded=RecordUnits.of(matrix.runs)))
    return {parameter.name: model_.unit(parameter) for parameter in model_.parameters}


@pytest.mark.parametrize(
    ("name", "mass", "damping", "stiffness"),
    [
        ("length", "kg", "N*s/m", "N/m"),
        ("angle", "kg*m^2", "N*m*s/rad", "N*m/rad"),
        ("velocity", "kg", "N*s/m", "N/m"),
        ("unknown unit", "N*s^2", "N*s", "N"),  # a unit of the motion is a 1
        ("counts", "N*s^2", "N*s", "N"),
        ("unknown period", "kg", "N*sample/m", "N/m"),
    ],
)
def test_the_parameters_of_a_load_have_the_units_of_what_was_recorded(name, mass, damping, stiffness):
    found = units(name, "drive")
    assert (found["m0"], found["c0"], found["k0"]) == (mass, damping, stiffness)
    assert all(powers_of(unit) is not None for unit in found.values())


def test_a_speed_in_counts_leaves_a_damping_its_force_and_a_mass_its_force_and_a_second():
    shown = RecordUnits(unknown={"m": {"s": 1.0}}).shown
    assert [shown(unit) for unit in ("N*s/m", "kg", "N/m", "s", "m/s")] == ["N", "N*s", "N/s", "s", "1"]


@pytest.mark.parametrize("unit", ["1", "N*s/m", "1/s", "m^3/(Pa*s)", "kg*m^2", "1/(m*s)"])
def test_a_unit_that_is_taken_apart_is_written_as_it_was(unit):
    assert written(powers_of(unit) or {}) == unit


@pytest.mark.parametrize(
    ("output", "unit", "shown", "gain"),
    [
        ("temperature", "K", "1/K", "K/V"),
        ("force", "N", "1/N", "N/V"),
        ("velocity", "m/s", "s/m", "m/(V*s)"),
        ("velocity", "1", "1", "1/V"),
    ],
)
def test_a_lag_of_a_temperature_or_a_force_has_its_unit_in_the_place_of_a_metre(output, unit, shown, gain):
    """The curvature of a thermometer was in 1/m."""
    t = np.arange(200.0)
    run = Run("r", "", 1.0, {"command": t, output: t}, {"command": "V", output: unit}, output=output)
    known, _ = prepare(preset("first_order", ("sensor_curve",)), Matrix(Actuator("A"), (run,)), "none")
    assert known.unit(known.parameter("sensor_curve.curvature")) == shown
    assert known.unit(known.parameter("gain")) == gain
