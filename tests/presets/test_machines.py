"""Machines of a lab beside the servo loop: a moved specimen and a motor, simulated here by recursions of their own.

And which model is taken where none is named.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal
from scipy.signal import cont2discrete, dlsim

from ident.checks.check import check
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.structure_selection import choose_structure
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.presets.suitable_models import in_question, suitable_models
from ident.readers import read_matrix
from ident.run import Run
from ident.workflows import compare, diagnose, identify
from tests.conftest import of_few_effects
from tests.short_form import short_form

RATE = 200.0
TIME = np.arange(3000) / RATE


def speed(seed: int) -> np.ndarray:
    """A band-limited speed in m/s, and its integral."""
    rng = np.random.default_rng(seed)
    lines = [(rng.uniform(0.5, 6.0), rng.uniform(0, 2 * np.pi)) for _ in range(12)]
    return 0.02 * sum(np.sin(2 * np.pi * f * TIME + phase) for f, phase in lines)


def dahl(v: np.ndarray, force: float, way: float) -> np.ndarray:
    """Dahl's friction by its own differential equation, z' = (v − |v| z)/x_s, in a hundred Euler steps a sample."""
    z, out = 0.0, np.zeros(len(v))
    for k in range(1, len(v) if force else 0):
        for part in range(100):
            now = v[k - 1] + (part + 0.5) / 100 * (v[k] - v[k - 1])
            z += (now - abs(now) * z) / way / RATE / 100
        out[k] = force * z
    return out


def specimen(seed: int, turned: float = 1.0, friction: float = 0.0) -> Matrix:
    """Two runs of a spring of 3 kN/m with 400 N·s/m, Dahl's friction beside it, and noise of 1 %."""
    runs = []
    for number, use in enumerate(("fit", "verify")):
        v = speed(10 * seed + number)
        x = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]))]) / RATE
        force = 3e3 * x + 400.0 * v + dahl(v, friction, 1e-3)
        force = force + 0.01 * force.std() * np.random.default_rng([seed, number]).standard_normal(len(v))
        channels = {"velocity": v, "force": turned * force}
        runs.append(Run(use, "", RATE, channels, {"velocity": "m/s", "force": "N"}, output="force", use=use))
    return Matrix(Actuator("DAMPER"), tuple(runs))


def commanded(matrix: Matrix, unit: str) -> Matrix:
    """The same with the motion called command, a position where the unit is that of one."""
    runs = []
    for run in matrix.runs:
        v = run.channels["velocity"]
        motion = v if unit == "m/s" else np.cumsum(v) / RATE
        channels = {"command": motion, "force": run.channels["force"]}
        runs.append(replace(run, channels=channels, units={"command": unit, "force": "N"}))
    return replace(matrix, runs=tuple(runs))


@pytest.mark.parametrize(("unit", "motion"), [("m/s", "velocity"), ("m", "displacement")])
def test_what_is_moved_is_a_specimen_though_its_motion_is_called_command(unit, motion):
    matrix = commanded(specimen(3), unit)
    assert [model.name for model in in_question(matrix.runs)] == ["specimen"]
    named = replace(
        matrix, runs=tuple(replace(run, channels={motion: run.command, "force": run.measured}) for run in matrix.runs)
    )
    as_commanded, as_named = (preset("specimen").for_matrix(one)[1].runs[0] for one in (matrix, named))
    assert np.array_equal(as_commanded.command, as_named.command)
    assert as_commanded.motion == as_named.motion
    assert "--model" in choose_structure(matrix).matrix.notices[0]


def test_in_units_of_1_a_specimen_is_in_question_beside_what_follows_a_command():
    runs = commanded(specimen(3), "1").runs
    assert {"specimen", "open_valve"} <= {model.name for model in in_question(runs)}


@pytest.mark.full
def test_in_units_of_1_a_mass_on_a_spring_is_found():
    """It answers a command that is held with a swing, solved exactly from sample to sample; noise of 0.5 %, seed 66."""
    runs = []
    for number, use in enumerate(("fit", "fit", "verify")):
        rng = np.random.default_rng([66, number])
        u = np.repeat(rng.uniform(-1, 1, 40), 30)
        mass = np.array([[0.0, 1.0], [-400.0, -6.0]]), np.array([[0.0], [1.0]]), np.eye(2)[:1], np.zeros((1, 1))
        _, x, _ = dlsim(cont2discrete(mass, 1 / RATE), u)
        x = x[:, 0] + 0.005 * x.std() * rng.standard_normal(len(u))
        runs.append(
            Run(
                f"r{number}",
                "",
                RATE,
                {"command": u, "displacement": x},
                hold="zoh",
                use=use,
                units={"command": "1", "displacement": "1"},
            )
        )
    matrix = Matrix(Actuator("MASS"), tuple(runs))
    assert {"sprung_motor", "first_order", "motor"} <= {model.name for model in in_question(matrix.runs)}
    assert choose_structure(matrix).structures[0].machine == "sprung_motor"


