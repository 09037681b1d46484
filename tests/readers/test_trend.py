"""A run may leave its mean or its straight line out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.signal import detrend

from ident.errors import Unusable
from ident.readers import read_matrix
from ident.run import Run

K = np.arange(400.0)
SIGNALS = {
    "command": 2.0 + 0.01 * K + np.sin(0.3 * K),
    "displacement": -1.0 - 0.02 * K + np.cos(0.2 * K),
    "temperature": 40.0 + 0.1 * K,
}
UNITS = {"command": "mm", "displacement": "mm", "temperature": "K"}


def run(folder: Path, signals: dict[str, np.ndarray] = SIGNALS, **labels: object) -> Run:
    """The run of a matrix with these signals and labels."""
    np.savez(folder / "run.npz", **signals)
    channels = {name: {"column": name, "unit": UNITS[name]} for name in signals}
    described = {"id": "one", "file": "run.npz", "sample_rate": "100 Hz", "channels": channels} | labels
    (folder / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "T"}, "runs": [described]}))
    return read_matrix(folder).runs[0]


@pytest.mark.parametrize(("trend", "kind"), [("mean", "constant"), ("line", "linear")])
def test_the_signals_lose_what_least_squares_find_and_absolute_ones_keep_it(tmp_path, trend, kind):
    found = run(tmp_path, trend=trend)
    for name in ("command", "displacement"):
        np.testing.assert_allclose(found.channels[name], 1e-3 * detrend(SIGNALS[name], type=kind), atol=1e-15)
    np.testing.assert_array_equal(found.channels["temperature"], SIGNALS["temperature"])


def test_the_trend_is_that_of_the_rows_and_the_command_before_them_loses_the_same_line(tmp_path):
    found = run(tmp_path, rows=[150, 300], trend="line")
    line = np.polynomial.Polynomial.fit(K[150:300], SIGNALS["command"][150:300], 1)
    np.testing.assert_allclose(found.command, 1e-3 * (SIGNALS["command"] - line(K))[150:300], atol=1e-15)
    assert found.past is not None
    np.testing.assert_allclose(found.past, 1e-3 * (SIGNALS["command"] - line(K))[:150], atol=1e-15)


def test_none_is_what_no_trend_is(tmp_path):
    np.testing.assert_array_equal(run(tmp_path, trend="none").command, run(tmp_path).command)


def test_a_signal_that_is_only_its_trend_is_refused(tmp_path):
    with pytest.raises(Unusable, match="channel displacement without its line") as refused:
        run(tmp_path, SIGNALS | {"displacement": 3.0 + 0.1 * K}, trend="line")
    assert refused.value.code == "nothing-left"
