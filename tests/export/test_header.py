"""The C header of a machine, compiled and run, beside the kernel that simulates the machine here."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest

from ident.effects import EFFECTS
from ident.errors import Unusable
from ident.export import as_header, exported
from ident.run import Specimen
from tests.export.machines import RATE, command, compiled, compiler, fitted, largest_error, simulated, with_effects

SMOOTH = ("pressure_flow", "loop_delay", "quadratic_damping", "cubic_stiffness", "sensor_lag", "valve_second_order")
STICKING = ("coulomb_friction", "presliding_friction", "dead_zone", "specimen_hysteresis")


def compared(names, folder):
    """The largest error of any channel, in standard deviations."""
    machine, u = with_effects(*names), command()
    found = compiled(machine, u, folder)
    assert found.shape == (len(u), len(machine.outputs))
    return max(largest_error(found[:, i], simulated(machine, channel, u)) for i, channel in enumerate(machine.outputs))


@pytest.mark.parametrize(("names", "bound"), [((), 1e-9), (SMOOTH, 1e-6), (STICKING, 1e-3)])
def test_the_compiled_header_answers_as_the_kernel_does(names, bound, tmp_path):
    """Every channel, in standard deviations: without effects, with smooth ones, with those that stick."""
    assert compared(names, tmp_path) <= bound


def test_every_effect_of_the_catalogue_is_in_the_header_as_it_is_in_the_kernel(full, tmp_path):
    """In the short form every twelfth."""
    found = {effect.name: compared((effect.name,), tmp_path) for effect in EFFECTS[:: None if full else 12]}
    assert max(found.values()) <= 1e-6, found


def test_a_command_that_acts_late_stands_still_until_then(tmp_path):
    """With two samples and a half of delay nothing moves for two samples, and then as the kernel says."""
    machine = with_effects("command_delay")
    values = {**machine.values, "command_delay__delay": 2.5 / RATE}
    assert values.keys() == machine.values.keys()
    machine = type(machine)(machine.preset, values, RATE, 4)
    found = compiled(machine, np.full(200, 1e-3), tmp_path)[:, 0]
    assert np.all(found[:3] == 0)
    assert found[4] > 0
    assert (
        largest_error(compiled(machine, command(), tmp_path)[:, 0], simulated(machine, "displacement", command()))
        < 1e-9
    )


def test_the_header_is_that_of_the_fit_and_of_what_it_moves(tmp_path):
    """The dead zone of the fit is in it: a command inside the zone moves nothing, one beyond it does."""
    machine = exported(fitted(), Specimen(0.87, 36.3e3), 1.0)
    width = fitted().values["dead_zone.half_width"]
    assert np.all(compiled(machine, np.full(200, 0.9 * width), tmp_path) == 0)
    assert compiled(machine, np.full(200, 3 * width), tmp_path)[-1, 0] > 0
    assert " *   mL = 0.87\n" in as_header(machine)


def test_the_header_is_cpp_as_well(tmp_path):
    """As a rig's program in C++ would include it."""
    (tmp_path / "machine.h").write_text(as_header(with_effects("coulomb_friction")))
    (tmp_path / "main.cpp").write_text('#include "machine.h"\nint main() { return 0; }\n')
    strict = ("-x", "c++", "-fsyntax-only", "-Wall", "-Wextra", "-Werror")
    done = subprocess.run([compiler(), *strict, "main.cpp"], cwd=tmp_path, capture_output=True, text=True, check=False)
    if "cc1plus" in done.stderr:
        pytest.skip("no C++ compiler here")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("conditions", "what"),
    [
        ({"gain": 0.0}, "gain is 0"),
        ({"sample_rate": float("nan")}, "nan"),
        ({"specimen": Specimen(-1.0)}, "mass is -1"),
    ],
)
def test_conditions_that_cannot_be_are_refused(conditions, what):
    with pytest.raises(Unusable, match=what) as refused:
        exported(fitted(), **conditions)
    assert refused.value.code == "out-of-range"


MEASURED_LOAD = {
    "controller": "p",
    "of": "displacement",
    "valve": "first",
    "flow": "linear",
    "pressure": "compressible",
    "load": "measured_force",
    "sensor": "displacement",
}


@pytest.mark.parametrize(
    ("model", "settings", "what"),
    [
        ("measured load", {}, "a measured force drives this machine"),
        ("qian2014", {"load": "force"}, "state the specimen that it moves"),
        ("specimen", {}, "velocity is drawn through its samples"),
    ],
)
def test_a_machine_that_needs_a_record_beside_its_command_is_refused(model, settings, what):
    """With a specimen in the place of the measured force it is written."""
    from dataclasses import replace

    from ident.presets.description import described

    named = described(MEASURED_LOAD, "machine").name if model == "measured load" else model
    effects = fitted().effects if named == "qian2014" else ()
    fit = replace(fitted(), model=named, effects=effects, settings={**fitted().settings, "custom": (), **settings})
    with pytest.raises(Unusable, match=what) as refused:
        exported(fit)
    assert "\n" not in str(refused.value)
    if model == "qian2014":
        assert as_header(exported(fit, Specimen(0.87, 36.3e3)))
