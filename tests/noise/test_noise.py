"""The noise floor of runs: told by the spectrum where the noise is white, by repeats where it is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.fit.reduction import excited_band
from ident.noise.floor import noise_floors
from ident.noise.repeats import repeated
from ident.run import Run
from tests.blind.machines import Machine
from tests.blind.noises import with_noise
from tests.reference import qian_reference as linear
from tests.short_form import short_form

SHARE = 0.01


@pytest.fixture(scope="module")
def clean():
    """Twelve runs without noise, two seconds each."""
    return Machine(linear.Plant(), {}, 0.0, small=True, seed=31).measured(every=3)


def floors(matrix, **options):
    """The floors by run."""
    return noise_floors(matrix.runs, excited_band(matrix.of_use("fit")), **options).by_run


def test_white_noise_is_told_by_the_spectrum():
    matrix = Machine(linear.Plant(), {}, SHARE, small=True, seed=31).measured(every=3)
    assert list(floors(matrix).values()) == pytest.approx([SHARE] * len(matrix.runs), rel=0.1)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_noise_in_the_band_is_told_by_repeats_alone(clean, seed):
    assert max(floors(with_noise(clean, "low_passed", SHARE, seed=seed)).values()) < 0.15 * SHARE
    found = floors(with_noise(clean, "low_passed", SHARE, seed=seed, repeats=3))
    assert len(found) == len(clean.runs) + 3
    assert list(found.values()) == pytest.approx([SHARE] * len(found), rel=0.1)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_noise_of_a_transducer_weighs_more_in_a_small_record(clean, seed):
    matrix = with_noise(clean, "low_passed", SHARE, seed=seed, repeats=3, absolute=True)
    size = SHARE * np.std(clean.runs[0].measured)
    expected = {run.id: size / np.std(run.measured) for run in matrix.runs}
    assert max(expected.values()) > 1.2 * min(expected.values())
    assert floors(matrix) == pytest.approx(expected, rel=0.1)


def test_repeats_tell_where_the_command_fills_the_spectrum(clean):
    """With so low a sample rate nothing of the spectrum is the noise's alone."""
    band = np.pi * linear.SAMPLE_RATE
    once, twice = (with_noise(clean, "low_passed", SHARE, seed=4, repeats=repeats) for repeats in (0, 2))
    assert noise_floors(once.runs, band).of_use(once) == {"fit": None, "verify": None}
    assert [noise_floors(of.runs, band).in_band for of in (once, twice)] == [False, True]
    told = noise_floors(twice.runs, band).by_run
    size = np.mean([SHARE * np.std(run.measured) for run in twice.runs[:4]])
    assert told == pytest.approx({run.id: size / np.std(run.measured) for run in twice.runs}, rel=0.15)


@pytest.mark.parametrize("kind", short_form(["low_passed", "pink"], "pink"))
def test_floors_from_a_repeat_scatter_as_they_say(clean, kind):
    """Not much less, so that a fit is not called short of them by chance, and not much more."""
    off = []
    for seed in range(40):
        matrix = with_noise(clean, kind, SHARE, seed, repeats=1)
        found = noise_floors(matrix.runs, excited_band(matrix.of_use("fit")))
        off.append((found.by_run[matrix.runs[0].id] / SHARE - 1.0) / np.sqrt(0.5 / found.degrees_of_freedom))
    assert np.std(off) == pytest.approx(0.9, abs=0.5)
    assert found.spread(10_000) > np.sqrt(0.5 / found.degrees_of_freedom)


def test_a_pair_with_a_run_that_is_not_trusted_tells_nothing(clean):
    """Where one of two has another specimen than is stated, what does not repeat is no noise."""
    matrix = with_noise(clean, "low_passed", SHARE, seed=5, repeats=1)
    wrong = replace(matrix.runs[1], channels={**matrix.runs[1].channels, "displacement": matrix.runs[5].measured})
    matrix = replace(matrix, runs=(matrix.runs[0], wrong, *matrix.runs[2:]))
    assert max(floors(matrix).values()) > 0.1
    assert max(floors(matrix, left_out={wrong.id}).values()) < 0.15 * SHARE


def test_repeats_are_measurements_of_one_command_at_the_same_conditions(clean):
    first, second, *_ = with_noise(clean, "low_passed", SHARE, seed=6, repeats=1).runs
    assert repeated([first, second]) == [(first, second, 0)]
    assert repeated([first, replace(first, id="copy")]) == []
    assert repeated([first, replace(second, gain=2.0 * second.Kp)]) == []
    assert repeated([first, replace(second, use="verify")]) == []
    unstated = [replace(run, specimen=None, gain=None) for run in (first, second)]
    assert repeated(unstated) == [(*unstated, 0)]  # what tells them apart no model can know
    louder = {**second.channels, "command": 1.01 * second.command}
    assert repeated([first, replace(second, channels=louder)]) == []
    later = {name: samples[: second.length // 2] for name, samples in second.channels.items()}
    assert repeated([first, replace(second, channels=later)]) == []


def test_of_steps_those_to_one_level_from_one_place_are_repeats():
    """A command that stands still has no shape that would tell two steps apart: its level and the start do."""
    rng = np.random.default_rng(4)

    def step(name: str, level: float, start: float = 0.0) -> Run:
        went = level + (start - level) * np.exp(-0.05 * np.arange(400)) + 1e-4 * rng.standard_normal(400)
        channels = {"command": np.full(400, level), "displacement": went}
        return Run(name, "", 50.0, channels, {"command": "m", "displacement": "m"})

    one, again, other, back = step("one", 0.1), step("again", 0.1), step("other", 0.35), step("back", 0.1, 0.3)
    fall, still = step("fall", 0.0, 0.3), step("still", 0.0)
    assert repeated([one, again, other, back, fall, still]) == [(one, again, 0)]
