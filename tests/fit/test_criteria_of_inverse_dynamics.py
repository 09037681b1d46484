"""Each number of the regression of a force on a motion decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.errors import Unusable
from ident.fit import drive_regression, inverse_dynamics
from ident.fit.drive_regression import RegressedIdentification
from ident.fit.identification import Identification
from ident.fit.inverse_dynamics import _Record, _solved, _weighted, regress
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE = 1000.0


class Known(Exception):
    """What a test asks for is known."""


def record(monkeypatch: pytest.MonkeyPatch, position: np.ndarray, force: np.ndarray, rate: float = RATE) -> _Record:
    """What the regression takes of a run."""

    def known(records: Any, _: Any) -> Any:
        raise Known(records[0])

    monkeypatch.setattr(inverse_dynamics, "_weighted", known)
    channels = {"displacement": position, "drive_force": force}
    run = Run("r", "", rate, channels, {"displacement": "m", "drive_force": "N"})
    with pytest.raises(Known) as found:
        regress(Matrix(Actuator("A"), (run,)))
    taken: _Record = found.value.args[0]
    return taken


def seconds(count: float) -> np.ndarray:
    """Times, s."""
    return np.arange(round(count * RATE)) / RATE


@pytest.mark.parametrize(("frequency", "passes"), [(20.0, 0.5), (30.0, 1.0 / (1.0 + 1.5**8))])
def test_force_and_motion_pass_a_low_pass_of_fourth_order_at_20_hz(monkeypatch, frequency, passes):
    """Passed forward and back, half of a sine at the cut-off is left (Butterworth 1930)."""
    t = seconds(20.0)
    found = record(monkeypatch, t, np.sin(2 * np.pi * frequency * t))
    assert np.std(found.force) * np.sqrt(2.0) == pytest.approx(passes, rel=0.15)


def test_four_samples_of_a_period_of_the_cut_off_remain(monkeypatch):
    """Of each 50 ms; a sample rate below that is refused."""
    t = seconds(20.0)
    assert len(record(monkeypatch, t, np.sin(t)).force) == pytest.approx(20.0 * 20 * 4, rel=0.05)
    record(monkeypatch, t, np.sin(t), rate=1.15 * 80.0)
    with pytest.raises(Unusable, match="cut-off"):
        record(monkeypatch, t, np.sin(t), rate=0.85 * 80.0)


def test_a_sample_slower_than_a_fiftieth_of_the_fastest_is_left_out(monkeypatch):
    """Of a sine the part of each period in which its slope is less."""
    t = seconds(200.0)
    moving = record(monkeypatch, np.sin(2 * np.pi * 0.05 * t), np.sin(t)).moving
    assert 1.0 - np.mean(moving) == pytest.approx(2 / np.pi * np.arcsin(0.02), rel=0.1)


@pytest.mark.parametrize(("samples", "enough"), [(17, False), (23, True)])
def test_a_run_has_twenty_samples_in_motion(monkeypatch, samples, enough):
    """Each is 12 ms; at either end 50 ms are left out."""
    t = seconds(0.1 + 0.012 * samples)
    if enough:
        assert len(record(monkeypatch, t, np.sin(40 * t)).force) == samples
    else:
        with pytest.raises(Unusable, match="fewer than"):
            record(monkeypatch, t, np.sin(40 * t))


def of(design: np.ndarray, force: np.ndarray) -> _Record:
    """A record in motion throughout."""
    return _Record(design, force, np.ones(len(force), dtype=bool))


def test_a_perfect_run_has_not_all_the_weight():
    design = np.random.default_rng(0).standard_normal((200, 2))
    force = design @ np.ones(2)
    _, weights = _weighted([of(design, force)], range(2))
    assert 1.0 / weights[0] == pytest.approx(1e-6 * np.std(force), rel=0.15, abs=0.0)


@pytest.mark.parametrize(("apart", "separates"), [(1.7e-6, False), (2.3e-6, True)])
def test_a_motion_that_hardly_separates_two_coefficients_is_refused(apart, separates):
    """Two columns that differ by this: their lesser singular value is 1/√2 of it, and √2 of the least is asked for."""
    first, other = np.linalg.qr(np.random.default_rng(0).standard_normal((200, 2)))[0].T
    records = [of(np.column_stack([first, first + apart * other]), first)]
    if separates:
        _solved(records, range(2), np.ones(1))
    else:
        with pytest.raises(Unusable, match="separate"):
            _solved(records, range(2), np.ones(1))


def test_the_model_of_a_regression_has_next_to_no_spring(monkeypatch):
    def known(_self: Any, _matrix: Any, settings: Settings, _report: Any) -> None:
        raise Known(settings.fixed["k0"])

    monkeypatch.setattr(Identification, "__init__", known)
    monkeypatch.setattr(drive_regression, "regress", lambda _: None)
    monkeypatch.setattr(drive_regression, "_values", lambda _: {})
    with pytest.raises(Known) as found:
        RegressedIdentification(SimpleNamespace(), Settings(model="drive"))
    assert found.value.args[0] == pytest.approx(1e-6, rel=0.15, abs=0.0)