def test_the_command_of_a_loop_is_no_motion_of_a_specimen():
    loop = tuple(replace(run, gain=5.0) for run in commanded(specimen(3), "m").runs)
    assert "specimen" not in [model.name for model in in_question(loop)]


def motor(seed: int, half_width: float = 0.0) -> Matrix:
    """Held voltages into τ ω' + ω = K u, solved exactly from sample to sample: K = 3.5 rad/(s·V), τ = 0.3 s."""
    runs = []
    for number, use in enumerate(("fit", "verify")):
        rng = np.random.default_rng([seed, number])
        u = np.repeat(rng.uniform(-9, 9, 15), 200)
        driven = np.sign(u) * np.maximum(np.abs(u) - half_width, 0.0)
        held = np.exp(-1 / (RATE * 0.3))
        w = np.zeros(len(u))
        for k in range(1, len(u)):
            w[k] = held * w[k - 1] + (1 - held) * 3.5 * driven[k - 1]
        w += 0.01 * w.std() * rng.standard_normal(len(w))
        units = {"command": "V", "velocity": "rad/s"}
        channels = {"command": u, "velocity": w}
        runs.append(Run(use, "", RATE, channels, units, output="velocity", hold="zoh", use=use))
    return Matrix(Actuator("MOTOR"), tuple(runs))


