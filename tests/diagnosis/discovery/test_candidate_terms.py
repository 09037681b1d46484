"""Terms at places that multiply a rate, or that two readers share: the oil, and what the loop is told."""

from __future__ import annotations

import pytest

from ident.fit.settings import Settings
from ident.workflows import diagnose, identify
from tests.blind.machines import matrix_of
from tests.reference import nonlinear_reference as nonlinear
from tests.reference import qian_reference as linear

PLANT, NOISE = linear.Plant(), 0.005


@pytest.mark.full
@pytest.mark.parametrize(
    ("hidden", "equation", "true"),
    [
        ({"entrained_air.alpha": 1.5, "entrained_air.Pr": 1.5e6}, "Ke = Ke + s * (Ke * (1 / (1 + (P / h)**2)))", 1.5),
        ({"sensor_nonlinearity.s": 2e4}, "y_fb = y_fb + s * (x**3)", 2e4),
    ],
)
def test_the_oil_and_what_the_loop_reads_are_places_too(hidden, equation, true):
    """Air in the oil multiplies a rate; a transducer that is not linear misleads the loop besides the record.

    At loads that stay below the pressure where half of the air is gone, that and how much there is are hardly told
    apart.
    """
    trials = linear.trials()
    chosen = [trial for trial in trials if trial.use == "fit"][::6][:12] + trials[-3:]
    records = nonlinear.measure_all(
        nonlinear.named(hidden), chosen, plant=PLANT, seconds=0.5, noise=NOISE, seed=3, bits=None
    )
    matrix = matrix_of(records, PLANT)
    fit = identify(matrix, Settings(model="qian2014"))
    (term,) = diagnose(matrix, fit, most=0, propose=True).proposals
    assert term.equation == equation
    assert term.strength == pytest.approx(true, rel=0.06 if "x" in equation else 0.5)
    assert term.error["fit"] < 1.02 * NOISE
    assert term.error["verify"] < (1.05 if "x" in equation else 1.25) * NOISE
    assert term.meaning
