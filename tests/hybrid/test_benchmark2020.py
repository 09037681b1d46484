"""The benchmark problem of 2020 in the rig: its plant as a machine of stages, and J1 to J3, which are scores."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.hybrid.case import benchmark2020
from ident.hybrid.linear_plant import linear_plant
from ident.hybrid.loop_shaping import design
from ident.hybrid.rig import simulate_hybrid
from tests.hybrid.cases import el_centro, fitted

MODEL = (
    "machine:controller=p,valve=second,flow=linear,pressure=compressible,load=mass_spring_damper,sensor=displacement"
)
NOMINAL = {"a1b0": 2.1283e13, "a2": 4.2297e6, "a3": 3.3, "b1": 425.0, "b2": 9.9976e4}
STATIC_GAIN = {"sensor_gain": 0.0261}
SEED = 1


def plant(**changed):
    """A fit that found L = a1β0/(s² + β1 s + β2) · 1/((s + a3)(m s² + c s + k) + a2 s), the area 1 m²."""
    p = {**NOMINAL, **changed}
    stiff = np.sqrt(p["b2"])
    oil = {"Ka": 1 / p["a2"], "Cl": p["a3"] / p["a2"], "Z0": p["a1b0"] / p["b2"] / p["a2"]}
    return fitted(MODEL, wv=stiff, zv=p["b1"] / (2 * stiff), m0=1e-6, c0=1e-6, **oil)


def shaken(number):
    """A case under El Centro × 0.4, with the sensor's noise of 1 µm RMS."""
    case = benchmark2020(number)
    return replace(el_centro(case), piston_area=1.0)


def designed(case):
    """A controller with two degrees of freedom for the nominal plant, which does not know its static gain."""
    model = linear_plant(plant(), case.physical, case.gain, 1.0).model
    return design(model, case.sample_rate, structure="two-degree").controller


def test_the_plant_is_that_of_the_problem():
    """The machine's response is L/(1 + L), from the problem's own formula."""
    frequency = np.array([0.5, 2.0, 10.0, 30.0, 80.0])
    specimen, s = benchmark2020().physical, 2j * np.pi * frequency
    dynamic = specimen.mass * s**2 + specimen.damping * s + specimen.stiffness
    p = NOMINAL
    loop = p["a1b0"] / (s**2 + p["b1"] * s + p["b2"]) / ((s + p["a3"]) * dynamic + p["a2"] * s)
    found = linear_plant(plant(), specimen, 1.0, 1.0).model.frequency_response(frequency)
    assert np.allclose(found, loop / (1 + loop), rtol=1e-5)


@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_each_case_is_followed(number):
    """J1 at most 0.3 ms, J2 at most 1 %, J3 at most 1.5 %."""
    case = shaken(number)
    case = replace(case, ground=replace(case.ground, duration=None if number == 1 else 10.0))
    found = simulate_hybrid(plant(), case, designed(case), STATIC_GAIN)
    assert found.stable
    assert abs(found.scores.delay) <= 0.3e-3
    assert found.scores.tracking_rms <= 0.01
    assert found.scores.tracking_peak <= 0.015


def test_other_plants_than_the_controller_was_made_for(full):
    """Twenty drawn plants and frames (two cases of five in the short form): none unstable, mean J2 at most 3 %."""
    rng = np.random.default_rng(SEED)
    for number in (1, 2, 3, 4) if full else (1, 4):
        case = shaken(number)
        case = replace(case, ground=replace(case.ground, duration=None if full else 8.0))
        controller, scores = designed(case), []
        for _ in range(20 if full else 5):
            b1, b2, a3, k = rng.normal([425.0, 9.9976e4, 3.3, 1190e3], [3.3, 3300.0, 1.3, 50e3])
            other = replace(case, physical=replace(case.physical, stiffness=k))
            found = simulate_hybrid(plant(b1=b1, b2=b2, a3=max(a3, 0.1)), other, controller, STATIC_GAIN)
            assert found.stable
            scores.append(found.scores.tracking_rms)
        assert np.mean(scores) <= 0.03
