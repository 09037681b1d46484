"""Stored levels: a plot of any stretch shows what the samples show, and reads few of them."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest

from ident.decimation.levels import FACTOR, TOP, Levels, write_levels
from ident.run import Run

BINS = 350


@pytest.fixture(scope="module")
def signal():
    """A slow sine on a large mean, noise, and one sample that stands out."""
    k = np.arange(1_000_003)
    x = 0.2 + 1e-3 * np.sin(k / 5e4) + 1e-5 * np.random.default_rng(3).normal(size=len(k))
    x[345_678] = 0.25
    return x


@pytest.fixture(scope="module")
def levels(signal, tmp_path_factory):
    path = tmp_path_factory.mktemp("levels") / "blob"
    short = np.arange(40.0)
    runs = [Run("a", "", 1000.0, {"command": signal, "displacement": -signal}), Run("b", "", 1.0, {"command": short})]
    with path.open("wb") as file:
        write_levels(runs, file)
    return Levels(path)


@pytest.mark.parametrize("stretch", [(0, 1_000_003), (300_000, 400_000), (345_000, 346_000), (345_670, 345_690)])
def test_one_sample_that_stands_out_is_seen_at_every_level(levels, signal, stretch):
    """Where it is, to a part of the panel; lowest and highest are those of the samples; and few points say so."""
    numbers, values = levels.envelope("a", "command", *stretch, BINS)
    part = signal[slice(*stretch)]
    assert values.max() == pytest.approx(0.25, rel=1e-7)
    assert abs(numbers[np.argmax(values)] - 345_678) <= max(len(part) / BINS, 0.5)
    assert values.min() == pytest.approx(part.min(), abs=1e-8)
    assert (np.diff(numbers) >= 0).all()
    assert (numbers[0], numbers[-1], len(numbers) <= 2 * BINS + 4) == (stretch[0], stretch[1] - 1, True)
    lowest, _ = levels.envelope("a", "displacement", *stretch, BINS)
    assert len(lowest) == len(numbers)


def test_each_part_has_the_extremes_of_its_samples(levels, signal):
    """Of all samples, in 61 bins of 16³ each part is a bin or so wide; against the samples themselves."""
    numbers, values = levels.envelope("a", "command", 0, len(signal), 61)
    for first in range(0, 240):
        part = signal[first * FACTOR**3 : (first + 1) * FACTOR**3]
        inside = values[(numbers >= first * FACTOR**3) & (numbers < (first + 1) * FACTOR**3)]
        assert not len(inside) or (inside.min() >= part.min() - 1e-8 and inside.max() <= part.max() + 1e-8)


def test_samples_are_kept_to_seven_digits_of_their_range(levels, signal):
    np.testing.assert_allclose(levels.samples("a", "command"), signal, atol=1.2e-7 * np.ptp(signal), rtol=0)
    assert levels.length("a") == len(signal)
    np.testing.assert_allclose(levels.samples("b", "command"), np.arange(40.0), atol=1e-5)


def test_channels_that_runs_share_are_written_once_and_levels_are_small():
    shared = np.random.default_rng(1).normal(size=TOP * FACTOR**2)
    alone, both = BytesIO(), BytesIO()
    write_levels([Run("a", "", 1.0, {"command": shared})], alone)
    write_levels([Run("a", "", 1.0, {"command": shared}), Run("b", "", 1.0, {"command": shared})], both)
    assert len(both.getvalue()) - len(alone.getvalue()) < 100
    assert len(alone.getvalue()) < 4 * len(shared) * (1 + 2.2 / (FACTOR - 1)) + 1000


def test_a_file_that_holds_no_levels_is_refused(tmp_path):
    (tmp_path / "x").write_bytes(b"matrix.yaml and others")
    with pytest.raises(ValueError, match="holds no levels"):
        Levels(tmp_path / "x").length("a")
