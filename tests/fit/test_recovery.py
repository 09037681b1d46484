"""A hidden effect in the reference's data is found with its strength, and the error falls to the noise."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ident.effects import EFFECTS, effect
from tests.fit.recovery import NOISE, Recovery, recovery

SEED = 1


@pytest.mark.full
@pytest.mark.parametrize("name", [effect.name for effect in EFFECTS])
def test_a_hidden_effect_is_recovered(name):
    """Within 3 %, or 3 standard errors where the data say less; 63 runs of 2 s, 0.5 % noise, position in 18 bits."""
    found = recovery(name, SEED)
    assert found.recovered
    assert found.fit.error["verify"] < 1.03 * NOISE * (1 if found.linear.error["verify"] > 1.1 * NOISE else 1.1)


@pytest.mark.parametrize(
    ("found", "std_error", "recovered"),
    [(1.02, None, True), (1.5, None, False), (1.5, 0.2, True), (1.5, 0.1, False), (-3.0, 0.0, False)],
)
def test_what_is_not_determined_is_not_recovered(found, std_error, recovered):
    """A strength without a standard error has to be right to 3 %, for nothing excuses it."""
    fit = SimpleNamespace(
        parameters={"dead_zone.half_width": SimpleNamespace(std_error=std_error)},
        values={"dead_zone.half_width": found},
    )
    dead_zone = effect("dead_zone")
    assert dead_zone.strength.name == "half_width"
    assert Recovery(dead_zone, 1.0, fit, fit).recovered is recovered
