"""Fields of a stored matrix, of this version and of earlier ones.

The service asks for oil as the library does: by all that is stated of the actuator, kept with the matrix.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from app.fits.service import settings_of
from app.matrices.service import summary, view
from app.pages.start_view import start_view
from ident.matrix import Actuator
from schemas.fit import Chosen
from schemas.matrix import MatrixView
from tests.presets.test_position_servo import servo

STATED = ({"piston_area": 1e-3}, {"supply_pressure": 2e7}, {"servo_valve": "D765"}, {"volume": 1e-4})


def stored(*without: str, **stated) -> MatrixView:
    """An angle that follows an angle, as the database keeps it; what an earlier version did not write is left out."""
    kept = summary(replace(servo(1), actuator=Actuator("A", **stated)))
    return view(
        SimpleNamespace(
            id="m",
            serial="A",
            parent=None,
            created_at="",
            batch="",
            removed_at=None,
            piston_area=stated.get("piston_area"),
            summary={name: value for name, value in kept.items() if name not in without},
        )
    )


@pytest.mark.parametrize("stated", STATED, ids=lambda stated: next(iter(stated)))
def test_a_part_with_oil_makes_it_a_cylinder(stated):
    matrix = stored(**stated)
    assert settings_of(Chosen(effects=["dead_zone"]), matrix).model == "qian2014"
    assert start_view(matrix).models[0].name == "qian2014"


def test_without_one_it_is_an_electric_servo():
    matrix = stored(stroke=0.1)
    assert settings_of(Chosen(effects=["dead_zone"]), matrix).model == "position_servo"
    assert start_view(matrix).models[0].name == "position_servo"


def test_a_matrix_of_an_earlier_version_has_oil_where_its_area_is_stated():
    assert stored("states_oil", piston_area=1e-3).states_oil
    assert not stored("states_oil", supply_pressure=2e7).states_oil
