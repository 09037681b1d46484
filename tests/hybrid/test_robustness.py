"""A controller on the actuators that a fit leaves possible."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.errors import Unusable
from ident.fit.result import Estimate
from ident.fit.settings import Settings
from ident.hybrid.controller_design import design_controller
from ident.hybrid.linear_plant import linear_plant
from ident.hybrid.parameter_samples import drawn_parameters
from ident.run import Specimen
from ident.workflows import identify
from tests.acceptance.matrices import as_matrix, records_of
from tests.hybrid.designs import RATE, decibel, degrees, matrices
from tests.reference import controlled_loop_reference as reference

SPECIMEN = Specimen(8.75, 17.5e3)
CASE = {"sample_rate": RATE, "gain": 2.0, "piston_area": reference.AREA}


@pytest.fixture(scope="module")
def fit(full):
    """A fit of the 63 runs at 0.5 % noise: 30 s each in the full form, 1 s in the short one."""
    runs = [record for record in records_of(30.0 if full else 1.0, "linear") if record.trial.use == "fit"]
    assert len(runs) == 63
    return identify(as_matrix(runs, "linear"), Settings(seed=1))


@pytest.mark.full
def test_draws_from_the_covariance_of_a_fit_are_followed(fit):
    """With a path forward ≥ 95 of 100 draws stay stable and within ± 1 dB, ± 10° to 25 Hz; the reference agrees."""
    made = design_controller(fit, SPECIMEN, structure="two-degree", **CASE)
    assert made.robustness.draws == 100
    assert made.robustness.stable >= 95
    assert made.robustness.within >= 95
    draws = drawn_parameters(fit)
    for i in range(3):
        values = {**fit.values, **{name: values[i] for name, values in draws.items()}}
        plant = reference.servo_loop(8.75, 17.5e3, 2.0, values=values)
        f, T, _, _ = reference.responses(plant, matrices(made.design.controller), 1, seconds=2)
        assert np.abs(decibel(T))[f <= 25].max() <= 1.0
        assert np.abs(degrees(T))[f <= 25].max() <= 10.0


def test_draws_scatter_as_the_fit_says(fit):
    """Mean, standard errors and correlations of 20,000 draws are those of the fit."""
    draws = drawn_parameters(fit, 20_000, seed=4)
    assert set(draws) == set(fit.parameters)
    for name, values in draws.items():
        error = fit.parameters[name].std_error
        assert values.mean() == pytest.approx(fit.values[name], abs=0.05 * error)
        assert values.std() == pytest.approx(error, rel=0.05)
    found = np.corrcoef(draws["Z0"], draws["c0"])[0, 1]
    assert found == pytest.approx(fit.correlation["Z0"]["c0"], abs=0.03)


def test_a_fit_that_knows_little_is_told_so(fit):
    """Standard errors a hundred times as large: fewer draws are within the limits, and some loops may be lost."""
    vague = replace(
        fit,
        parameters={name: replace(one, std_error=0.3 * one.value) for name, one in fit.parameters.items()},
        correlation={},
    )
    made = design_controller(vague, SPECIMEN, structure="two-degree", **CASE)
    assert made.robustness.within < 95


def test_a_loop_with_little_margin_is_told(fit):
    """With eight samples of delay it is stable, and the design says how near the end that is."""
    made = design_controller(fit, SPECIMEN, delay=8, draws=5, **CASE)
    assert made.design.loop.stable
    assert "leaves little margin" in made.notes[0]
    assert not design_controller(fit, SPECIMEN, draws=5, **CASE).notes


def test_without_standard_errors_nothing_is_claimed(fit):
    """No count of draws, and a note that says why."""
    bare = replace(fit, parameters={name: replace(one, std_error=None) for name, one in fit.parameters.items()})
    made = design_controller(bare, SPECIMEN, structure="two-degree", **CASE)
    assert made.robustness is None
    assert "no standard errors" in made.notes[0]
    assert "robustness" not in made.to_json()["design"]


def with_effect(fit, effect, **values):
    """The fit with an effect of the catalogue at these values."""
    added = {f"{effect}.{name}": Estimate(value, "", None, 0.0, 1.0, at_bound=False) for name, value in values.items()}
    return replace(fit, effects=(effect,), parameters={**fit.parameters, **added})


def test_linear_effects_are_part_of_the_plant_and_others_are_named(fit):
    """A sensor's lag changes the plant as the reference has it; a dead zone is left out, and the design says so."""
    plain = linear_plant(fit, SPECIMEN, 2.0, reference.AREA)
    f = np.array([1.0, 10.0, 30.0])
    lagged = linear_plant(with_effect(fit, "sensor_lag", time_constant=2e-3), SPECIMEN, 2.0, reference.AREA)
    A, B, C = reference.servo_loop(8.75, 17.5e3, 2.0, values=fit.values)
    n, T = len(A), 2e-3  # y' = (x - y)/T stands in the loop in place of x
    system = np.block([[A, np.zeros((n, 1))], [C[None, :] / T, np.array([[-1 / T]])]])
    back = A[0, 3]  # what the valve takes of x
    system[0, 3], system[0, n] = 0.0, back / C[3]
    inside = np.linalg.solve(2j * np.pi * f[:, None, None] * np.eye(n + 1) - system, np.append(B, 0.0)[None, :, None])
    assert lagged.model.frequency_response(f) == pytest.approx(inside[:, n, 0], rel=1e-6)
    dead = with_effect(fit, "dead_zone", half_width=1e-4, skew=0.0)
    made = design_controller(dead, SPECIMEN, draws=5, **CASE)
    assert made.notes[0] == "designed on the linear part of the model, without dead_zone"
    assert made.design.plant.frequency_response(f) == pytest.approx(plain.model.frequency_response(f), rel=1e-9)


