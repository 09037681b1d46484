"""Records of a busy computer, whose samples come early and late: what acts when is told by the time column."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from ident.checks.check import check
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.readers import read_matrix
from ident.readers.clock import evened, read_clock
from ident.workflows import identify
from tests.short_form import short_form

LAG, GAIN = 0.12, 0.8
FINE = 1e-4


def record(folder: Path, seed: int, hold: str, clock: dict[str, str], digits: int = 6) -> Matrix:
    """A lag, T y' + y = K u, whose command and record are read at 20 ± 4 Hz and written with their time."""
    rng = np.random.default_rng(seed)
    steps = 0.05 + 0.01 * rng.uniform(-1, 1, 600)
    steps[[50, 220]] = 0.13
    time = np.round(np.concatenate([[3.0], 3.0 + np.cumsum(steps)]), digits)
    fine = np.arange(time[0], time[-1] + FINE, FINE)
    if hold == "zoh":
        u = np.repeat(rng.uniform(-1, 1, len(time) // 4 + 1), 4)[: len(time)]
        acting = u[np.searchsorted(time, fine + 1e-9, side="right") - 1]
    else:
        acting = np.sin(2 * np.pi * 0.3 * fine + 3 * np.sin(0.5 * fine))
        u = np.interp(time, fine, acting)
    y, now = np.zeros(len(fine)), 0.0
    for k in range(len(fine)):
        y[k] = now
        now += (GAIN * acting[k] - now) * -np.expm1(-FINE / LAG)
    read = np.interp(time, fine, y)
    table = np.column_stack([time, u, read])
    np.savetxt(folder / "run.csv", table, delimiter=",", header="t,u,x", comments="", fmt="%.9g")
    channels = {"command": {"column": "u", "unit": "m"}, "displacement": {"column": "x", "unit": "m"}}
    run = {"id": "one", "file": "run.csv", "hold": hold, "channels": channels} | clock
    (folder / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "LATE"}, "runs": [run]}))
    return read_matrix(folder)


@pytest.mark.parametrize("hold", ["zoh", "linear"])
@pytest.mark.parametrize("seed", short_form([1, 2], 2))
def test_an_uneven_clock_is_no_error_of_the_model(tmp_path, hold, seed):
    matrix = record(tmp_path, seed, hold, {"time": {"column": "t", "unit": "s"}})
    (run,) = matrix.runs
    assert run.evened
    assert run.sample_rate == pytest.approx(20, rel=0.03)
    fit = identify(matrix, Settings(model="first_order"))
    assert fit.values["tau"] == pytest.approx(LAG, rel=0.02)
    # Between two samples of an answer to a step its kink is not known: 2.5 % where it takes two samples.
    assert fit.error["fit"] < (0.03 if hold == "zoh" else 0.006)
    (found,) = [finding for finding in check(matrix) if finding.code == "clock-jitter"]
    assert found.severity == "note"
    taken_as_even = record(tmp_path, seed, hold, {"sample_rate": f"{run.sample_rate} Hz"})
    worse = 2 if hold == "zoh" else 10
    assert identify(taken_as_even, Settings(model="first_order")).error["fit"] > worse * fit.error["fit"]


def test_a_clock_that_no_rate_describes_is_refused_unless_a_rate_is_asked_for(tmp_path):
    """A creep test on a logarithmic clock: taken as even its lag would be another. A pause leaves a clock even."""
    time = np.concatenate([np.arange(60) * 0.02, 1.2 * 1.06 ** np.arange(1, 60)])
    table = np.column_stack([time, np.where(time > 0.1, 1.0, 0.0), -np.expm1(-np.maximum(time - 0.1, 0.0) / LAG)])
    np.savetxt(tmp_path / "run.csv", table, delimiter=",", header="t,u,x", comments="", fmt="%.9g")
    channels = {"command": {"column": "u", "unit": "m"}, "displacement": {"column": "x", "unit": "m"}}
    run = {"id": "one", "file": "run.csv", "channels": channels, "time": {"column": "t", "unit": "s"}}
    matrix = {"actuator": {"serial": "CREEP"}, "runs": [run]}
    (tmp_path / "matrix.yaml").write_text(yaml.safe_dump(matrix))
    with pytest.raises(Unusable) as refused:
        read_matrix(tmp_path)
    assert refused.value.code == "uneven-clock"
    assert "from 0.02 s to 2.11 s" in refused.value.what
    run["time"] = {"column": "t", "unit": "s", "resample": "20 Hz"}
    (tmp_path / "matrix.yaml").write_text(yaml.safe_dump(matrix))
    (read,) = read_matrix(tmp_path).runs
    assert (read.sample_rate, read.length) == (20.0, int(time[-1] * 20) + 1)
    even = np.arange(600) / 50
    assert not read_clock(even[(even < 2) | (even > 6)], "t").scattered


def test_an_even_clock_is_left_as_it_was_recorded():
    """However its time was printed."""
    time = np.arange(4000) / 4096
    assert read_clock(time, "t").even
    assert read_clock(np.round(time, 4), "t").even
    stray = time.copy()
    stray[1000] += 0.3 / 4096
    assert not read_clock(stray, "t").even


def test_a_held_command_is_its_mean_over_each_step():
    time = np.array([0.0, 0.9, 2.3, 3.0, 4.1, 5.0, 6.0, 7.0])
    values = np.array([1.0, 5.0, 1.0, 1.0, -2.0, 7.0, 7.0, 3.0])
    found = evened(time, values, 1.0, held=True, where="t")
    assert found == pytest.approx([0.9 * 1 + 0.1 * 5, 5, 0.3 * 5 + 0.7 * 1, 1, 0.1 * 1 - 0.9 * 2, 7, 7, 3])
    assert found[3] == 1.0  # exactly: a command that stands stands


def test_an_even_clock_that_is_asked_for(tmp_path):
    asked = {"time": {"column": "t", "unit": "s", "resample": "50 Hz"}}
    (run,) = record(tmp_path, 3, "linear", asked).runs
    assert run.sample_rate == 50.0
    assert run.length == pytest.approx(30.1 * 50, rel=0.03)
    for rate, what in (("1 MHz", "become"), ("1 uHz", "become"), ("-5 Hz", "not above 0"), ("5 mm", "frequency")):
        with pytest.raises(Unusable, match=what) as refused:
            record(tmp_path, 3, "linear", {"time": {"column": "t", "unit": "s", "resample": rate}})
        assert "time" in refused.value.where
