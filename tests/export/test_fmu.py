"""The functional mock-up unit, simulated by FMPy, beside the kernel."""

from __future__ import annotations

import shutil
import zipfile

import numpy as np
import pytest

from ident.errors import Unusable
from ident.export import as_fmu
from tests.export.machines import RATE, command, compiler, largest_error, simulated, with_effects

fmpy = pytest.importorskip("fmpy")


@pytest.fixture(scope="module")
def machine():
    return with_effects("coulomb_friction", "dead_zone", "loop_delay")


@pytest.fixture(scope="module")
def unit(machine, tmp_path_factory):
    compiler()
    file = tmp_path_factory.mktemp("unit") / "machine.fmu"
    file.write_bytes(as_fmu(machine))
    return file


def test_another_program_validates_it(unit):
    """FMPy's validation of the description against the standard finds nothing."""
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(unit)) == []


def test_it_answers_as_the_kernel_does_under_a_held_command(unit, machine):
    """Every channel to 1e-6 of its standard deviation, dry friction, dead zone and delay included."""
    u = command(2000)
    times = np.arange(len(u)) / RATE
    given = np.array(list(zip(times, u, strict=True)), dtype=[("time", float), ("command", float)])
    step = {"step_size": 1 / RATE, "output_interval": 1 / RATE}
    found = fmpy.simulate_fmu(
        str(unit), start_time=0.0, stop_time=times[-1], input=given, output=list(machine.outputs), **step
    )
    np.testing.assert_allclose(found["time"], times, atol=1e-9)
    for channel in machine.outputs:
        assert largest_error(found[channel], simulated(machine, channel, u)) <= 1e-6


def test_a_step_that_is_no_whole_number_of_samples_is_refused(unit):
    """Two samples at once are fine; a kept state comes back."""
    from fmpy.fmi1 import FMICallException

    description = fmpy.read_model_description(str(unit))
    folder = fmpy.extract(str(unit))
    try:
        slave = fmpy.fmi2.FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            instanceName="one",
            modelIdentifier=description.coSimulation.modelIdentifier,
        )
        slave.instantiate()
        slave.setReal([0], [5e-3])
        slave.doStep(0.0, 2 / RATE)
        kept = slave.getFMUState()
        slave.doStep(2 / RATE, 200 / RATE)
        there = slave.getReal([1, 2, 3])
        slave.setFMUState(kept)
        slave.doStep(2 / RATE, 200 / RATE)
        assert slave.getReal([1, 2, 3]) == there
        with pytest.raises(FMICallException):
            slave.doStep(202 / RATE, 0.3 / RATE)
        slave.freeFMUState(kept)
        slave.freeInstance()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def test_it_holds_its_sources_and_no_python(unit):
    """Whoever has another system compiles what lies in it."""
    with zipfile.ZipFile(unit) as archive:
        names = archive.namelist()
    assert {"modelDescription.xml", "sources/machine.h", "sources/fmi.c"} < set(names)
    assert len([name for name in names if name.startswith("binaries/")]) == 1
    assert not [name for name in names if ".py" in name]


def test_without_a_compiler_it_is_refused_with_a_remedy(machine, monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(Unusable, match="install gcc, or export the C header") as refused:
        as_fmu(machine)
    assert refused.value.code == "no-compiler"
