"""Machines put together from stages: what goes together fits data, what does not is refused in one line."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import yaml

from ident.chain.chain import linear_model
from ident.comparison.compare import compare, modelled
from ident.errors import Unusable
from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets import PRESETS, preset
from ident.presets.description import CHOICES, SHOWN, described
from ident.presets.machine import machine
from ident.presets.suitable_models import in_question
from ident.readers import read_matrix
from ident.run import Run
from ident.workflows import diagnose, identify

RATE = 200.0
UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s^2", "force": "N", "load_pressure": "Pa"}


def force_loop(seed: int, seconds: float = 10.0, overlap: float = 0.0) -> Matrix:
    """A cylinder that presses a spring of 500 kN/m under a PI controller of force; Euler steps of 0.1 ms.

    N in the command and in the record; the opening in N times the dial, of which `overlap` is lost to either side.
    """
    kp, ki, tau, gain, area, stiffness, mass, damping, oil, leak = (
        2.0, 8.0, 5e-3, 2e-9, 1e-3, 5e5, 50.0, 3e3, 2e-13, 2e-12,
    )  # fmt: skip
    runs = []
    for number, use in enumerate(("fit", "verify")):
        rng = np.random.default_rng([seed, number])
        r = 4e3 * smooth(rng, round(seconds * RATE), 8.0)
        out, parts = np.zeros(len(r)), 50
        q = pressure = v = x = summed = force = 0.0
        dt = 1.0 / RATE / parts
        for k in range(len(r)):
            out[k] = force
            for part in range(parts):
                share = part / parts
                asked = r[k] + share * (r[min(k + 1, len(r) - 1)] - r[k])
                e = kp * (asked - force) + ki * summed
                summed += dt * (asked - force)
                q += dt * (e - q) / tau
                w = q - min(max(q, -overlap), overlap)
                pressure += dt * (gain * w - leak * pressure - area * v) / oil
                v += dt * (area * pressure - damping * v - stiffness * x) / mass
                x += dt * v
                force = stiffness * x
        out += 0.005 * out.std() * rng.standard_normal(len(out))
        channels, units = {"command": r, "force": out}, {"command": "N", "force": "N"}
        runs.append(Run(use, "", RATE, channels, units, gain=kp, kind="blwn", output="force", use=use))
    return Matrix(Actuator("PRESS", piston_area=area), tuple(runs))


def smooth(rng: np.random.Generator, n: int, hertz: float) -> np.ndarray:
    """Band-limited noise of unit deviation that begins at zero."""
    spectrum = np.fft.rfft(rng.standard_normal(n))
    spectrum[np.fft.rfftfreq(n, 1 / RATE) > hertz] = 0.0
    u = np.fft.irfft(spectrum, n)
    return (u / u.std()) * np.minimum(1.0, np.arange(n) / 40)


@pytest.mark.full
def test_a_force_loop_is_taken_for_one_and_fitted_to_the_noise():
    matrix = force_loop(1)
    assert [model.name for model in in_question(matrix.runs)] == ["force_loop"]
    fit = identify(matrix, Settings(model=""))
    assert fit.model == "force_loop"
    assert fit.error["fit"] == pytest.approx(0.005, rel=0.1)
    assert fit.error["verify"] == pytest.approx(0.005, rel=0.1)
    assert {"m0", "Ka", "Cl"} <= {entry.name for entry in fit.undetermined}  # no position was recorded


def test_what_a_force_loop_lacks_is_found(full):
    if not full:
        pytest.skip("half a minute: run with --full")
    found = diagnose(force_loop(2, overlap=600.0), settings=Settings(model="force_loop"), most=1)
    assert found.candidates[0].effect == "dead_zone"
    assert found.verdict.effects == ("dead_zone",)
    assert found.ladder[1].parameters["dead_zone.half_width"].value == pytest.approx(600.0, rel=0.1)


def test_a_machine_has_its_description_for_a_name():
    data = {
        "controller": "pi",
        "of": "force",
        "valve": "first",
        "flow": "linear",
        "pressure": "compressible",
        "load": "mass_spring_damper",
        "sensor": ["force"],
        "gains": {"P": 2, "I": 10},
    }
    name = described(data).name
    assert machine(name).name == name
    assert described(yaml.safe_load(yaml.safe_dump(data))).name == name
    assert preset(name).data.gains == {"cal": 1.0, "Kp": 2.0, "KI": 10.0}
    assert preset(name).data.compares == "force"


@pytest.mark.parametrize(
    ("said", "refused"),
    [
        ({"flow": "to_speed", "load": "mass_spring_damper"}, "flow: to_speed and load: mass_spring_damper do not go"),
        ({"flow": "linear", "load": "mass_spring_damper"}, "flow: linear and load: mass_spring_damper do not go"),
        ({"pressure": "compressible"}, "pressure: compressible and flow: none do not go"),
        ({"controller": "p", "load": "prescribed_motion"}, "controller: p and load: prescribed_motion do not go"),
        ({"flow": "to_speed", "sensor": "force"}, "load: none and sensor: force do not go"),
        ({"controller": "p", "of": "velocity", "flow": "to_speed"}, "controller: p and valve: none do not go"),
        ({"valve": "third"}, "'third' is none of its kinds; choose from none, first, second"),
        ({"vlave": "first"}, "unknown key 'vlave'"),
        ({"controller": "p", "gains": {"I": 2}, "flow": "to_speed"}, "has no gain 'I'; give P"),
        ({"controller": "pi", "gains": {"I": "much"}, "flow": "to_speed"}, "give a positive number"),
        ({"sensor": ["weight"]}, "'weight' is not a channel of a machine"),
        ("first", "'first' is not a list of place: choice"),
    ],
)
def test_what_does_not_go_together_is_refused_in_one_line(said, refused):
    with pytest.raises(Unusable, match=refused) as error:
        machine(described(said).name)
    assert "\n" not in str(error.value)


def test_every_description_is_a_model_or_a_refusal():
    """All places by all kinds; every model puts its signals in an order and takes its effects without a circle."""
    made = 0
    for kinds in product(*CHOICES.values()):
        said = dict(zip(CHOICES, kinds, strict=True))
        try:
            model = machine(described(said).name)
        except Unusable:
            continue
        made += 1
        assert model.chain.signals
        assert model.title
        assert all(parameter.meaning for parameter in model.parameters)
    assert made > 200


_DRAWN = {place: tuple(kind for kind in kinds if "two_masses" not in kind) for place, kinds in CHOICES.items()}
"""What machines are drawn from; those of two masses stand in test_two_masses."""


def drawn(rng: np.random.Generator) -> str:
    """The name of a machine of which every two stages go together, and of one or two records of it."""
    while True:
        said: dict[str, object] = {place: str(rng.choice(kinds)) for place, kinds in _DRAWN.items()}
        said["sensor"] = [str(name) for name in rng.choice(SHOWN, rng.integers(1, 3), replace=False)]
        try:
            return machine(described(said).name).name
        except Unusable:
            continue


def recorded(name: str, rng: np.random.Generator) -> Matrix:
    """Two runs of noise into a machine, its outputs noise as well: what a search space takes its sizes from."""
    model, runs = preset(name), []
    for use in ("fit", "verify"):
        channels = {channel: smooth(rng, 2000, 20.0) for channel in ("command", "velocity", "force")}
        channels |= {output: smooth(rng, 2000, 20.0) for output in model.chain.outputs}
        units = {channel: UNITS.get(channel, "1") for channel in channels}
        first = next(iter(model.chain.outputs))
        run = Run(use, "", RATE, channels, units, kind="blwn", output=first, use=use)
        runs += run.of_outputs(tuple(model.chain.outputs))
    return Matrix(Actuator("ANY"), tuple(runs))


def with_own_outputs(name: str, matrix: Matrix, rng: np.random.Generator) -> Matrix | None:
    """The matrix with what the machine does at values from the middle of its search, 1 % of noise on it.

    None where none of a hundred is stable.
    """
    work = Identification(matrix, Settings(model=name))
    space = work.objective.space
    for _ in range(100):
        point = rng.uniform(0.3, 0.7, (1, len(space.axes)))
        values = {key: float(value[0]) for key, value in space.values(point).items()}
        poles = np.linalg.eigvals(linear_model(work.preset.core, values, work.matrix.runs[0], matrix.actuator).A)
        with np.errstate(all="ignore"):
            outputs = modelled(work.preset, values, work.matrix)
            lively = all(np.isfinite(np.std(out)) and 1e-12 < np.std(out) < 1e12 for out in outputs.values())
        if lively and poles.real.max() < 1e-6:
            break
    else:
        return None
    shown = {run.id: outputs[run.id] for run in work.matrix.runs}
    noisy = {key: out + 0.01 * np.std(out) * rng.standard_normal(len(out)) for key, out in shown.items()}
    runs = []
    for run in matrix.runs:
        same = [other for other in matrix.runs if (other.record or other.id) == (run.record or run.id)]
        channels = dict(run.channels) | {other.output: noisy[other.id] for other in same}
        runs.append(replace(run, channels=channels))
    return replace(matrix, runs=tuple(runs))


def test_machines_drawn_at_random_fit_their_own_data(full):
    """Simulated here by the program itself: the stages of one machine understand each other, and a search finds it.

    In the short form one machine of one record or two, in the full form 500.
    """
    count, errors = 500 if full else 1, []
    for seed in range(count):
        rng = np.random.default_rng([2026, seed])
        name = drawn(rng)
        matrix = with_own_outputs(name, recorded(name, rng), rng)
        if matrix is None:
            continue
        fit = identify(matrix, Settings(model=name, seed=seed))
        errors.append(fit.error["fit"])
        assert compare(matrix, fit).error["fit"] == pytest.approx(fit.error["fit"], rel=1e-4), name
    assert len(errors) > 0.7 * count
    assert np.mean(np.array(errors) < 0.015) > 0.75, errors


def test_a_first_state_is_followed_until_it_stays():
    """A loop with a square root that begins in motion: after three rounds 45 % were left where the fit promised 3.7 %.

    The values are those of the fit; a comparison begins anew.
    """
    rng = np.random.default_rng([2026, 188])
    name = drawn(rng)
    matrix = with_own_outputs(name, recorded(name, rng), rng)
    assert matrix is not None
    work = Identification(matrix, Settings(model=name))
    assert [run.begins for run in work.matrix.of_use("fit")] == ["moving", "moving"]
    values = {"KI": 1014.815, "KD": 0.0352813, "Tf": 7.40414e-4, "tau": 5.39609e-4, "Z0": 0.676799, "m0": 454.8575,
              "Ka": 9.972e-8, "Cl": 1.72003e-6, "c0": 14683.34, "cal": 1.0}  # fmt: skip
    found = modelled(work.preset, values, work.matrix)
    left = [np.std(run.measured - found[run.id]) / np.std(run.measured) for run in work.matrix.of_use("fit")]
    assert max(left) < 0.04


def test_a_matrix_says_its_machine_and_a_fit_takes_it(tmp_path, servoident):
    """`machine:` in matrix.yaml, and the same in a file for --model; the result says it."""
    said = {"valve": "first", "flow": "to_speed", "sensor": ["displacement"]}
    u = smooth(np.random.default_rng(3), 2000, 10.0)
    q, x, out = 0.0, 0.0, np.zeros(len(u))
    for k in range(len(u) - 1):
        for part in range(50):
            asked = u[k] + part / 50 * (u[k + 1] - u[k])
            q += (asked - q) / 0.03 / RATE / 50
            x += 0.2 * q / RATE / 50
        out[k + 1] = x
    np.savetxt(tmp_path / "run.csv", np.column_stack([u, out]), delimiter=",", header="u,x", comments="")
    channels = {"command": {"column": "u", "unit": "V"}, "displacement": {"column": "x", "unit": "m"}}
    run = {"id": "one", "file": "run.csv", "sample_rate": f"{RATE} Hz", "channels": channels}
    description = {"actuator": {"serial": "AXIS"}, "machine": said, "runs": [run]}
    (tmp_path / "matrix.yaml").write_text(yaml.safe_dump(description))
    matrix = read_matrix(tmp_path)
    fit = identify(matrix, Settings(model=""))
    assert fit.model == matrix.machine == described(said).name
    assert fit.values["Kv"] == pytest.approx(0.2, rel=0.01)
    assert fit.values["tau"] == pytest.approx(0.03, rel=0.02)
    assert fit.to_json()["machine"] == said
    file, result = tmp_path / "axis.yaml", tmp_path / "fit.json"
    file.write_text(yaml.safe_dump({"machine": said}))
    done = servoident("fit", tmp_path, "--model", file, "--json", result)
    assert done.returncode == 0, done.stderr
    assert yaml.safe_load(result.read_text())["model"] == fit.model
    file.write_text("valve: third\n")
    done = servoident("fit", tmp_path, "--model", file)
    assert done.returncode == 2
    assert f"{file} valve: 'third' is none of its kinds" in done.stderr


def test_the_moved_specimen_is_one_of_them():
    assert machine(described({"load": "prescribed_motion"}).name).chain.stages == PRESETS["specimen"].chain.stages


@pytest.mark.parametrize("sensor", [5, {"displacement": 1}, [["force"]], True])
def test_what_is_recorded_is_a_list_of_channels_or_refused(sensor):
    with pytest.raises(Unusable, match="machine sensor"):
        described({"flow": "to_speed", "sensor": sensor})


def test_a_machine_without_a_state_is_fitted():
    """A valve without lag, flow to speed, speed recorded: nothing that could be unstable."""
    rng = np.random.default_rng(4)
    u = smooth(rng, 1000, 10.0)
    out = 3.0 * u + 0.01 * rng.standard_normal(len(u))
    channels, units = {"command": u, "velocity": out}, {"command": "V", "velocity": "m/s"}
    run = Run("one", "", RATE, channels, units, kind="blwn", output="velocity")
    model = described({"flow": "to_speed", "sensor": "velocity"}).name
    fit = identify(Matrix(Actuator("FAN"), (run,)), Settings(model=model))
    assert fit.values["Kv"] == pytest.approx(3.0, rel=0.01)
