"""What a refit says is what a simulation leaves, also of runs that begin in motion."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis.family import Refit

MEASURED = np.sin(np.arange(1000) / 50.0)


def refit(begins: str, left: float, promised: float = 0.1) -> Refit:
    """A refit that promises an error on one run, and whose simulation leaves another."""
    run = SimpleNamespace(id="a", begins=begins, measured=MEASURED, share=1.0)
    fitness = SimpleNamespace(
        runs=(run,),
        matrix=SimpleNamespace(of_use=lambda _use: (run,)),
        outputs=lambda _point: {"a": MEASURED * (1.0 - left)},
        left=lambda run, output: (run.measured - output) - (run.measured - output).mean(),
    )
    fitness.fresh = lambda _runs: fitness
    here = SimpleNamespace(error=promised, runs=(SimpleNamespace(error=promised, share=1.0),))
    return Refit((), {}, None, np.zeros(1), here, fitness)


@pytest.mark.parametrize(
    ("begins", "left", "finite"),
    [("moving", 0.11, True), ("moving", 0.2, False), ("moving", np.inf, False), ("at rest", 0.2, True)],
)
def test_what_no_first_state_leads_to_is_no_refit(begins, left, finite):
    """The correction of first states is linear: a model that is not may look good where no state leads."""
    found = refit(begins, left)
    assert found.stable
    with np.errstate(invalid="ignore"):
        assert found.finite is finite


def test_the_error_on_runs_to_verify_is_what_a_simulation_leaves_there():
    assert refit("moving", 0.3).on_verify == pytest.approx(0.3, rel=1e-6)