@pytest.mark.parametrize(
    ("effect", "values", "factor"),
    [
        ("acquisition_lag", {"time_constant": 2e-3}, lambda s: 1 / (1 + 2e-3 * s)),
        ("command_delay", {"delay": 3e-3}, lambda s: np.exp(-3e-3 * s)),
    ],
)
def test_what_is_late_outside_the_loop_multiplies_the_response(fit, effect, values, factor):
    """A lag exactly, a delay as its approximant of second order: to 1e-4 at 30 Hz."""
    f = np.array([1.0, 10.0, 30.0])
    plain = linear_plant(fit, SPECIMEN, 2.0, reference.AREA).model.frequency_response(f)
    late = linear_plant(with_effect(fit, effect, **values), SPECIMEN, 2.0, reference.AREA).model.frequency_response(f)
    assert late == pytest.approx(plain * factor(2j * np.pi * f), rel=2e-4)


def test_a_valve_of_second_order_is_part_of_the_plant(fit):
    """q behind 1/(Tn² s² + 2 ζ Tn s + 1): the loop of the reference with that factor in it."""
    Tn, zeta, f = 2e-3, 0.6, np.array([1.0, 10.0, 30.0])
    found = linear_plant(
        with_effect(fit, "valve_second_order", inverse_frequency=Tn, damping=zeta), SPECIMEN, 2.0, reference.AREA
    ).model.frequency_response(f)
    A, B, C = reference.servo_loop(8.75, 17.5e3, 2.0, values=fit.values)
    s = 2j * np.pi * f
    closed = np.array([C @ np.linalg.solve(one * np.eye(4) - A, B) for one in s])
    opened = closed / (1 - closed)
    slower = opened / (Tn**2 * s**2 + 2 * zeta * Tn * s + 1)
    assert found == pytest.approx(slower / (1 + slower), rel=1e-6)


def test_a_fit_in_absolute_terms_needs_the_area(fit):
    """Without it every response would be wrong by orders of magnitude: it is asked for."""
    with pytest.raises(Unusable, match="piston_area"):
        design_controller(fit, SPECIMEN, sample_rate=RATE, gain=2.0)


def test_a_fit_of_ratios_needs_none(fit):
    """Z0/A², Ka/A² and Cl/A² make the same plant."""
    area, ratios = reference.AREA, {"Z0": "Z0/A^2", "Ka": "Ka/A^2", "Cl": "Cl/A^2"}
    scaled = {
        ratios.get(name, name): replace(one, value=one.value / area**2) if name in ratios else one
        for name, one in fit.parameters.items()
    }
    f = np.array([0.5, 5.0, 50.0])
    found = linear_plant(replace(fit, parameters=scaled), SPECIMEN, 2.0, None).model.frequency_response(f)
    assert found == pytest.approx(linear_plant(fit, SPECIMEN, 2.0, area).model.frequency_response(f), rel=1e-9)


def test_a_model_without_a_displacement_that_a_command_moves_is_refused(fit):
    """The drive of a motor has no position loop to design for."""
    with pytest.raises(Unusable, match="no command that moves a displacement"):
        design_controller(replace(fit, model="kononykhin", parameters={}), SPECIMEN, **CASE)