@pytest.mark.parametrize("of_current", short_form([True, False], True))
def test_friction_that_a_current_commands_is_named_where_it_follows_the_current(full, of_current):
    """Of 20 N while the current is on, 20 ms behind it; or of 10 N whatever the current is."""
    runs = []
    for number, run in enumerate(specimen(5).runs):
        current = np.repeat(np.random.default_rng([7, number]).integers(0, 2, len(run.measured) // 40 + 1), 40) * 2.0
        current, held = current[: len(run.measured)], np.exp(-1 / (RATE * 0.02))
        field = scipy.signal.lfilter([1 - held], [1, -held], current)
        largest = 10.0 * field if of_current else 10.0
        force = run.measured + largest * np.tanh(run.channels["velocity"] / 1e-3)
        runs.append(replace(run, channels={**run.channels, "current": current, "force": force}))
    with of_few_effects(full, "current_friction", "coulomb_friction"):
        found = diagnose(
            replace(specimen(5), runs=tuple(runs)), settings=Settings(model="specimen"), most=1, propose=False
        )
    assert ("current_friction" in found.verdict.effects) is of_current


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_moved_specimen_is_found(seed):
    """Stiffness and damping within 1 % and four standard errors; the error is the noise."""
    matrix = specimen(seed)
    assert suitable_models(matrix.runs)[0].name == "specimen"
    fit = identify(matrix, Settings(model="specimen"))
    for name, true in (("kS", 3e3), ("cS", 400.0)):
        found = fit.parameters[name]
        assert found.value == pytest.approx(true, rel=0.01)
        assert abs(found.value - true) < 4 * found.std_error
    assert max(fit.error["fit"], fit.error["verify"]) < 0.0115


def test_a_turned_sign_is_said_and_turned_back():
    """By the check, and first of all by the fit, whose values are those of the right sign; the comparison agrees."""
    right, wrong = specimen(4), specimen(4, turned=-1.0)
    assert not [finding for finding in check(right) if finding.code == "turned-sign"]
    assert [finding.run for finding in check(wrong) if finding.code == "turned-sign"] == ["fit", "verify"]
    fits = [identify(matrix, Settings(model="specimen")) for matrix in (right, wrong)]
    assert fits[1].values == pytest.approx(fits[0].values, rel=1e-9)
    assert "other sign" in fits[1].notes[0]
    again = compare(wrong, fits[1]).error
    assert {use: fits[1].error[use] for use in again} == pytest.approx(again, rel=1e-4)


@pytest.mark.full
def test_hidden_friction_of_a_specimen_is_named_and_the_error_falls_to_the_noise(full):
    """Dahl's, with a way of its own, within twice the default: a fifth of the motion's deviation."""
    matrix = specimen(5, friction=20.0)
    with of_few_effects(full, "presliding_friction"):
        found = diagnose(matrix, settings=Settings(model="specimen"), most=1)
    named = {found.verdict.effects[0], *next((c.group for c in found.candidates if c.group), ())}
    assert "presliding_friction" in named
    freed = {"presliding_friction.displacement": (1e-5, 1e-1)}
    fit = identify(matrix, Settings(model="specimen", effects=("presliding_friction",), bounds=freed))
    assert fit.parameters["presliding_friction.force"].value == pytest.approx(20.0, rel=0.03)
    assert fit.parameters["presliding_friction.displacement"].value == pytest.approx(1e-3, rel=0.1)
    assert max(fit.error["fit"], fit.error["verify"]) < 0.0115


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_motor_is_found(seed):
    """Speed gain and time constant: the mass is one by convention. Units are those of the command."""
    matrix = motor(seed)
    assert suitable_models(matrix.runs)[0].name == "motor"
    fit = identify(matrix, Settings(model="motor"))
    assert fit.values["Kt"] / fit.values["c0"] == pytest.approx(3.5, rel=0.005)
    assert fit.values["m0"] / fit.values["c0"] == pytest.approx(0.3, rel=0.01)
    assert fit.parameters["Kt"].unit == "N*m/V"
    assert max(fit.error["fit"], fit.error["verify"]) < 0.0115


@pytest.mark.usefixtures("few_effects")
def test_a_hidden_dead_zone_of_a_motor_is_named_in_volts():
    found = diagnose(motor(6, half_width=1.5), settings=Settings(model="motor"), most=1)
    assert found.verdict.effects == ("dead_zone",)
    width = found.ladder[-1].parameters["dead_zone.half_width"]
    assert (width.value, width.unit) == (pytest.approx(1.5, rel=0.03), "V")
    assert not [c for c in found.candidates if c.effect.startswith("specimen_")]  # none is there
    assert found.ladder[-1].error["fit"] < 0.0115


def test_a_fit_that_explains_hardly_anything_says_so_first():
    """The command of another run: the error stays near 100 %, and the first note says what to look for."""
    matrix = motor(7)
    first, second = matrix.runs
    wrong = replace(first, channels={**first.channels, "command": second.command})
    fit = identify(replace(matrix, runs=(wrong,)), Settings(model="motor"))
    assert fit.error["fit"] > 0.8
    assert fit.notes[0].startswith("The model explains almost nothing")
    assert "wrong sign" in fit.notes[0]


def test_a_loop_that_nobody_stated_and_that_explains_hardly_anything_is_doubted():
    """Angles that have nothing to do with each other, taken for command and output of a position loop."""
    command, angle = (np.cumsum(np.random.default_rng([62, n]).choice([-0.01, 0.01], 1500)) for n in range(2))
    run = Run("one", "", 100.0, {"command": command, "displacement": angle}, {"command": "rad", "displacement": "rad"})
    fit = identify(Matrix(Actuator("J-1"), (run,)), Settings(model="position_servo"))
    assert fit.error["fit"] > 0.9
    assert "no loop compares displacement with the command" in fit.notes[0]
    assert "--model first_order" in fit.notes[0]


def test_where_no_model_is_driven_by_what_was_recorded_the_channels_are_named():
    run = Run("r", "", RATE, {"force": TIME, "displacement": TIME})
    with pytest.raises(Unusable, match="displacement, force"):
        suitable_models([run])
    with pytest.raises(Unusable, match="use the model specimen"):
        identify(specimen(1), Settings())


def test_what_is_in_units_of_1_is_no_force_where_a_motion_is_recorded():
    """A motor has the same equations, and its drive may have a dead zone or be late; a force has neither."""
    for channel in ("velocity", "displacement"):
        run = Run("r", "", RATE, {"command": TIME, channel: TIME}, units={"command": "1", channel: "rad"})
        assert "drive" not in {model.name for model in in_question([replace(run, output=channel)])}


@pytest.mark.parametrize(
    ("unit", "models"),
    [("N*m", ["drive"]), ("N", ["drive"]), ("V", ["motor", "first_order"])],
)
def test_a_torque_or_a_force_drives_a_mass_and_nothing_else_is_in_question(unit, models):
    """It needs no constant from the command to the force, whether position or speed is recorded."""
    for channel, of in (("velocity", "rad/s"), ("displacement", "rad")):
        run = Run("r", "", RATE, {"command": TIME, channel: TIME}, units={"command": unit, channel: of})
        found = [model.name for model in in_question([run])]
        assert found[0] == models[0]
        assert (found == ["drive"]) == (models == ["drive"])


@pytest.mark.parametrize(
    ("name", "model"),
    [
        ("mr_damper", "specimen"),
        ("dc_motor", "motor"),
        ("crane_actuator", "open_valve"),
        ("emps", "drive"),
        ("mts_actuator", "qian2014"),
    ],
)
def test_the_model_that_is_taken_for_measured_machines(measured_data, name, model):
    assert suitable_models(read_matrix(measured_data / name).runs)[0].name == model


def test_a_measured_damper_lacks_friction_that_yields_first(measured_data):
    """At most 17.5 and 19.5 % with the default shape: what a fit by hand reaches; the turned sign is said first."""
    matrix = read_matrix(measured_data / "mr_damper")
    fit = identify(matrix, Settings(model="specimen", effects=("presliding_friction",)))
    assert "other sign" in fit.notes[0]
    assert fit.error["fit"] < 0.175
    assert fit.error["verify"] < 0.195


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_a_measured_motor_has_a_dead_zone(measured_data):
    """1.9 V ± 0.15 V; in its group there may be dry friction, which stops the run-down, too. No doubt is raised."""
    matrix = read_matrix(measured_data / "dc_motor")
    assert not [finding for finding in check(matrix) if finding.severity != "note"]
    found = diagnose(matrix, settings=Settings(model="motor"), most=1)
    first = found.candidates[0]
    assert first.effect == "dead_zone"
    assert {*first.group} <= {"dead_zone", "coulomb_friction", "stribeck_friction"}
    assert first.parameters["dead_zone.half_width"].value == pytest.approx(1.9, abs=0.15)
    assert first.error["verify"] < 0.133
    values = {name: found.ladder[-1].parameters[name].value for name in ("Kt", "c0", "m0")}
    assert 33 < values["Kt"] / values["c0"] * 60 / (2 * np.pi) < 35  # rpm/V
    assert 0.29 < values["m0"] / values["c0"] < 0.33


def test_a_specimen_that_is_moved_in_position_is_one_that_is_moved_in_speed():
    """Its speed is the rate of the position that was recorded."""
    by_speed = specimen(3)

    def moved(run: Run) -> Run:
        v = run.channels["velocity"]
        x = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]))]) / RATE
        return replace(
            run,
            channels={"displacement": x, "force": run.channels["force"]},
            units={"displacement": "m", "force": "N"},
        )

    by_position = replace(by_speed, runs=tuple(map(moved, by_speed.runs)))
    assert suitable_models(by_position.runs)[0].name == "specimen"
    fits = [identify(matrix, Settings(model="")) for matrix in (by_speed, by_position)]
    assert fits[1].model == "specimen"
    for name in ("cS", "kS"):
        assert fits[1].values[name] == pytest.approx(fits[0].values[name], rel=0.01)


