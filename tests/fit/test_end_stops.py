"""A cylinder in open loop goes to its ends, and its transducer counts from wherever it was mounted."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.initial_guesses import strength_in_records
from ident.diagnosis.screening import predict
from ident.effects import effect
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.preprocessing import prepare
from ident.presets import preset
from ident.run import Run
from ident.workflows import compare, diagnose, identify

RATE, GAIN, LAG = 100.0, 0.5, 0.08
LOW, HIGH = 1.2, 1.7  # m, where the stops stand


def cylinder(low: float = LOW, high: float = HIGH, stops: bool = True) -> Matrix:
    """LAG q̇ + q = GAIN u, ẋ = q between two stops, exact between samples; from one end to the other and back."""
    runs = []
    for number, size in enumerate((0.5, 0.8, 0.65)):
        t = np.arange(int(8 * RATE)) / RATE
        u = np.where((t > 0.3) & (t < 3.5), size, np.where((t > 4.0) & (t < 7.2), -size, 0.0))
        decay, x, q, place = np.exp(-1 / RATE / LAG), np.zeros(len(u)), 0.0, low
        x[0] = place
        for k in range(len(u) - 1):
            target = GAIN * u[k]
            place += target / RATE + (q - target) * LAG * (1 - decay)
            q = target + (q - target) * decay
            if stops and not low <= place <= high:
                place, q = float(np.clip(place, low, high)), 0.0
            x[k + 1] = place
        x += 2e-4 * np.random.default_rng(number).standard_normal(len(u))
        channels, units = {"command": u, "displacement": x}, {"command": "V", "displacement": "m"}
        use = "verify" if number == 2 else "fit"
        runs.append(Run(f"{size:g}", "", RATE, channels, units, hold="zoh", use=use))
    return Matrix(Actuator("CYLINDER"), tuple(runs))


@cache
def stopped() -> FitResult:
    """The fit of a motor with stops to it."""
    return identify(cylinder(), Settings(model="motor", effects=("end_stop",)))


def test_stops_at_both_ends_are_found_wherever_the_transducer_has_its_zero():
    """A symmetric stop about the transducer's zero meets one of them at most."""
    fit = stopped()
    assert fit.parameters["end_stop.middle"].value == pytest.approx((LOW + HIGH) / 2, abs=2e-3)
    assert 1.0 / fit.parameters["end_stop.inverse_way"].value == pytest.approx((HIGH - LOW) / 2, abs=5e-3)
    assert fit.error["fit"] < 0.02
    assert fit.error["verify"] < 0.02
    assert identify(cylinder(), Settings(model="motor")).error["fit"] > 0.2


@pytest.mark.parametrize("low", [-0.3, -0.05])
def test_where_nothing_stops_a_machine_its_zero_is_the_middle_where_it_was_covered(low):
    model, _ = prepare(preset("motor").with_effects((effect("end_stop"),)), cylinder(low, 0.2, stops=False))
    assert model.parameter("end_stop.middle").value == 0.0


def test_the_middle_goes_with_the_fit_to_runs_that_cover_another_way():
    """What was found of the machine holds for its other records: the middle is a value of the fit, not of the data."""
    fit = stopped()
    part = cylinder().runs[0].part(0, int(2 * RATE))
    found = compare(Matrix(Actuator("CYLINDER"), (part,)), fit)
    assert found.runs[0].error < 0.02


def test_a_fit_of_stops_that_knew_no_middle_can_be_read_and_has_it_at_zero():
    matrix = cylinder(-0.25, 0.25)
    fixed = {**stopped().values, "end_stop.middle": 0.0}  # the same machine, its transducer mounted in the middle
    fit = identify(matrix, Settings(model="motor", effects=("end_stop",), fixed=fixed))
    assert fit.error["fit"] < 0.02
    data = fit.to_json()
    del data["parameters"]["end_stop.middle"]
    found = compare(matrix, FitResult.from_json(data))
    assert [run.error for run in found.runs] == pytest.approx([run.error for run in compare(matrix, fit).runs])


@pytest.mark.parametrize(
    ("low", "high", "middle"),
    [(500.0, 500.5, 500.25), (-0.3, 0.2, -0.05), (-0.05, 0.45, 0.2), (LOW, HIGH, 1.45), (-1.7, -1.2, -1.45)],
)
def test_the_middle_of_a_stroke_is_that_of_the_way_between_stops_wherever_the_zero_lies(low, high, middle):
    model, _ = prepare(preset("motor").with_effects((effect("end_stop"),)), cylinder(low, high))
    found = model.parameter("end_stop.middle")
    assert found.value == pytest.approx(middle, abs=2e-3)
    family = CandidateModels.of(cylinder(low, high), Settings(model="motor"))
    assert family.model(("end_stop",)).parameter("end_stop.middle").value == found.value


def test_a_diagnosis_begins_with_stops_where_the_way_ended():
    """Of strengths along the range none was near: a motor was left with what sticks in their place."""
    models = CandidateModels.of(cylinder(), Settings(model="motor"))
    base = models.refit((), {p.in_equations: p.value for p in models.preset.parameters})
    stop, lag = (models.effects[name] for name in ("end_stop", "sensor_lag"))
    assert strength_in_records(base, stop) == pytest.approx(2 / (HIGH - LOW), rel=0.01)
    assert strength_in_records(base, lag) is None
    (promise,) = predict(models, base, ["end_stop"])
    begun = {round(start["end_stop__inverse_way"] * (HIGH - LOW) / 2, 2) for start in promise.starts}
    assert 1.0 in begun


def test_stops_are_found_by_a_diagnosis(full):
    if not full:  # where a search for them begins is seen above
        pytest.skip("ten seconds: run with --full")
    matrix = cylinder()
    found = diagnose(matrix, identify(matrix, Settings(model="motor")), most=1, propose=False)
    assert found.verdict.effects == ("end_stop",)
    assert found.ladder[-1].error["verify"] < 0.02
