"""A mass that a known pressure drives, as SciPy integrates it: a cylinder on a spring, an arm on a muscle."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
import scipy

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.structure_selection import choose_structure
from ident.effects import CATALOGUE
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.presets.suitable_models import in_question
from ident.run import Run, Specimen
from ident.workflows import diagnose, identify
from tests.conftest import of_few_effects

RATE, COUNT = 200.0, 1200
SMOOTH = 1e-3
"""Of the usual speed: what slides more slowly is held by less than the whole dry friction."""


@dataclass(frozen=True)
class Pressed:
    """m x″ + c x′ + k x + dry sgn x′ + weight sin x = area p; SI, or of an angle its torques."""

    mass: float
    damping: float
    stiffness: float
    area: float
    dry: float = 0.0
    weight: float = 0.0

    def moved(self, p: np.ndarray, load: float = 0.0) -> np.ndarray:
        """Its position under held pressures (Pa), from rest, with a load of known mass (kg) on it."""
        mass = self.mass + load
        usual = SMOOTH * self.area * p.std() / np.sqrt(self.stiffness * mass)

        def rates(now: float, at: np.ndarray) -> list[float]:
            x, v = at
            held = self.damping * v + self.stiffness * x + self.dry * np.tanh(v / usual) + self.weight * np.sin(x)
            return [v, (self.area * p[min(int(now * RATE + 1e-9), len(p) - 1)] - held) / mass]

        t = np.arange(len(p)) / RATE
        found = scipy.integrate.odeint(
            rates, [0.0, 0.0], t, tfirst=True, hmax=1 / RATE, rtol=1e-8, atol=1e-11, tcrit=t[1:-1], mxstep=5000
        )
        return np.asarray(found[:, 0])

    def recorded(self, seed: int, unit: str = "m", loads: tuple[float, ...] = (0.0, 0.0, 0.0)) -> Matrix:
        """Two runs to fit and one to validate, with noise of 0.5 %."""
        runs = []
        for number, load in enumerate(loads):
            rng = np.random.default_rng([91, seed, number])
            p = np.repeat(rng.uniform(-2e5, 2e5, COUNT // 20), 20) * (0.5, 1.0, 0.8)[number]
            x = self.moved(p, load)
            x = x + 0.005 * x.std() * rng.standard_normal(COUNT)
            runs.append(Run(f"r{number}", "", RATE, {"command": p, "displacement": x}, hold="zoh",
                            units={"command": "Pa", "displacement": unit}, use=("fit", "fit", "verify")[number],
                            specimen=Specimen(mass=load) if load else None))  # fmt: skip
        return Matrix(Actuator("PRESSED"), tuple(runs))


CYLINDER = Pressed(mass=3.0, damping=60.0, stiffness=4e3, area=5e-4)
ARM = Pressed(mass=0.05, damping=0.2, stiffness=3.0, area=1.5e-5)


def test_a_known_pressure_may_drive_a_mass_and_other_commands_may_not():
    pressed = CYLINDER.recorded(1)
    assert {"pressure_drive", "open_valve", "motor"} <= {known.name for known in in_question(pressed.runs)}
    volts = [replace(run, units={"command": "V", "displacement": "m"}) for run in pressed.runs]
    assert "pressure_drive" not in {known.name for known in in_question(volts)}


def test_without_an_area_masses_and_forces_are_pressures():
    """The pressure that accelerates, damps and holds: of a motion along a way, and of an angle."""
    for machine, unit in ((CYLINDER, "m"), (ARM, "rad")):
        found = identify(machine.recorded(1, unit), Settings(model="pressure_drive")).parameters
        for name, wanted, shown in (
            ("m0/Ap", machine.mass, f"Pa*s^2/{unit}"),
            ("c0/Ap", machine.damping, f"Pa*s/{unit}"),
            ("k0/Ap", machine.stiffness, f"Pa/{unit}"),
        ):
            assert found[name].value == pytest.approx(wanted / machine.area, rel=0.01)
            assert (found[name].unit, found[name].std_error is not None) == (shown, True)
    friction = CandidateModels.of(ARM.recorded(1, "rad"), Settings(model="pressure_drive")).effects
    with_it = preset("pressure_drive", ("coulomb_friction",)).for_matrix(ARM.recorded(1, "rad"))[0]
    assert with_it.unit(with_it.parameter("coulomb_friction.force")) == "Pa"
    assert "coulomb_friction" in friction


def test_a_stated_area_gives_mass_and_stiffness_in_their_own_units():
    matrix = replace(CYLINDER.recorded(1), actuator=Actuator("PRESSED", piston_area=CYLINDER.area))
    found = identify(matrix, Settings(model="pressure_drive")).parameters
    assert (found["m0"].unit, found["k0"].unit, found["Ap"].fixed) == ("kg", "N/m", True)
    assert found["m0"].value == pytest.approx(CYLINDER.mass, rel=0.01)
    assert found["k0"].value == pytest.approx(CYLINDER.stiffness, rel=0.01)


def test_two_loads_of_known_mass_tell_the_area():
    found = identify(CYLINDER.recorded(1, loads=(1.0, 4.0, 2.0)), Settings(model="pressure_drive")).parameters
    assert (found["Ap"].unit, found["m0"].unit) == ("N/Pa", "kg")
    assert found["Ap"].value == pytest.approx(CYLINDER.area, rel=0.02)
    assert found["m0"].value == pytest.approx(CYLINDER.mass, rel=0.03)


def test_the_area_of_a_piston_is_not_that_of_an_arm():
    """Of what turns it is the torque for each unit of pressure, which no area states."""
    matrix = replace(ARM.recorded(1, "rad"), actuator=Actuator("ARM", piston_area=1e-3))
    assert preset("pressure_drive").for_matrix(matrix)[0].data.gains["Ap"] == 1.0


def test_what_a_pressure_drives_may_have_a_valve_s_effects_but_none_of_a_flow():
    """Its regulator may be slow, late or limited; oil that is compressed or leaks would change the pressure itself."""
    found = set(CandidateModels.of(CYLINDER.recorded(1), Settings(model="pressure_drive")).effects)
    flowing = {known.name for known in CATALOGUE if {"Q", "L", "Ke"} & {one.target for one in known.equations}}
    assert {"command_delay", "dead_zone", "valve_second_order", "coulomb_friction", "specimen_hysteresis"} <= found
    assert flowing
    assert not found & flowing


@pytest.mark.full
def test_the_machine_is_told_from_a_valve_by_its_spring():
    """A pressure that pilots a valve moves a cylinder on and on; one that drives a mass on a spring does not."""
    assert choose_structure(CYLINDER.recorded(2)).structures[0].machine == "pressure_drive"


@pytest.mark.full
def test_hidden_friction_and_weight_are_named(full):
    """Dry friction of a cylinder, as a pressure, and the weight of an arm that hangs, without a model named."""
    pushed = replace(CYLINDER, dry=8.0).recorded(3)
    with of_few_effects(full, "coulomb_friction", "dead_zone", "cubic_stiffness"):
        found = diagnose(pushed, settings=Settings(model=""), most=1, propose=False)
    assert found.verdict.effects == ("coulomb_friction",)
    force = found.ladder[-1].parameters["coulomb_friction.force"]
    assert force.unit == "Pa"
    assert force.value == pytest.approx(8.0 / CYLINDER.area, rel=0.1)
    with of_few_effects(full, "arm_gravity", "coulomb_friction", "cubic_stiffness"):
        hanging = replace(ARM, stiffness=1.0, weight=2.0, area=2.5e-5).recorded(3, "rad")
        found = diagnose(hanging, settings=Settings(model=""), most=1, propose=False)
    assert found.verdict.effects == ("arm_gravity",)
    torque = found.ladder[-1].parameters["arm_gravity.torque"]
    assert (torque.unit, torque.value) == ("Pa", pytest.approx(2.0 / 2.5e-5, rel=0.05))
