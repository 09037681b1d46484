"""A run split into estimation and validation data, with a gap as long as the machine remembers its command."""

from __future__ import annotations

import json

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.errors import Unusable
from ident.readers import from_arrays, read_matrix
from ident.readers.split import memory

RATE = 1000.0
UNITS = {"command": "mm", "displacement": "mm"}


def lagged(tau: float, seconds: float = 8.0, noise: float = 0.0) -> dict[str, np.ndarray]:
    """Noise through a first-order lag of time constant tau (s), whose impulse response is exp(-t/tau)/tau."""
    random = np.random.default_rng(5)
    command, pole = random.normal(size=int(seconds * RATE)), np.exp(-1.0 / (RATE * tau))
    answer = lfilter([1.0 - pole], [1.0, -pole], command)
    return {"command": command, "displacement": answer + noise * random.normal(size=len(answer))}


def read(arrays, **stated):
    return from_arrays(arrays, units=UNITS, sample_rate="1000 Hz", **stated)


@pytest.mark.parametrize("tau", [0.01, 0.03, 0.1])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_the_memory_is_the_time_in_which_the_impulse_response_falls_to_one_per_cent(tau, noise):
    """tau·ln 100 = 4.6 tau of a first-order lag: within a fifth of it."""
    run = read(lagged(tau, noise=noise)).runs[0]
    assert memory(run) / RATE == pytest.approx(tau * np.log(100.0), rel=0.2)


def test_what_integrates_remembers_for_as_long_as_can_be_seen():
    arrays = lagged(0.01)
    run = read(arrays | {"displacement": np.cumsum(arrays["command"])}).runs[0]
    assert memory(run) > 0.5 * run.length // 8


def test_a_split_run_is_two_whose_samples_are_those_of_the_record():
    """The gap is the memory; the command before acts on; each part loses its own mean; the notice has the gap."""
    arrays = lagged(0.03)
    matrix = read(arrays, split={"validation": [6000, 8000]})
    estimation, validation = matrix.runs
    assert [(run.id, run.use) for run in matrix.runs] == [("run", "fit"), ("run.validation", "verify")]
    gap = 6000 - estimation.length
    assert gap == memory(read(arrays).runs[0])
    assert gap / RATE == pytest.approx(0.138, rel=0.2)
    np.testing.assert_allclose(estimation.measured, 1e-3 * arrays["displacement"][: 6000 - gap])
    np.testing.assert_allclose(validation.measured, 1e-3 * arrays["displacement"][6000:])
    np.testing.assert_allclose(validation.past, 1e-3 * arrays["command"][:6000])
    assert any("a gap of 0.1" in notice for notice in matrix.notices)
    levelled = read(arrays, split={"validation": [6000, 8000]}, trend="mean")
    assert all(abs(run.measured.mean()) < 1e-15 for run in levelled.runs)


def test_validation_data_may_stand_first_and_rows_are_counted_in_the_file():
    arrays = lagged(0.01)
    matrix = read(arrays, rows=(1000, 7000), split={"validation": [1000, 2000], "gap": "0.5 s"})
    estimation, validation = matrix.runs
    np.testing.assert_allclose(validation.command, 1e-3 * arrays["command"][1000:2000])
    np.testing.assert_allclose(estimation.command, 1e-3 * arrays["command"][2500:7000])
    assert not any("too short" in notice for notice in matrix.notices)
    short = read(arrays, split={"validation": [6000, 8000], "gap": "1 ms"})
    assert any("too short" in notice for notice in short.notices)


@pytest.mark.parametrize(
    ("stated", "where"),
    [
        ({"split": {"validation": [6000, 9000]}}, "split"),
        ({"split": {"validation": [0, 8000]}}, "split"),
        ({"split": {"validation": [5, 3]}}, "split validation"),
        ({"split": {"validation": [3000, 5000], "gap": "5 s"}}, "split"),
        ({"split": {"validation": [6000, 8000]}, "use": "verify"}, "split"),
        ({"split": {"validation": [500, 900]}, "rows": (1000, 7000)}, "split"),
    ],
)
def test_a_split_that_cannot_be_is_refused(stated, where):
    with pytest.raises(Unusable) as refused:
        read(lagged(0.01), **stated)
    assert (refused.value.code, refused.value.where) == ("bad-split", f"the run {where}")


def test_no_run_may_be_called_as_the_validation_data_of_another(tmp_path):
    """They differ by their ids, whatever the case of the letters."""
    run = {"file": "a.csv", "sample_rate": "1 Hz", "channels": {n: {"column": n, "unit": u} for n, u in UNITS.items()}}
    runs = [run | {"id": "a", "split": {"validation": [50, 90]}}, run | {"id": "A.Validation"}]
    (tmp_path / "matrix.yaml").write_text(json.dumps({"actuator": {"serial": "S"}, "runs": runs}))
    with pytest.raises(Unusable, match=r"two runs are called 'A\.Validation'"):
        read_matrix(tmp_path)


def test_many_outputs_are_split_each():
    arrays = lagged(0.01)
    arrays["load_pressure"] = arrays["displacement"]
    units = UNITS | {"load_pressure": "bar"}
    matrix = from_arrays(
        arrays,
        units=units,
        sample_rate="1000 Hz",
        output=["displacement", "load_pressure"],
        split={"validation": [6000, 8000]},
    )
    assert [run.id for run in matrix.runs] == [
        "run.displacement",
        "run.load_pressure",
        "run.validation.displacement",
        "run.validation.load_pressure",
    ]
