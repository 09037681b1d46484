"""One fit has one error: fit, compare, diagnose and figure say the same, to all digits that they show."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from ident.comparison.compare import compare
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets import PRESETS
from ident.run import Run, Specimen
from ident.words.percent import percent
from ident.workflows import diagnose, identify
from tests.conftest import of_few_effects, short_searches
from tests.fit import rig
from tests.fit.test_windows import cylinder
from tests.presets.test_composed import force_loop
from tests.presets.test_machines import motor, specimen
from tests.presets.test_moving_base import Storey
from tests.presets.test_position_servo import servo
from tests.presets.test_pressure_drive import CYLINDER
from tests.presets.test_speed_servo import speeds
from tests.presets.test_sprung_motor import machine as swinging
from tests.presets.test_two_tanks import tanks
from tests.short_form import short_form

RATE = 500.0
SMALL = {"population": 24.0, "generations": 4.0, "elite": 3.0}  # a search: wherever it ends, the error is one


def loop(output: str = "displacement", held: bool = False) -> Matrix:
    """A position loop of a lag, an integrator and a mass on its spring of oil, in Euler steps of a fiftieth sample."""
    runs = []
    for number, use in enumerate(("fit", "fit", "verify")):
        rng = np.random.default_rng([21, number])
        u = 0.01 * np.convolve(rng.standard_normal(2000), np.hanning(24), "same") / 3.0
        u[:20] = 0.0
        if held:
            u = np.repeat(u[::25], 25)
        w = p = v = x = 0.0
        out, dt = np.zeros(len(u)), 1.0 / RATE / 50
        for k in range(len(u)):
            out[k] = x
            for part in range(50):
                asked = u[k] if held else u[k] + part / 50 * (u[min(k + 1, len(u) - 1)] - u[k])
                w += dt * (2.0 * (asked - x) - w) / 0.004
                p += dt * 3e4 * (60.0 * w / 2.0 - v - 1e-3 * p)
                v += dt * (p - 80.0 * v)
                x += dt * v
        out += 0.01 * out.std() * rng.standard_normal(len(out))
        channels = {"command": u, "displacement": out}
        runs.append(
            Run(
                f"{use}-{number}",
                "",
                RATE,
                channels,
                {"command": "m", "displacement": "m"},
                gain=2.0,
                hold="zoh" if held else "linear",
                specimen=Specimen(),
                output=output,
                use=use,
            )
        )
    return Matrix(Actuator("LOOP"), tuple(runs))


def driven() -> Matrix:
    """A mass on spring and damper that a measured force drives, by the trapezoidal rule in fifty steps a sample."""
    runs = []
    for number, use in enumerate(("fit", "verify")):
        rng = np.random.default_rng([22, number])
        force = 50.0 * np.convolve(rng.standard_normal(2000), np.hanning(30), "same")
        force[:20] = 0.0
        v = x = 0.0
        out, dt = np.zeros(len(force)), 1.0 / RATE / 50
        for k in range(len(force)):
            out[k] = x
            for part in range(50):
                now = force[k] + part / 50 * (force[min(k + 1, len(force) - 1)] - force[k])
                v += dt * (now - 400.0 * v - 3e4 * x) / 20.0
                x += dt * v
        out += 0.01 * out.std() * rng.standard_normal(len(out))
        channels = {"drive_force": force, "displacement": out}
        units = {"drive_force": "N", "displacement": "m"}
        runs.append(Run(use, "", RATE, channels, units, use=use))
    return Matrix(Actuator("DRIVEN"), tuple(runs))


def rigs() -> Matrix:
    """Two records of the hybrid-simulation rig: with position and spool to fit, with the position alone to verify."""
    fit = rig.matrix(rig.machine(0), 0, ("displacement", "spool"), seconds=1.0)
    (verify,) = rig.matrix(rig.machine(0), 1, ("displacement",), seconds=1.0).runs
    return replace(fit, runs=(*fit.runs, replace(verify, id="verify", use="verify")))


def levels() -> Matrix:
    """The first ten minutes of two records of tanks."""
    return Matrix(Actuator("TANKS"), tuple(tanks(i, use).part(0, 150) for i, use in enumerate(("fit", "verify"))))


MACHINES: dict[str, tuple[str, Callable[[], Matrix], tuple[str, ...]]] = {
    "a loop": ("qian2014", loop, ()),
    "a loop, held": ("qian2014", lambda: loop(held=True), ()),
    "a loop with an effect": ("qian2014", loop, ("dead_zone",)),
    "a loop as a lag": ("first_order", loop, ()),
    "two tanks": ("two_tanks", levels, ()),
    "a driven mass": ("drive", driven, ()),
    "a driven mass with an effect": ("drive", driven, ("coulomb_friction",)),
    "a motor": ("motor", lambda: motor(5), ()),
    "a motor with an effect": ("motor", lambda: motor(5, 1.0), ("dead_zone",)),
    "a mass that a pressure drives": ("pressure_drive", lambda: CYLINDER.recorded(1), ()),
    "a motor against a spring": ("sprung_motor", lambda: swinging(1), ()),
    "a storey": ("moving_base", lambda: Storey().measured("acceleration", 8.0), ()),
    "a servo": ("position_servo", lambda: servo(1), ()),
    "a speed loop": ("speed_servo", speeds, ()),
    "a motor as a cylinder": ("open_valve", lambda: motor(5), ()),
    "a specimen": ("specimen", lambda: specimen(4), ()),
    "a specimen with an effect": ("specimen", lambda: specimen(4, friction=50.0), ("presliding_friction",)),
    "a press": ("force_loop", lambda: force_loop(6, seconds=4.0), ()),
    "a cylinder": ("open_valve", lambda: cylinder(4, wander=0.0), ()),
    "a rig": ("strano", rigs, ()),
    "a disturbed cylinder": ("motor", lambda: cylinder(4, wander=1e-3), ()),
}


def test_every_chain_is_among_them():
    """A bench's records have no error of eq. (17); its one figure is tested where the bench is."""
    assert {model for model, _, _ in MACHINES.values()} == {n for n, p in PRESETS.items() if p.kind == "chain"}


@cache
def fitted(machine: str) -> tuple[Matrix, FitResult]:
    model, record, effects = MACHINES[machine]
    matrix = record()
    return matrix, identify(matrix, Settings(model=model, effects=effects, seed=3, options=SMALL))


FEW_MACHINES = ("a loop with an effect", "a motor with an effect", "a disturbed cylinder")
"""Of the short form: one under its loop, one in open loop, and one that is judged by windows."""


@pytest.mark.parametrize("machine", short_form(MACHINES, *FEW_MACHINES))
def test_one_fit_has_one_error(machine, full):
    with short_searches(full):
        matrix, fit = fitted(machine)
    said = {use: percent(error) for use, error in fit.error.items() if use != "held_out"}
    compared = compare(matrix, fit)
    assert {use: percent(error) for use, error in compared.error.items() if use in said} == said
    of_runs = {run.id: percent(run.error) for run in fit.runs}
    assert {entry.run.id: percent(entry.error) for entry in compared.runs} == of_runs
    with of_few_effects(full, *MACHINES[machine][2]):
        rung = diagnose(matrix, fit, most=0, propose=False).ladder[0].error
    over = fit.error if fit.window is None else fit.window.error
    assert {use: percent(rung[use]) for use in said} == {use: percent(over[use]) for use in said}
