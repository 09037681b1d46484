"""A temperature that answers a command, from equations of its own: a lag, its gain in kelvin by the command's unit."""

from __future__ import annotations

import numpy as np
import pytest
import yaml

from ident.checks.check import check
from ident.drafts.answers import Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_raw
from ident.presets.suitable_models import in_question
from ident.readers import read_matrix
from ident.readers.channel_description import channel_scale
from ident.workflows import identify

GAIN, TAU, ROOM, STEP, COUNT = 0.8, 60.0, 21.0, 2.0, 600
DESCRIBED = """
actuator: {{serial: OVEN}}
runs:
  - id: a
    file: run.csv
    time: {{column: time, unit: s}}
    hold: zoh
    channels:
      command: {{column: power, unit: "%"}}
      temperature: {{column: heat, unit: {unit}}}
"""


def oven(warm: float = ROOM) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, powers in %, and temperatures in °C of a body that cools towards the room."""
    rng = np.random.default_rng(4)
    power = np.repeat(rng.integers(0, 100, COUNT // 60), 60).astype(float)
    heat = np.empty(COUNT)
    keep = np.exp(-STEP / TAU)
    for at in range(COUNT):
        heat[at] = warm
        warm = keep * warm + (1.0 - keep) * (ROOM + GAIN * power[at])
    return STEP * np.arange(COUNT), power, heat + 0.05 * rng.standard_normal(COUNT)


def written(folder, unit: str = "C", warm: float = ROOM):
    time, power, heat = oven(warm)
    shown = {"C": heat, "degC": heat, "F": 1.8 * heat + 32.0, "K": heat + 273.15}[unit]
    table = np.column_stack([time, power, shown])
    np.savetxt(folder / "run.csv", table, "%.9g", ",", header="time,power,heat", comments="")
    (folder / "matrix.yaml").write_text(DESCRIBED.format(unit=unit))
    return read_matrix(folder)


@pytest.mark.parametrize("unit", ["C", "degC", "F", "K"])
def test_it_is_the_output_and_counts_from_0_degrees_celsius(tmp_path, unit):
    (run,) = written(tmp_path, unit).runs
    assert run.output == "temperature"
    assert run.units["temperature"] == "K"
    np.testing.assert_allclose(run.measured, oven()[2], atol=1e-5)


def test_a_lag_is_taken_for_it_with_its_gain_its_time_and_the_room(tmp_path):
    fit = identify(written(tmp_path, warm=50.0))
    assert fit.model == "first_order"
    assert fit.parameters["gain"].value == pytest.approx(100 * GAIN, rel=0.02)
    assert fit.parameters["tau"].value == pytest.approx(TAU, rel=0.02)
    assert fit.transducer_offset["temperature"].value == pytest.approx(ROOM, abs=0.5)


def test_nobody_asks_for_the_specimen_of_an_oven(tmp_path):
    codes = {finding.code for finding in check(written(tmp_path))}
    assert not codes & {"no-specimen", "one-condition", "no-piston-area", "no-gain"}


def test_a_column_of_that_name_is_taken_for_the_output():
    rows = "time [s];command [%];temperature [degC]\n" + "".join(f"{n};{n % 7};{20 + n % 5}\n" for n in range(30))
    draft = Draft([read_raw(rows.encode(), "run.csv")], Answers(serial="OVEN"))
    assert not draft.missing


def test_a_cooler_that_is_switched_on_is_found_though_its_record_is_little_else_than_a_decay(tmp_path):
    """A thermoelectric cooler, whose current heats it, too, and a body behind it: full current until it is nearly cold,
    then what its controller asks for.

    Decays of all kinds together explain such a record without a cooler. A search that lets each model have all of them
    ends at one that follows the current upwards at once.
    """
    runs = []
    for name, gain, warm in (("a", 0.3, 28.5), ("b", 0.6, 29.5)):
        rng, heat, behind, summed = np.random.default_rng(1), warm, warm, 0.0
        table = np.empty((500, 2))
        for at in range(len(table)):
            error = heat + 30.0
            summed += error if gain * error < 6.0 else 0.0
            current = min(6.0, gain * error + 0.001 * gain * summed)
            table[at] = current, np.round(heat + 0.05 * rng.standard_normal(), 1)
            for _ in range(10):
                flow = (16.5 - heat - 30.5 * current + 2.8 * current**2) / 128.0 + (behind - heat) / 1200.0
                behind += 0.1 * (heat - behind) / 192.0
                heat += 0.1 * flow
        np.savetxt(tmp_path / f"{name}.csv", table, "%.9g", ",", header="current,heat", comments="")
        channels = {"command": {"column": "current", "unit": "A"}, "temperature": {"column": "heat", "unit": "C"}}
        rest = {"id": name, "file": f"{name}.csv", "sample_rate": "1 Hz", "output": "temperature"}
        runs.append(rest | {"channels": channels})
    (tmp_path / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "COOLER"}, "runs": runs}))
    fit = identify(read_matrix(tmp_path))
    assert fit.error["fit"] < 0.06
    assert fit.parameters["gain"].value < -5.0


@pytest.mark.parametrize(("unit", "kelvin"), [("C", 323.15), ("F", 283.15), ("degC", 323.15)])
def test_a_command_may_be_a_temperature_in_degrees(unit, kelvin):
    """As of a wire of a shape memory alloy in water: coulomb and farad, which no command has, are not meant."""
    scale = channel_scale(unit, "command", "unit")
    assert scale.factor * 50.0 + scale.offset == pytest.approx(kelvin)


def test_a_wire_that_is_heated_has_no_oil_and_nobody_asks_for_its_specimen(tmp_path):
    time, _, heat = oven()
    np.savetxt(
        tmp_path / "run.csv", np.column_stack([time, heat, 0.1 * heat]), "%.9g", ",", header="t,h,x", comments=""
    )
    channels = {"command": {"column": "h", "unit": "C"}, "displacement": {"column": "x", "unit": "mm"}}
    run = {"id": "a", "file": "run.csv", "sample_rate": "0.5 Hz", "channels": channels}
    (tmp_path / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "WIRE"}, "runs": [run]}))
    matrix = read_matrix(tmp_path)
    assert not any(model.chain.has_oil for model in in_question(matrix.runs))
    assert not {finding.code for finding in check(matrix)} & {"no-specimen", "one-condition", "no-piston-area"}
