"""Errors by condition, parameters that follow one, and what the error is made of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.comparison.compare import compare
from ident.matrix import Matrix
from ident.residuals.breakdown import breakdown, in_bands, noise_in_bands
from ident.residuals.budget import budget
from ident.residuals.survey import survey
from tests.residuals.conftest import compared


def test_the_bands_of_a_run_add_up_to_its_error():
    """Quadratically, and every run has as many bands."""
    found = breakdown(compared("dead_zone"))
    for run in found.runs:
        assert len(run.bands) == len(found.edges) - 1
        assert np.sqrt(sum(band**2 for band in run.bands if band)) == pytest.approx(run.error, rel=1e-3)


def test_white_noise_is_once_the_noise_in_every_band():
    """A residual of white noise alone, over the share of its floor that each band has; the shares add up as squares."""
    base = compared("dead_zone", 0.0)
    edges, floor, random = (0.0, 5.0, 50.0, 500.0, 2048.0), 0.02, np.random.default_rng(3)
    one = base.runs[0]
    measured = one.modelled + floor * np.std(one.modelled) * random.standard_normal(one.run.length)
    noisy = replace(one, run=replace(one.run, channels={**one.run.channels, "displacement": measured}))
    shares = noise_in_bands(noisy.run, floor, edges)
    assert np.hypot.reduce(shares) == pytest.approx(floor, rel=1e-9)
    ratios = np.divide(in_bands(noisy, edges), shares)
    assert ratios[1:] == pytest.approx([1.0, 1.0, 1.0], abs=0.15)


def test_a_dead_zone_shows_at_small_amplitudes():
    """The error of the smallest amplitude is the largest."""
    errors = [group.error for group in breakdown(compared("dead_zone")).groups if group.by == "amplitude"]
    assert len(errors) == 3
    assert errors[0] > 2 * errors[-1]


def test_an_asymmetry_shows_in_the_direction_of_motion():
    """The mean residual has opposite signs in the two directions, or the parts differ."""
    found = {group.label: group for group in breakdown(compared("coulomb_friction")).groups if group.by == "direction"}
    assert found["positive"].mean < -0.003 < 0.003 < found["negative"].mean


def test_parameters_follow_the_amplitude_where_a_dead_zone_is_hidden():
    """The gain seems to grow with amplitude, beyond chance; without an effect nothing is clear."""
    trends = {(t.parameter, t.condition): t for t in survey(compared("dead_zone")).trends}
    gain = trends["Z0", "amplitude"]
    assert gain.clear
    assert gain.points[0].value < gain.points[-1].value < 2.6e-6
    assert not [t for t in survey(compared("dead_zone", 0.0)).trends if t.clear]


@pytest.mark.parametrize(
    ("name", "strength", "changed", "part"),
    [
        pytest.param("coulomb_friction", None, {"all_amplitudes": True}, "nonlinear", marks=pytest.mark.full),
        ("dead_zone", 0.0, {"tau": 4.6e-3}, "linear"),
        ("dead_zone", 0.0, {}, "noise"),
    ],
)
def test_the_budget_names_what_was_put_in(name, strength, changed, part):
    """Dry friction is nonlinear, a wrong lag linear, noise noise; the parts add up quadratically."""
    base = compared(name, strength, **changed)
    found = budget(base)
    parts = {"noise": found.noise, "linear": found.linear, "nonlinear": found.nonlinear}
    assert max(parts, key=parts.get) == part
    assert parts[part] > 0.8 * found.error
    assert found.error == pytest.approx(base.error["fit"], rel=1e-6)
    assert found.noise == pytest.approx(0.005, rel=0.1)
    for of, (lower, upper) in found.bounds.items():
        assert lower - 1e-12 <= parts[of] <= upper + 1e-12


def test_one_random_record_does_not_tell_noise_from_nonlinearity_and_says_so():
    """Bounds apart, and a repeat is asked for."""
    base = compared("dead_zone")
    found = budget(replace(base, runs=base.runs[:1]))
    assert found.bounds["noise"][1] > 2 * found.bounds["noise"][0]
    assert any("Repeat one run" in note for note in found.notes)
    assert any("at two amplitudes" in note for note in found.notes)


def test_a_repeat_measures_the_noise_also_where_it_lives_in_the_band():
    """Coloured noise that no spectrum shows: without a repeat it is nonlinear, with one it is noise."""
    base = compared("dead_zone", 0.0)
    run = base.matrix.of_use("fit")[0]
    random = np.random.default_rng(8)

    def noisy(name):
        coloured = np.convolve(random.standard_normal(run.length), np.ones(80), mode="same")
        moved = run.measured + 0.02 * np.std(run.measured) * coloured / np.std(coloured)
        return replace(run, id=name, channels={**run.channels, "displacement": moved})

    once = Matrix(base.matrix.actuator, (noisy("a"),))
    twice = Matrix(base.matrix.actuator, (noisy("a"), noisy("b")))
    alone, repeated = budget(compare(once, base.fit)), budget(compare(twice, base.fit))
    assert alone.nonlinear > 0.015
    assert repeated.noise == pytest.approx(0.02, rel=0.15)
    assert repeated.bounds["noise"][0] == repeated.bounds["noise"][1]
    assert repeated.nonlinear < 0.007
