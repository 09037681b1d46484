"""Each number about the offset of a transducer decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.fit import normal_matrices, transducer
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.transducer import Offset, offset_of


@pytest.mark.parametrize(
    ("share", "determined", "told"), [(0.0085, False, False), (0.0115, False, True), (0.0085, True, True)]
)
def test_an_offset_is_told_by_the_samples_that_no_first_state_explains(share, determined, told):
    """A hundredth of them, or where it is determined a millionth: fewer are rounding."""
    run: Any = SimpleNamespace(informing=share, length=1, _offset_determined=determined)
    assert NormalMatrices.tells_offset(run, 1e-6) is told
    for least, grouped in ((0.85e-6, False), (1.15e-6, True)):
        one: Any = SimpleNamespace(transducer="x", informing=least, length=1)
        assert bool(transducer._by_transducer([one], [True])) is grouped


@pytest.mark.parametrize(("share", "told"), [(0.85e-4, False), (1.15e-4, True)])
def test_the_offset_of_a_speed_is_told_by_a_ten_thousandth_of_the_samples(monkeypatch, share, told):
    monkeypatch.setattr(normal_matrices, "normal_matrices_of", lambda *_: ["without"])
    found: Any = SimpleNamespace(
        release=np.ones(1),
        informing=share,
        length=1,
        _offset_determined=True,
        begun_at_zero=lambda: np.zeros((1, 1, 1)),
        remove=np.zeros((2, 2)),
    )
    found.tells_offset = lambda least: NormalMatrices.tells_offset(found, least)
    run: Any = SimpleNamespace(output="velocity")
    assert (normal_matrices._separated(run, found) is found) is told


@pytest.mark.parametrize(("errors", "counts"), [(2.6, False), (3.4, True)])
def test_an_offset_counts_beyond_three_standard_errors(errors, counts):
    assert Offset(errors, 1.0).counts is counts


@pytest.mark.parametrize(("change", "rounds"), [(0.1, 200), (1.15e-13, 200), (0.85e-13, 1)])
def test_the_means_of_runs_are_reweighted_until_nothing_changes(monkeypatch, change, rounds):
    """Two runs whose weights change the offset by so much in each round, up and down."""
    asked: list[float] = []

    def weight(run: Any, b: float) -> float:
        asked.append(b)
        up = change * (len(asked) // 2 % 2 if run.means[-1] else (len(asked) + 1) // 2 % 2)
        return float(0.5 + (up if run.means[-1] else -up))

    monkeypatch.setattr(transducer, "_weight", weight)
    nothing = SimpleNamespace(std_error=np.inf, value=0.0, share=lambda *_: 0.0)
    monkeypatch.setattr(transducer, "_Prior", SimpleNamespace(of=lambda _: nothing))
    offset_of([SimpleNamespace(means=np.array([mean])) for mean in (0.0, 1.0)])
    assert len(asked) == 2 * rounds
