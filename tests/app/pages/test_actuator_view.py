"""The rows of the first page."""

from __future__ import annotations

from app.pages.actuator_view import actuator_row
from schemas.parameters import ActuatorView, ParameterSetView, ValueView


def test_the_row_of_an_actuator_lists_the_parameters_of_its_model_alone():
    """Its set also holds the acceptance sheet of a bench and the conditions of its test."""
    held = {"T": (0.02, "s"), "sheet.zero_shift": (-0.034, "1"), "condition.supply_pressure": (21e6, "Pa")}
    newest = ParameterSetView(
        id="1",
        serial="S",
        batch="",
        model="kononykhin",
        created_at="",
        approved_at=None,
        current=False,
        error_fit=0.02,
        error_verify=None,
        parameters={name: ValueView(value=value, unit=unit, std_error=None) for name, (value, unit) in held.items()},
    )
    actuator = ActuatorView(
        serial="S", name="", batch="", piston_area=None, created_at="", matrices=1, fits=1, current=None
    )
    assert actuator_row(actuator, newest, None).parameters == (("T", "20.00 ms"),)
