"""What a hybrid simulation, a controller, and a changed machine ask of the rig, against its limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.hybrid.case import case_of
from ident.hybrid.changed_machine import Change
from ident.hybrid.controller_design import design_controller, on_case
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.what_if import what_if
from ident.matrix import Actuator
from ident.rig.limits import RigLimits
from tests.hybrid.cases import fitted, of_qian
from tests.planning.rigs import peaks
from tests.reference.qian_reference import Cell, Plant, band_limited_noise

FIT = fitted()


def test_a_simulation_says_first_what_leaves_the_rig():
    """The stroke holds for the command too; what is kept is not said."""
    of = simulate_hybrid(FIT, of_qian(1.0))
    way = float(max(np.abs(of.measured).max(), np.abs(of.command).max()))
    left = simulate_hybrid(FIT, of_qian(1.0, rig=RigLimits(stroke=1.9 * way, force=1e6)))
    assert len(left.beyond) == 1
    assert next(iter(left.listings())) == left.beyond[0] == left.to_json()["notes"][0]
    assert "displacement" in left.beyond[0]
    assert not simulate_hybrid(FIT, of_qian(1.0, rig=RigLimits(stroke=2.1 * way))).beyond


def test_a_case_states_the_rig_and_counts_before_the_fit():
    data = {
        "structure": {"mass": "87.5 kg", "stiffness": "87.5 kN/m", "damping": "3.5 kN*s/m"},
        "physical": {"mass": "8.75 kg", "stiffness": "17.5 kN/m"},
        "rig": {"speed": "0.5 m/s"},
    }
    assert case_of(data).rig == RigLimits(speed=0.5)


def test_a_controller_runs_its_case_within_the_limits():
    case = of_qian(1.0, rig=RigLimits(speed=1e-4))
    made = design_controller(
        FIT, case.physical, sample_rate=case.sample_rate, gain=case.gain, piston_area=case.piston_area, draws=2
    )
    held = on_case(made, FIT, case)
    assert "speed" in held.beyond[0]
    assert held.to_json()["design"]["notes"][0] == held.beyond[0]
    assert not on_case(made, FIT, of_qian(1.0)).beyond
    assert held.stability.stable
    assert held.to_json()["design"]["state"] == "stable"


def test_a_changed_machine_says_which_noise_reaches_the_limit():
    """The RMS is that of the reference: its speed at 1 mm RMS, the limit over it."""
    fit = replace(FIT, actuator=Actuator("A", piston_area=4.97e-4))
    note = what_if(fit, Change(), (5.0, 5.0), rig=RigLimits(speed=0.3)).notes[0]
    command = band_limited_noise(8192, 1e-3, np.random.default_rng(2))
    asked = peaks(Plant(), Cell(0.0, 0.0, 0.0, 5.0), command)["speed"]
    said = float(note.split(" mm RMS")[0].rpartition(" ")[2])
    assert note.startswith("The speed of the rig is reached at Kp = 5 by noise of 0 to 80 Hz")
    assert said == pytest.approx(0.3 / asked, rel=0.25)
