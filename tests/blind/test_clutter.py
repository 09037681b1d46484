"""Blind trials with clutter, and with an effect left out of the catalogue: what is hidden is what they say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.fit.settings import Settings
from tests.blind.clutter import OUTSIDE, Cluttered, said
from tests.blind.left_out import Secret, without
from tests.blind.machines import Machine
from tests.blind.table import cluttered
from tests.reference import qian_reference as linear
from tests.reference.outside_reference import X

PLANT = linear.Plant()


def test_what_clutters_from_outside_is_what_its_name_says():
    """A recorder that bends or drifts adds the same to the same motion; a valve's temperature is each run's own."""
    still = Cluttered(PLANT, {}, 0.0, True, 3)

    def records(**outside):
        runs = replace(still, outside=outside).measured(seconds=0.1, every=9).runs
        return [run.measured for run in runs]

    clean = records()
    t = np.arange(len(clean[0])) / linear.SAMPLE_RATE
    for x, bent, drifting in zip(clean, records(bent_recorder=0.1), records(drifting_recorder=0.2), strict=True):
        np.testing.assert_allclose(bent, x + 0.1 * x**2 / X, atol=1e-12)
        np.testing.assert_allclose(drifting, x + 0.2 * X * t, atol=1e-12)
    warm = records(valve_temperature=0.05)
    shares = [(other @ x) / (x @ x) - 1 for x, other in zip(clean, warm, strict=True)]
    assert max(shares) > 0.005
    assert min(shares) < -0.005
    assert set(OUTSIDE) == {"valve_temperature", "bent_recorder", "drifting_recorder"}


def test_a_trial_with_clutter_tells_the_strong_one_and_names_of_no_class():
    hidden = ("backlash", "lead")
    grouped = {"found": ["dead_zone", "lead"], "groups": [["dead_zone", "backlash"]]}
    assert said(grouped, hidden) == {"named": True, "clean": True}
    assert said({"found": ["lead", "null_bias"], "groups": []}, hidden) == {"named": False, "clean": False}
    four = {"found": ["dead_zone"], "groups": [["dead_zone", "null_bias", "underlap", "backlash"]]}
    assert said(four, hidden) == {"named": False, "clean": True}
    row = {"kind": "clutter", "matrix": "small", "oracle": 1.0, "verify": 1.2, "named": True, "clean": False}
    (line,) = list(cluttered([row]))[2:]
    assert line.startswith("| small | 1 of 1 | 100.0 (2-100) | 0 of 1 | 0.0 (0-98) | 0 of 1 |")


def test_an_effect_that_is_left_out_is_in_no_model_and_comes_back():
    machine = Machine(PLANT, {"backlash": 1e-4}, 0.01, True, 1)
    matrix = Secret(machine).measured(machine.trials[:2], 0.0)
    linear_ones = Secret(replace(machine, hidden={})).measured(machine.trials[:2], 0.0)
    assert not np.allclose(matrix.runs[0].measured, linear_ones.runs[0].measured, atol=1e-7)
    with without("backlash"):
        assert "backlash" not in CandidateModels.of(matrix, Settings()).effects
    assert "backlash" in CandidateModels.of(matrix, Settings()).effects
