"""A diagnosis takes bounds of parameters of effects that it may add, in every way of asking for it."""

from __future__ import annotations

import pytest

from ident.errors import Unusable
from ident.fit.choices import settings_of
from ident.fit.parameter_bounds import of_model, with_candidates, with_candidates_given
from ident.fit.settings import Settings
from ident.presets import preset
from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.diagnosis.damper import Damper

WAY = "presliding_friction.displacement"


@pytest.fixture(scope="module")
def fit():
    """What is fitted of a damper without friction in the model."""
    return identify(Damper().matrix(), model="specimen")


@pytest.fixture
def few_frictions(monkeypatch):
    """Rank four effects, whose kernels are compiled soon."""
    few = ("coulomb_friction", "presliding_friction", "quadratic_damping", "cubic_stiffness")
    rank_only(monkeypatch, few)


@pytest.mark.full
@pytest.mark.usefixtures("few_frictions")
def test_bounds_hold_for_every_effect_that_is_tried(fit):
    """The strength of each stays within what is given for it, the friction of 45 N or not."""
    bounds = {WAY: ("1 um", "10 mm"), "presliding_friction.force": (0.0, "40 N"), "coulomb_friction": (0.0, 20.0)}
    found = diagnose(Damper().matrix(), fit, bounds=bounds, propose=False)
    of = {one.effect: one.parameters for one in found.candidates}
    assert of["presliding_friction"]["presliding_friction.force"].value == pytest.approx(40.0)
    assert of["coulomb_friction"]["coulomb_friction.force"].value == pytest.approx(20.0)
    assert found.settings["bounds"][WAY] == pytest.approx((1e-6, 1e-2))
    again = identify(Damper().matrix(), start=found)  # what of them belongs to no effect of the model stays unused
    assert again.parameters["presliding_friction.force"].upper == pytest.approx(40.0)


def test_with_a_fit_its_own_parameters_are_refused(fit):
    with pytest.raises(Unusable, match="the fit has cS, which was searched already"):
        with_candidates_given(fit, {"cS": (1.0, 1e4)})


def test_a_name_that_no_effect_has_is_refused_with_the_nearest(fit):
    with pytest.raises(Unusable, match=r"presliding_friction\.displacment.*presliding_friction\.displacement"):
        with_candidates_given(fit, {"presliding_friction.displacment": (1e-6, 1e-2)})


def test_an_effect_that_the_model_has_no_place_for_is_refused(fit):
    with pytest.raises(Unusable, match="dead_zone"):
        with_candidates_given(fit, {"dead_zone": (0.0, 1e-3)})


def test_a_fit_alone_refuses_what_it_would_not_use():
    """A forgotten --effect is no silence."""
    with pytest.raises(Unusable, match=r"no parameter 'presliding_friction\.displacement'"):
        settings_of({"model": "specimen", "bounds": {WAY: (1e-6, 1e-2)}})
    assert settings_of({"model": "specimen", "bounds": {WAY: (1e-6, 1e-2)}}, candidates=True).bounds[WAY]


def test_a_users_own_effect_is_bounded_too():
    own = {
        "name": "drag",
        "place": "load",
        "equation": "R = R + c * v * abs(v)",
        "strength": {"symbol": "c", "unit": "N*s^2/m^2", "lower": 0, "upper": 1e3},
    }
    model = with_candidates(preset("specimen"), ("drag",), (own,))
    assert model.parameter("drag").name == "drag.c"
    settings = Settings("specimen", custom=(own,), bounds={"drag": (0.0, 1.0), "cS": (1.0, 2.0)})
    assert of_model(settings, preset("specimen")).bounds == {"cS": (1.0, 2.0)}
