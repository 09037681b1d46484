"""How late a machine answers to a slow command: the sum of its lags and delays."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

from ident.fit.identification import Identification
from ident.fit.low_frequency_delay import NAME, lags
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify
from tests.short_form import short_form

RATE = 50.0


def axis(seed: int) -> Matrix:
    """Two lags of 60 and 45 ms and a delay of 40 ms into a cylinder that integrates: steps of 0.4 ms, 2 % noise."""
    runs = []
    for number, use in enumerate(("fit", "verify")):
        rng = np.random.default_rng([seed, number])
        u = np.repeat(rng.uniform(-1, 1, 60), 20)
        fine = np.repeat(u, 50)
        fine = np.concatenate([np.zeros(100), fine])[: len(fine)]
        first = second = x = 0.0
        out = []
        for k, now in enumerate(fine):
            if k % 50 == 0:
                out.append(x)
            x += 0.3 * second * 4e-4
            second += (first - second) * -np.expm1(-4e-4 / 0.045)
            first += (now - first) * -np.expm1(-4e-4 / 0.06)
        y = np.array(out)
        y += 0.002 * y.std() * rng.standard_normal(len(y))
        channels, units = {"command": u, "displacement": y}, {"command": "V", "displacement": "m"}
        runs.append(Run(use, "", RATE, channels, units, hold="zoh", use=use))
    return Matrix(Actuator("LATE"), tuple(runs))


@pytest.mark.parametrize("seed", short_form([4, 5], 5))
def test_which_stage_is_late_is_not_known_but_how_late_all_are(seed):
    fit = identify(axis(seed), Settings(model="open_valve"))
    assert fit.undetermined
    (late,) = [entry for entry in fit.determined if entry.expression == NAME]
    assert late.unit == "s"
    assert late.value == pytest.approx(0.145, rel=0.06)
    assert abs(late.value - 0.145) < 5 * late.std_error + 0.003  # of a matrix whose model has no delay


@pytest.mark.parametrize("output", ["velocity", "displacement"])
def test_lags_and_delays_of_stages_and_effects_add_up(output):
    rng = np.random.default_rng(1)
    u, y = rng.standard_normal((2, 800))
    channels, units = {"command": u, output: y}, {"command": "V", output: "rad/s" if output == "velocity" else "rad"}
    matrix = Matrix(Actuator("ANY"), (Run("one", "", 100.0, channels, units, output=output),))
    settings = Settings(model="motor", effects=("command_delay", "sensor_lag"))
    objective = Identification(matrix, settings).objective
    point = rng.uniform(0.3, 0.7, (4, len(objective.space.axes)))
    values = objective.space.values(point)
    summed = values["m0"] / values["c0"] + values["command_delay__delay"]
    summed += values["sensor_lag__time_constant"] if output == "displacement" else 0.0  # the speed is not read late
    assert lags(objective, matrix.runs[0], point) == pytest.approx(summed, rel=1e-4)


def test_a_step_that_is_late_is_found_where_another_run_has_no_steps():
    """A lag of 0.2 s behind a delay of 1 s, in closed form: a sine, which moves with each sample, and held levels."""
    rate, late, pole = 20.0, 20, np.exp(-1.0 / 20.0 / 0.2)
    rng, runs = np.random.default_rng(12), []
    for name, u in (("sine", np.sin(np.arange(1200) / rate)), ("steps", np.repeat(rng.choice([0.0, 1.0], 20), 60))):
        command = np.concatenate([np.zeros(late), u])[: len(u)]
        x = scipy.signal.lfilter([0.0, 1.0 - pole], [1.0, -pole], command) + 0.01 * rng.standard_normal(len(u))
        units = {"command": "V", "displacement": "m"}
        runs.append(Run(name, "", rate, {"command": u, "displacement": x}, units, hold="zoh"))
    fit = identify(Matrix(Actuator("LATE"), tuple(runs)), Settings(model="first_order", effects=("command_delay",)))
    assert fit.parameters["command_delay.delay"].value == pytest.approx(late / rate, rel=0.02)
    assert fit.values["tau"] == pytest.approx(0.2, rel=0.05)
    assert not any("a bound that no user set" in note for note in fit.notes)  # from there not every search leads on


@pytest.mark.parametrize("until", [100.0, 9.0])
def test_one_step_or_pulse_that_is_late_is_found(until):
    """A lag of 0.5 s behind a delay of 1.2 s, in closed form: what is held after a change says how late it may be."""
    rate, late, pole, rng = 100.0, 120, np.exp(-1.0 / 100.0 / 0.5), np.random.default_rng(5)
    t = np.arange(1500) / rate
    u = np.where((t >= 3.0) & (t < until), 5.0, 0.0)
    command = np.concatenate([np.zeros(late), u])[: len(u)]
    x = scipy.signal.lfilter([0.0, 1.0 - pole], [1.0, -pole], command) + 0.02 * rng.standard_normal(len(u))
    units = {"command": "V", "displacement": "m"}
    run = Run("one", "", rate, {"command": u, "displacement": x}, units, hold="zoh")
    fit = identify(Matrix(Actuator("LATE"), (run,)), Settings(model="first_order", effects=("command_delay",)))
    assert fit.parameters["command_delay.delay"].value == pytest.approx(late / rate, rel=0.02)
    assert not any("a bound that no user set" in note for note in fit.notes)
