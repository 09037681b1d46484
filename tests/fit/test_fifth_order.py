"""The fifth-order actuator is found from position, load pressure and spool, and what fewer of them leave is said.

Machines are drawn with numpy's generator at [19, number], the noise of each record at its number; one in the short
form, twenty in the long one.
"""

from __future__ import annotations

import numpy as np
import pytest

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.readers import read_matrix
from ident.run import Run
from ident.workflows import compare, identify
from tests.fit import rig
from tests.reference import strano_reference as reference

COMBINED = {
    "kep*kqp": lambda of: of["kep"] * of["kqp"],
    "ken*kqn": lambda of: of["ken"] * of["kqn"],
    "(vep - ve0) / kep": lambda of: (of["vep"] - of["ve0"]) / of["kep"],
    "(ve0 - ven) / ken": lambda of: (of["ve0"] - of["ven"]) / of["ken"],
}
OPEN = {"ve0", "kep", "ken", "ven", "vep", "kqn", "kqp"}
SHORT, LONG = 1, 20
FEW = 1  # of the machines are fitted from fewer outputs in the short form


def machines(full: bool, short: int) -> range:
    return range(LONG if full else short)


def found(number: int, outputs: tuple[str, ...]) -> FitResult:
    return identify(rig.matrix(rig.machine(number), number, outputs), Settings(model="strano", seed=1))


def errors(fit: FitResult) -> dict[str, float]:
    """Standard errors by parameter; of the dry friction that of the whole of it."""
    told = {one.expression: one.std_error for one in fit.determined}
    known = {name: one.std_error for name, one in fit.parameters.items() if one.std_error}
    return {**known, **({"Fc": told["Fc + mu*Nv"]} if "Fc + mu*Nv" in told else {})}


def test_every_parameter_is_found_with_the_spool(full):
    """Within 5 %; the standard errors are those of the scatter within a factor 1.5, over twenty machines."""
    off = []
    for number in machines(full, SHORT):
        fit, true = found(number, rig.ALL), rig.truth(rig.machine(number))
        stated = errors(fit)
        for name, estimate in fit.parameters.items():
            if name != "mu":
                assert estimate.value == pytest.approx(true[name], rel=0.05), (number, name)
        assert {one.name for one in fit.undetermined} == {"Fc", "mu"}
        off.append([(fit.parameters[name].value - true[name]) / stated[name] for name in true if name != "mu"])
    scatter = np.sqrt(np.mean(np.square(off), axis=0))
    # Of one machine the scatter of one parameter is not known: that of all of them together is.
    assert 1 / 1.5 < np.sqrt(np.mean(scatter**2)) < 1.5
    if full:
        assert np.all(scatter < 1.5), scatter
        assert np.all(scatter > 1 / 1.5), scatter


@pytest.mark.full
def test_without_the_spool_two_directions_are_open_and_what_stays_is_named(full):
    """A common scale, and a common shift: each of the four combinations is within 2 %."""
    for number in machines(full, FEW):
        fit, true = found(number, ("displacement", "load_pressure")), rig.truth(rig.machine(number))
        undetermined = {one.name: one.reason for one in fit.undetermined}
        assert undetermined.keys() >= OPEN
        assert "common scale" in undetermined["kep"]
        assert "common shift" in undetermined["ve0"]
        told = {one.expression: one.value for one in fit.determined}
        for name, of in COMBINED.items():
            assert told[name] == pytest.approx(of(true), rel=0.02), (number, name)
        for name in ("wn", "xi", "C", "m", "sigma", "Fc"):
            assert fit.parameters[name].value == pytest.approx(true[name], rel=0.05), (number, name)


def test_with_the_displacement_alone_nothing_of_the_load_is_called_sure(full):
    """Mass, friction and compressibility are within three of their standard errors, which are not small."""
    if not full:
        pytest.skip("twenty seconds a machine: run with --full")
    for number in machines(full, FEW):
        fit, true = found(number, ("displacement",)), rig.truth(rig.machine(number))
        stated = errors(fit)
        for name in ("m", "sigma", "C", "Fc"):
            error = stated.get(name)
            assert error is None or error > 0.02 * true[name], (number, name)
            assert error is None or abs(fit.parameters[name].value - true[name]) < 3 * error, (number, name)
        told = {one.expression: one.value for one in fit.determined}
        for name, of in COMBINED.items():
            assert told[name] == pytest.approx(of(true), rel=0.02), (number, name)


