"""A current that answers the voltage of a coil, from Kirchhoff's law: a lag of L/R, and a gain of 1/R."""

from __future__ import annotations

import numpy as np
import pytest

from ident.drafts.answers import Answer, Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_raw
from ident.readers import read_matrix
from ident.workflows import identify

RESISTANCE, INDUCTANCE, STEP, COUNT = 4.0, 0.1, 1e-3, 4000


def coil() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, voltages that are held, and the current of u = R i + L di/dt, exact between two samples."""
    rng = np.random.default_rng(7)
    voltage = np.repeat(rng.integers(0, 13, COUNT // 200), 200).astype(float)
    keep, current, shown = np.exp(-STEP * RESISTANCE / INDUCTANCE), 0.0, np.empty(COUNT)
    for at in range(COUNT):
        shown[at] = current
        current = keep * current + (1.0 - keep) * voltage[at] / RESISTANCE
    return STEP * np.arange(COUNT), voltage, shown + 0.01 * rng.standard_normal(COUNT)


@pytest.fixture
def table(tmp_path):
    np.savetxt(tmp_path / "run.csv", np.column_stack(coil()), "%.9g", ",", header="time_s,u_V,current_A", comments="")
    return tmp_path


@pytest.mark.parametrize("output", ["output: current\n    ", ""])
def test_a_coil_is_a_lag_whose_gain_is_in_amperes_for_each_volt(table, output):
    """Where nothing else answers, the current is the output without a word."""
    (table / "matrix.yaml").write_text(f"""
actuator: {{serial: COIL}}
runs:
  - id: a
    file: run.csv
    time: {{column: time_s, unit: s}}
    hold: zoh
    {output}channels:
      command: {{column: u_V, unit: V}}
      current: {{column: current_A, unit: A}}
""")
    fit = identify(read_matrix(table))
    assert fit.model == "first_order"
    assert fit.parameters["gain"].unit == "A/V"
    assert fit.parameters["gain"].value == pytest.approx(1.0 / RESISTANCE, rel=0.01)
    assert fit.parameters["tau"].value == pytest.approx(INDUCTANCE / RESISTANCE, rel=0.01)


def test_nothing_else_is_asked_of_such_a_file(table):
    file = read_raw((table / "run.csv").read_bytes(), "run.csv")
    draft = Draft([file], Answers("COIL", {"command": Answer("u_V")}))
    assert not draft.missing
    rows = b"".join(b"%g,%g,%g\n" % (0.1 * n, n % 7, n % 5) for n in range(40))
    beside = read_raw(b"time_s,current_A,other\n" + rows, "run.csv")
    asked = [one.key for one in Draft([beside], Answers("COIL")).missing]
    assert asked == ["channel command", "channel displacement"]
