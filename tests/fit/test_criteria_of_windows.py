"""Each number about the windows of a fit decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.fit import windows
from ident.fit.windows import unforeseen


def lengths(monkeypatch: pytest.MonkeyPatch, slowest: float, duration: float) -> list[float]:
    """The windows, s, that are tried of a record of this duration and slowest time constant."""
    monkeypatch.setattr(windows, "_time_constants", lambda *_: [slowest])
    run = SimpleNamespace(sample_rate=1000.0, duration=duration)
    fitness: Any = SimpleNamespace(runs=(run,), space=SimpleNamespace(values=lambda _: {}))
    return list(windows._begun_anew(fitness, np.ones(1))[1])


def test_windows_are_one_three_and_ten_times_the_slowest_time_constant(monkeypatch):
    assert lengths(monkeypatch, 0.1, 100.0) == pytest.approx([0.1, 0.3, 1.0])


@pytest.mark.parametrize(("duration", "fits"), [(3.4, False), (4.6, True)])
def test_a_record_has_four_windows_at_least(monkeypatch, duration, fits):
    assert (len(lengths(monkeypatch, 0.1, duration)) == 3) is fits


@pytest.mark.parametrize(("length", "longer"), [(1.4, False), (1.6, True)])
def test_a_longer_window_is_half_as_long_again(monkeypatch, length, longer):
    monkeypatch.setattr(windows, "_begun_anew", lambda *_: (None, [length]))
    found = windows.longer(SimpleNamespace(horizon=1.0), np.ones(1))
    assert (length in found) is longer


def test_a_level_that_wanders_is_followed_by_25_gains_from_a_ten_thousandth_on(monkeypatch):
    asked: list[float] = []

    def known(_: Any, denominator: list[float], level: np.ndarray) -> np.ndarray:
        asked.append(1.0 + denominator[1])
        return level

    monkeypatch.setattr(windows, "linear_filter", known)
    unforeseen(np.arange(5.0))
    assert asked == pytest.approx(np.geomspace(1e-4, 1.0, 25).tolist(), rel=1e-6)


def test_a_speed_that_wanders_is_followed_by_25_memories_from_a_third_of_a_sample(monkeypatch):
    """0.3 of a sample, to the whole record."""
    asked: list[float] = []

    def known(residual: np.ndarray, memory: float) -> np.ndarray:
        asked.append(memory)
        return residual

    monkeypatch.setattr(windows, "innovations", known)
    run = SimpleNamespace(id="r", sample_rate=1000.0, duration=2.0)
    windows._most_likely(SimpleNamespace(runs=(run,)), {"r": np.ones(5)})
    assert asked == pytest.approx(np.geomspace(0.3, 2000.0, 25).tolist(), rel=1e-6)