def test_a_record_with_many_outputs_and_measured_inputs_is_read_from_a_folder(tmp_path):
    """The list of outputs, the difference of two pressures, the supply and the vertical load, all from matrix.yaml."""
    matrix = read_matrix(rig.written(tmp_path, rig.machine(0), 0, gain="6e-2 V/mm"))
    assert [run.id for run in matrix.runs] == ["rig.displacement", "rig.load_pressure", "rig.spool"]
    assert [run.begins for run in matrix.runs] == ["at rest"] * 3
    assert matrix.runs[0].gain == pytest.approx(rig.GAIN)
    fixed = rig.machine(0)._asdict()
    fit = identify(matrix, Settings(model="strano", fixed=fixed))
    assert compare(matrix, fit).error["fit"] == pytest.approx(fit.error["fit"], rel=1e-9)
    assert fit.error["fit"] == pytest.approx(0.069, abs=0.003), "the noise over the deviations, over three outputs"


def test_a_vertical_load_that_varies_tells_the_two_frictions_apart():
    """Where it jumps between 100 kN and 500 kN, both are within 10 % and three standard errors."""
    truth = reference.Machine()
    n = round(4.0 * reference.RATE)
    load = np.where(np.sin(np.arange(n) / reference.RATE * 4.0) > 0, 5e5, 1e5)
    matrix = rig.matrix(truth, 3, ("displacement", "load_pressure"), seconds=4.0, vertical=load)
    known = {name: value for name, value in truth._asdict().items() if name not in ("Fc", "mu", "sigma")}
    few = {"population": 16.0, "generations": 3.0, "elite": 3.0}
    fit = identify(matrix, Settings(model="strano", fixed=known, seed=1, options=few))
    for name in ("Fc", "mu"):
        estimate = fit.parameters[name]
        assert abs(estimate.value - truth._asdict()[name]) < 3 * estimate.std_error, name
        assert estimate.value == pytest.approx(truth._asdict()[name], rel=0.1), name


def test_a_supply_pressure_is_seen_sample_by_sample():
    """The supply falls to half and comes back: the model follows it, and one with its mean alone does not."""
    truth, r = reference.Machine(), reference.motion(4.0, seed=2)
    drooping = reference.SUPPLY * (1.0 - 0.5 * np.clip(np.sin(np.arange(len(r)) / reference.RATE * 3.0), 0.0, 1.0))
    shown = reference.respond(truth, r, gain=rig.GAIN, supply=drooping)
    both = []
    for supply in (drooping, np.full(len(r), drooping.mean())):
        channels = {"command": r, "displacement": shown.displacement, "supply_pressure": supply}
        run = Run("rig", "", reference.RATE, channels, rig.UNITS, gain=rig.GAIN)
        matrix = Matrix(Actuator("RIG", piston_area=reference.AREA), (run,))
        fit = identify(matrix, Settings(model="strano", fixed={**truth._asdict(), "mu": 0.006}))
        both.append(fit.error["fit"])
    assert both[0] < 1e-4
    assert both[1] > 30 * both[0]


def test_a_command_in_volts_opens_the_valve():
    """The same machine in open loop: the model's displacement is the reference's."""
    truth = reference.Machine()
    t = np.arange(3000) / reference.RATE
    volts = np.where(t > 0.05, 2.0 * np.sin(2 * np.pi * 1.3 * (t - 0.05)), 0.0)
    shown = reference.respond(truth, volts)
    channels = {"command": volts, "displacement": shown.displacement}
    run = Run("open", "", reference.RATE, channels, {"command": "V", "displacement": "m"})
    matrix = Matrix(Actuator("RIG", piston_area=reference.AREA, supply_pressure=reference.SUPPLY), (run,))
    fit = identify(matrix, Settings(model="strano", fixed=truth._asdict()))
    assert fit.error["fit"] < 1e-3


@pytest.mark.parametrize(
    ("actuator", "code"),
    [(Actuator("RIG", supply_pressure=2e7), "missing-area"), (Actuator("RIG", piston_area=1e-2), "missing-supply")],
)
def test_what_must_be_known_is_asked_for(actuator, code):
    channels = {"command": reference.motion(1.0), "displacement": reference.motion(1.0)}
    run = Run("rig", "", reference.RATE, channels, rig.UNITS, gain=rig.GAIN)
    with pytest.raises(Unusable) as refused:
        identify(Matrix(actuator, (run,)), Settings(model="strano"))
    assert refused.value.code == code


def test_runs_in_metres_and_in_volts_are_not_one_matrix():
    channels = {"command": reference.motion(1.0), "displacement": reference.motion(1.0)}
    runs = [Run(unit, "", reference.RATE, channels, {"command": unit, "displacement": "m"}) for unit in ("m", "V")]
    with pytest.raises(Unusable, match="a command in m and others in V"):
        identify(Matrix(Actuator("RIG", piston_area=1e-2, supply_pressure=2e7), tuple(runs)), Settings(model="strano"))
