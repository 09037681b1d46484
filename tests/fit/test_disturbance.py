"""What acts beside the command and was measured: added at its place, it is no error of the model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets.suitable_models import in_question
from ident.readers import read_matrix
from ident.run import Run
from ident.workflows import compare, diagnose, identify

RATE, MASS, DRAG, GAIN = 200.0, 12.0, 90.0, 40.0


def smooth(rng: np.random.Generator, n: int, samples: int) -> np.ndarray:
    """Noise without its quick parts, of unit deviation, that begins at nothing."""
    found = np.convolve(rng.standard_normal(n), np.hanning(samples), "same")
    return found / found.std() * np.minimum(1.0, np.arange(n) / 40.0)


def axis(seed: int, told: bool = True) -> Matrix:
    """12 v' = 40 u − 90 v + d: a mass that a command and a measured force drive, in Euler steps of a hundredth."""
    runs = []
    for number, use in enumerate(("fit", "fit", "verify")):
        rng = np.random.default_rng([seed, number])
        u, d = 3.0 * smooth(rng, 3000, 30), 60.0 * smooth(rng, 3000, 50)
        v, out = 0.0, np.zeros(len(u))
        for k in range(len(u)):
            out[k] = v
            for part in range(100):
                share = part / 100
                now, pushed = ((1 - share) * s[k] + share * s[min(k + 1, len(u) - 1)] for s in (u, d))
                v += (GAIN * now - DRAG * v + pushed) / MASS / RATE / 100
        out += 0.01 * out.std() * rng.standard_normal(len(out))
        channels = {"command": u, "velocity": out} | ({"load_disturbance": d} if told else {})
        units = {"command": "V", "velocity": "m/s"} | ({"load_disturbance": "N"} if told else {})
        runs.append(Run(f"{use}-{number}", "", RATE, channels, units, output="velocity", use=use))
    return Matrix(Actuator("AXIS"), tuple(runs))


@pytest.mark.parametrize("seed", [2])
def test_a_measured_load_is_no_error_of_the_model_and_gives_forces_a_scale(seed, full):
    if not full:
        pytest.skip("a third of a minute: run with --full")
    matrix = axis(seed)
    fit = identify(matrix, Settings(model=""))
    assert fit.model == "motor"
    assert fit.error["verify"] == pytest.approx(0.01, rel=0.1)
    for name, true in (("m0", MASS), ("c0", DRAG), ("Kt", GAIN)):
        found = fit.parameters[name]
        assert found.value == pytest.approx(true, rel=0.02)
        assert abs(found.value - true) < 5 * found.std_error
    assert compare(matrix, fit).error["verify"] == pytest.approx(fit.error["verify"], rel=1e-6)


@pytest.mark.full
def test_a_disturbance_that_nobody_told_of_is_in_the_error():
    told, untold = (identify(axis(1, told), Settings(model="motor")) for told in (True, False))
    assert untold.error["verify"] > 20 * told.error["verify"]
    assert untold.parameters["m0"].std_error is None


def test_a_diagnosis_finds_nothing_beside_a_disturbance_that_was_told(full):
    if not full:
        pytest.skip("half a minute: run with --full")
    found = diagnose(axis(1), settings=Settings(model="motor"))
    assert found.verdict.effects == ()
    assert not found.verdict.unexplained


def test_a_run_without_the_channel_was_not_disturbed(full):
    if not full:
        pytest.skip("ten seconds: run with --full")
    matrix = axis(3)
    calm = axis(3, told=False).runs[2]
    fit = identify(replace(matrix, runs=(*matrix.runs[:2], calm)), Settings(model="motor"))
    assert fit.error["fit"] == pytest.approx(0.01, rel=0.1)
    assert fit.error["verify"] > 0.2  # it was, and nobody said so


def described(folder: Path, disturbance: object, actuator: dict[str, str] | None = None) -> Matrix:
    """A matrix of one run, with what its file says of a disturbance."""
    rng = np.random.default_rng(4)
    table = np.column_stack([smooth(rng, 800, 30) for _ in range(3)])
    np.savetxt(folder / "run.csv", table, delimiter=",", header="u,x,d", comments="")
    channels = {"command": {"column": "u", "unit": "V"}, "displacement": {"column": "x", "unit": "mm"}}
    run = {"id": "one", "file": "run.csv", "sample_rate": "200 Hz", "channels": channels, "disturbance": disturbance}
    matrix = {"actuator": {"serial": "AXIS", **(actuator or {})}, "runs": [run]}
    (folder / "matrix.yaml").write_text(yaml.safe_dump(matrix))
    return read_matrix(folder)


def test_a_disturbance_is_read_with_its_place_and_unit(tmp_path):
    for place, unit, factor in (("load", "kN", 1e3), ("sensor", "mm", 1e-3), ("flow", "l/min", 1e-3 / 60)):
        (run,) = described(tmp_path, {"place": place, "column": "d", "unit": unit, "invert": True}).runs
        written = np.loadtxt(tmp_path / "run.csv", delimiter=",", skiprows=1)[:, 2]
        assert run.channels[f"{place}_disturbance"] == pytest.approx(-factor * written)


@pytest.mark.parametrize(
    ("disturbance", "said"),
    [
        ({"column": "d", "unit": "N"}, "place"),
        ({"place": "pump", "column": "d", "unit": "N"}, "pump"),
        ({"place": "load", "column": "d", "unit": "mm"}, "does not measure force"),
        ({"place": "load", "unit": "N"}, "column"),
        ({"place": "load", "column": "e", "unit": "N"}, "e"),
        ([], "disturbance"),
    ],
)
def test_a_disturbance_that_says_too_little_is_refused(tmp_path, disturbance, said):
    with pytest.raises(Unusable, match=said) as refused:
        described(tmp_path, disturbance)
    assert "run one" in refused.value.where


def test_a_model_without_the_place_refuses_and_is_not_in_question(tmp_path):
    matrix = described(tmp_path, {"place": "flow", "column": "d", "unit": "l/min"})
    with pytest.raises(Unusable, match="nothing that a disturbance of the flow adds to"):
        identify(matrix, Settings(model="motor"))
    with pytest.raises(Unusable, match="unknown area"):
        identify(matrix, Settings(model="open_valve"))
    matrix = described(tmp_path, {"place": "flow", "column": "d", "unit": "l/min"}, {"piston_area": "10 cm^2"})
    assert [known.name for known in in_question(matrix.runs, oil=matrix.actuator.states_oil)] == ["open_valve"]