def test_the_spring_that_a_force_deflects_may_yield():
    """A mass on a hysteretic spring: nobody states a specimen there."""
    force = np.sin(2 * np.pi * 3.0 * TIME)
    run = Run("a", "", RATE, {"command": force, "displacement": 1e-3 * force}, {"command": "N", "displacement": "m"})
    matrix = Matrix(Actuator("OSCILLATOR"), (run,))
    assert "specimen_hysteresis" in CandidateModels.of(matrix, Settings(model="drive")).effects
    assert "specimen_hysteresis" not in CandidateModels.of(matrix, Settings(model="motor")).effects


@pytest.mark.full
def test_a_force_that_was_recorded_as_the_command_drives_a_mass_on_a_spring(full):
    """m x″ + c x′ + k x + k₃ x³ = F, by a recursion of its own: in question with what a command drives, and chosen."""
    rng, dt = np.random.default_rng(6), 1.0 / 2000.0
    m, c, k, hard = 0.5, 8.0, 4e3, 4e8

    def run(use: str, size: float) -> Run:
        force = size * scipy.signal.lfilter(*scipy.signal.butter(2, 0.1), rng.standard_normal(2500))
        x, v, out = 0.0, 0.0, np.zeros(2500)
        for i in range(1, 2500):
            for part in range(8):  # Störmer-Verlet with the force straight between samples
                F = force[i - 1] + (part + 0.5) / 8 * (force[i] - force[i - 1])
                v += dt / 8 * (F - c * v - k * x - hard * x**3) / m
                x += dt / 8 * v
            out[i] = x
        out += 0.002 * out.std() * rng.standard_normal(len(out))
        units = {"command": "N", "displacement": "m"}
        return Run(use, "", 2000.0, {"command": force, "displacement": out}, units, use=use)

    matrix = Matrix(Actuator("SPRING"), (run("fit", 40.0), run("verify", 60.0)))
    assert "drive" in [model.name for model in in_question(matrix.runs)]
    fit = identify(matrix, Settings(model=""))
    assert fit.model == "drive"
    with of_few_effects(full, "cubic_stiffness"):
        found = diagnose(matrix, fit, most=1, propose=False)
    assert found.verdict.effects == ("cubic_stiffness",)
    assert found.ladder[-1].error["verify"] < 0.1 * found.ladder[0].error["verify"]


