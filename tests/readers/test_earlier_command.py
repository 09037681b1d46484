"""A run that takes rows of a longer file: what the command did before them still acts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.readers import read_matrix
from ident.workflows import compare, identify
from tests.short_form import short_form

RATE, LAG, GAIN, LATE = 100.0, 0.08, 0.7, 0.93
FIRST, END = 700, 1300


def record(folder: Path, hold: str, rows: tuple[int, int] | None, uneven: bool = False) -> Matrix:
    """T y' + y = K u(t − L) with a delay of 93 samples, of a command that never rests; steps of 0.1 ms.

    With `rows` the run takes them of the whole file; without, the file holds only them.
    """
    rng = np.random.default_rng(5)
    time = np.arange(1400) / RATE + (0.002 * rng.uniform(-1, 1, 1400) if uneven else 0.0)
    fine = np.arange(-LATE, time[-1] + 1e-4, 1e-4)
    levels = rng.uniform(-1, 1, 200)
    if hold == "zoh":
        u = np.repeat(levels, 7)
        acting = u[np.clip(np.searchsorted(time, fine - LATE + 1e-9, side="right") - 1, 0, None)]
    else:
        u = np.sin(2 * np.pi * 0.9 * time + 3 * np.sin(0.7 * time))
        acting = np.interp(fine - LATE, time, u)
    y, now = np.zeros(len(fine)), 0.0
    for k in range(len(fine)):
        y[k] = now
        now += (GAIN * acting[k] - now) * -np.expm1(-1e-4 / LAG)
    x = np.interp(time, fine, y)
    x += 0.003 * x.std() * rng.standard_normal(len(x))
    table = np.column_stack([time, u, x])
    np.savetxt(folder / "run.csv", table if rows else table[FIRST:END], delimiter=",", header="t,u,x", comments="")
    channels = {"command": {"column": "u", "unit": "V"}, "displacement": {"column": "x", "unit": "m"}}
    clock = {"time": {"column": "t", "unit": "s"}} if uneven else {"sample_rate": f"{RATE} Hz"}
    run = {"id": "one", "file": "run.csv", "hold": hold, "channels": channels} | clock
    run |= {"rows": list(rows)} if rows else {}
    (folder / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "PAST"}, "runs": [run]}))
    return read_matrix(folder)


@pytest.mark.parametrize("hold", short_form(["zoh", "linear"], "zoh"))
def test_a_delay_brings_in_what_was_commanded_before_the_rows(tmp_path, hold):
    matrix = record(tmp_path, hold, (FIRST, END))
    settings = Settings(model="first_order", effects=("command_delay",), bounds={"command_delay.delay": (0.0, 2.0)})
    fit = identify(matrix, settings)
    assert fit.values["command_delay.delay"] == pytest.approx(LATE, abs=0.002)
    assert fit.values["tau"] == pytest.approx(LAG, rel=0.02)
    assert fit.error["fit"] == pytest.approx(0.003, rel=0.2)
    assert compare(matrix, fit).error["fit"] == pytest.approx(fit.error["fit"], rel=1e-6)
    alone = record(tmp_path, hold, None)
    assert compare(alone, fit).error["fit"] > 0.05  # there nobody knows


def test_the_past_is_of_the_clock_of_the_record(tmp_path):
    whole = record(tmp_path, "linear", (0, 1400), uneven=True).runs[0]
    cut = record(tmp_path, "linear", (FIRST, END), uneven=True).runs[0]
    assert whole.past is None
    assert cut.evened
    assert cut.past is not None
    assert len(cut.past) == pytest.approx(END - FIRST, abs=2)
    joined = np.concatenate([cut.past, cut.command])
    assert np.max(np.abs(np.diff(joined, 3))) < 1.5 * np.max(np.abs(np.diff(whole.command, 3)))


def test_samples_that_are_missing_before_the_rows_end_the_past(tmp_path):
    record(tmp_path, "linear", (FIRST, END))
    lines = (tmp_path / "run.csv").read_text().splitlines()
    lines[1 + 640] = lines[1 + 640].split(",")[0] + ",nan,nan"
    (tmp_path / "run.csv").write_text("\n".join(lines) + "\n")
    (run,) = read_matrix(tmp_path).runs
    assert run.past is not None
    assert len(run.past) == FIRST - 641
    assert run.turned("command").past == pytest.approx(-run.past)
    assert run.driven_by("displacement").past is None
