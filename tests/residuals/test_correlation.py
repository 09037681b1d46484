"""The residual's correlations are those of the definition, and their bands hold what chance does."""

from __future__ import annotations

import numpy as np
import pytest

from ident.comparison.compare import RunComparison
from ident.errors import Unusable
from ident.residuals.correlation import correlation
from ident.run import Run

N, LAGS = 2000, 20


def residual(e, u, lags=LAGS):
    """Of a model that answers nothing to a record of e."""
    run = Run("a", "", 1000.0, {"command": u, "displacement": e})
    return correlation(RunComparison(run, None, np.zeros(len(e))), lags)


def by_definition(e, u, k):
    e, u = e - e.mean(), u - u.mean()
    pairs = [(e[t + k], u[t]) for t in range(len(e)) if 0 <= t + k < len(e)]
    return sum(a * b for a, b in pairs) / np.sqrt(np.sum(e**2) * np.sum(u**2))


def test_both_are_the_sums_of_their_definition():
    rng = np.random.default_rng(0)
    e, u = rng.standard_normal(200), rng.standard_normal(200)
    found = residual(e, u)
    np.testing.assert_allclose(found.auto.values, [by_definition(e, e, k) for k in range(LAGS + 1)], atol=1e-12)
    expected = [by_definition(e, u, k) for k in range(-LAGS, LAGS + 1)]
    np.testing.assert_allclose(found.cross.values, expected, atol=1e-12)


def coloured(rng, pole):
    """First-order noise, which a residual and a command often are."""
    out, white = np.zeros(N), rng.standard_normal(N)
    for t in range(1, N):
        out[t] = pole * out[t - 1] + white[t]
    return out


def test_a_percent_of_what_chance_alone_makes_lies_outside():
    """Of white residuals with themselves; with the command also where both are slow, where a plain band is wrong."""
    rng = np.random.default_rng(1)
    auto = [residual(rng.standard_normal(N), rng.standard_normal(N)).auto.outside for _ in range(100)]
    cross = [residual(coloured(rng, 0.9), coloured(rng, 0.9)).cross for _ in range(60)]
    assert 0.004 < np.mean(auto) < 0.018
    assert 0.002 < np.mean([one.outside for one in cross]) < 0.03
    assert np.mean([one.band for one in cross]) > 2 * 2.576 / np.sqrt(N)


def test_dynamics_that_the_model_lacks_show_after_the_command_and_only_there():
    rng = np.random.default_rng(2)
    u = rng.standard_normal(N)
    found = residual(0.3 * np.roll(u, 5) + rng.standard_normal(N), u).cross
    outside = found.lags[np.abs(found.values) > found.band]
    assert 5 in outside
    assert found.lags[np.argmax(np.abs(found.values))] == 5


def test_lags_beyond_half_the_record_are_refused():
    with pytest.raises(Unusable, match=r"1001 lags of 2000 samples.*give 1 to 1000"):
        residual(np.arange(N) % 7.0, np.arange(N) % 5.0, 1001)
