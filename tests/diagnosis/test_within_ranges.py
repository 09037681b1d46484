"""A mass that was fitted far beyond its range makes up for an effect: that is looked for from within the range, too."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis import ranking
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.screening import PredictedFit, Prediction
from ident.fit.settings import Settings
from ident.fit.wider_bounds import within_ranges
from ident.matrix import Actuator, Matrix
from ident.run import Run


def drive(**settings) -> CandidateModels:
    """The models of a mass that a force moves."""
    force = np.random.default_rng(1).standard_normal(500)
    channels = {"command": force, "displacement": np.cumsum(np.cumsum(force)) * 1e-4}
    run = Run("a", "", 100.0, channels, {"command": "N", "displacement": "m"}, hold="zoh")
    return CandidateModels.of(Matrix(Actuator("A"), (run,)), Settings(model="drive", **settings))


def test_a_mass_beyond_its_range_is_moved_to_the_end_of_the_range():
    fitness = drive().fitness(())
    middle = {name: float(v[0]) for name, v in fitness.space.values(np.full((1, 3), 0.5)).items()}
    most = fitness.space.bounds(middle)["m0"][1]
    assert within_ranges(fitness, middle, ()) is None
    inside = within_ranges(fitness, {**middle, "m0": 30.0 * most}, ())
    assert inside is not None
    assert inside["m0"] == pytest.approx(most, rel=1e-9)
    assert within_ranges(fitness, {**middle, "m0": 30.0 * most}, ("m0",)) is None


def fit(error: float) -> PredictedFit:
    return PredictedFit(error=error, offset=0.0, score=error)


def test_an_effect_is_predicted_from_where_it_promises_more(monkeypatch):
    """Friction from within the range, a delay from the fitted model; both fall short of the error of that model."""
    base, inside = SimpleNamespace(name="base"), SimpleNamespace(name="inside")
    errors = {"base": {"friction": 0.4, "delay": 0.2}, "inside": {"friction": 0.1, "delay": 0.5}}

    def predict(_models, of, names):
        before = fit(0.42 if of is base else 0.7)
        return [Prediction(name, fit(errors[of.name][name]), before, 1, ({"from": of.name},)) for name in names]

    monkeypatch.setattr(ranking, "predict", predict)
    monkeypatch.setattr(ranking, "_within_ranges", lambda _models, _base: inside)
    friction, delay = ranking._predicted(None, base, ["friction", "delay"])
    assert (friction.after.error, friction.starts[0]["from"]) == (0.1, "inside")
    assert (delay.after.error, delay.starts[0]["from"]) == (0.2, "base")
    assert [one.before.error for one in (friction, delay)] == [0.42, 0.42]
