"""A damper that slides at another force each way, and a mass, by the two forces that a verdict has."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.sentences import slip_sentence
from ident.diagnosis.slip_forces import slip_forces
from ident.effects import effect
from ident.fit.result import TransducerOffset

FRICTION, PLAY, LOAD, SPRING = map(
    effect, ("coulomb_friction", "friction_behind_play", "static_load", "cubic_stiffness")
)


def model(offset: float | None = None, error: float = 1.0, **values: float) -> Any:
    """A refit with effects of these strengths, and what the transducer of the force reads above it, N."""
    names = {name: effect(name).added[0].name for name in values}
    found = {names[name]: ParameterEstimate(value, "N", error, "F") for name, value in values.items()}
    above = {} if offset is None else {"force": TransducerOffset(offset, "N", error)}
    return SimpleNamespace(parameters=found, transducer_offset=above)


def test_a_force_with_an_offset_is_that_of_friction_which_differs_each_way():
    found = slip_forces(model(-2.2e3, 100.0, friction_behind_play=15.8e3), [PLAY])
    assert found is not None
    assert (found.forward, found.backward) == pytest.approx((13.6e3, 18.0e3))
    (said,) = slip_sentence(found)
    assert said == (
        "Friction of 13.60 kN forwards and 18.00 kN backwards is the same to these data as friction of 15.80 kN with a "
        "constant force of 2200 N."
    )


def test_a_load_that_pushes_forward_is_less_friction_forward():
    found = slip_forces(model(coulomb_friction=20.0, static_load=5.0), [FRICTION, LOAD])
    assert found is not None
    assert (found.forward, found.backward) == pytest.approx((15.0, 25.0))


@pytest.mark.parametrize("strengths", [{"coulomb_friction": 20.0}, {"static_load": 5.0}, {"cubic_stiffness": 3.0}])
def test_friction_alone_and_a_load_alone_have_one_reading(strengths):
    assert slip_forces(model(**strengths), [FRICTION, LOAD, SPRING]) is None


def test_a_constant_force_within_two_of_its_standard_errors_is_none():
    assert slip_forces(model(1.9, 1.0, coulomb_friction=20.0), [FRICTION]) is None
    assert slip_forces(model(2.1, 1.0, coulomb_friction=20.0), [FRICTION]) is not None


def test_a_constant_force_as_large_as_the_friction_is_no_part_of_it():
    assert slip_forces(model(25.0, 1.0, coulomb_friction=20.0), [FRICTION]) is None