def lagging(seed: int, gain: float = 1.0, beside: float = 0.0, wander: float = 0.0) -> Matrix:
    """A staircase in unknown units, answered exactly by T x' + x = K r with T = 0.4 s; noise of 0.5 %.

    The record may lie `beside` it, or `wander` about it by so much.
    """
    rng = np.random.default_rng(seed)
    r = np.repeat(rng.uniform(0.0, 10.0, 30), 100)
    x, out = r[0], np.zeros(len(r))
    for k in range(len(r)):
        out[k] = gain * x
        x += (r[k] - x) * -np.expm1(-1.0 / RATE / 0.4)
    out += 0.005 * out.std() * rng.standard_normal(len(out)) + beside + wander * np.sin(np.arange(len(r)) / RATE)
    run = Run("r", "", RATE, {"command": r, "displacement": out}, {"command": "1", "displacement": "1"}, hold="zoh")
    return Matrix(Actuator("UNKNOWN"), (run,))


@pytest.mark.parametrize("seed", short_form([1, 2, 3], 1))
def test_in_unknown_units_a_loop_is_known_by_where_its_output_is(seed):
    matrix = lagging(seed)
    assert [model.name for model in in_question(matrix.runs)] == ["qian2014"]
    said = "No model was named: qian2014 is used, a position loop, because the recorded output follows the command; "
    (notice,) = (one for one in choose_structure(matrix).matrix.notices if one.startswith(said))
    assert notice.endswith("(--model position_servo).")
    of_force = replace(
        matrix.runs[0],
        output="force",
        units={"command": "1", "force": "1"},
        channels={"command": matrix.runs[0].command, "force": matrix.runs[0].measured},
    )
    assert [model.name for model in in_question([of_force])] == ["force_loop"]


@pytest.mark.parametrize(("end", "models"), [(1.0, ["qian2014"]), (0.8, ["motor"])])
def test_in_unknown_units_a_loop_is_known_by_where_its_output_arrives(end, models):
    """At a limited speed, which no lag is: 40 counts a sample towards each target, or `end` of the way to it."""
    target = np.repeat(np.random.default_rng(67).integers(0, 9000, 6), 300).astype(float)
    count = np.zeros(len(target))
    for k in range(1, len(target)):
        count[k] = count[k - 1] + np.clip(end * target[k - 1] - count[k - 1], -40.0, 40.0)
    run = Run("r", "", RATE, {"command": target, "displacement": count}, {"command": "1", "displacement": "1"})
    assert [model.name for model in in_question([run])][:1] == models


@pytest.mark.parametrize(
    "run",
    [
        lagging(1, gain=0.8).runs[0],  # elsewhere than the command
        lagging(1, beside=1.0).runs[0],
        lagging(1, wander=0.5).runs[0],
        replace(lagging(1).runs[0], units={"command": "V", "displacement": "m"}),
        replace(
            lagging(1).runs[0],
            output="velocity",
            channels={"command": lagging(1).runs[0].command, "velocity": lagging(1).runs[0].measured},
        ),
        replace(lagging(1).runs[0], channels={"command": np.ones(3000), "displacement": np.ones(3000)}),
        replace(lagging(1).runs[0], channels={"command": np.arange(9.0), "displacement": np.arange(9.0)}),
    ],
    ids=["another-gain", "beside", "wandering", "other-units", "speed", "one-value", "short"],
)
def test_else_a_command_in_unknown_units_is_in_open_loop(run):
    assert "qian2014" not in [model.name for model in in_question([run])]
