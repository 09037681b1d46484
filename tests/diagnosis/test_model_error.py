"""What the command predicts of a residual: nothing of coloured noise, a part of a missing effect."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.diagnosis.evidence import model_error
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.model_error import predicted_share
from tests.short_form import short_form

N = 3000
COLOURS = {
    "white": ([1.0], [1.0]),
    "brown": ([1.0], [1.0, -0.99]),
    "ringing": ([1.0], [1.0, -1.9 * np.cos(0.3), 0.9]),
}


def moved(rng: np.random.Generator, n: int = N) -> tuple[np.ndarray, np.ndarray]:
    """A command and the output of a machine with a lag of forty samples."""
    u = lfilter([0.1], [1.0, -0.9], rng.standard_normal(n))
    return u, lfilter([1 / 40], [1.0, -1 + 1 / 40], u)


def noise(rng: np.random.Generator, colour: str, n: int = N) -> np.ndarray:
    """Noise of a colour, of a deviation of one."""
    found = lfilter(*COLOURS[colour], rng.standard_normal(n))
    return found / found.std()


@pytest.mark.parametrize("colour", short_form(COLOURS, "white", "brown"))
def test_noise_of_any_colour_is_predicted_no_more_often_than_by_chance(colour):
    """Twenty seeds, of which chance passes one; four have a probability of 1.6 %."""
    passed = 0
    for seed in range(20):
        rng = np.random.default_rng([31, seed])
        u, y = moved(rng)
        passed += predicted_share([noise(rng, colour)], [[u]], [y]).above(0.0, EVIDENCE_CRITERIA)
    assert passed <= 3


def missing_effect(name: str, u: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The waveform of an effect, before the lag through which it acts."""
    if name == "dry friction":
        return np.sign(np.gradient(y))
    if name == "a square":
        return y**2
    return np.roll(u, 3) - u if name == "a delay" else np.clip(u, -0.3 * u.std(), 0.3 * u.std())


@pytest.mark.parametrize("missing", ["dry friction", "a square", "a delay", "a dead zone"])
@pytest.mark.parametrize("colour", ["white", "ringing"])
def test_an_effect_that_is_missing_is_predicted_of_a_residual_that_is_mostly_noise(missing, colour):
    """It acts through a lag and is half as large as the noise."""
    rng = np.random.default_rng([32, len(missing)])
    u, y = moved(rng)
    effect = lfilter([0.1], [1.0, -0.9], missing_effect(missing, u, y))
    effect *= 0.5 / effect.std()
    found = predicted_share([effect + noise(rng, colour)], [[u]], [y])
    assert found.above(0.0, EVIDENCE_CRITERIA)


def test_several_runs_of_different_lengths_are_predicted_together():
    rng = np.random.default_rng(33)
    runs = [moved(rng, n) for n in (300, 2600, 900)]
    residuals = [0.7 * y**2 / y.var() + noise(rng, "white", len(y)) for _, y in runs]
    assert predicted_share(residuals, [[u] for u, _ in runs], [y for _, y in runs]).above(0.0, EVIDENCE_CRITERIA)


def test_an_effect_that_is_as_large_as_the_level_of_an_input_is_predicted_from_several_runs():
    """Friction of a seal at four pressures, of which the model has the mean."""
    rng = np.random.default_rng(38)
    residuals, inputs, outputs = [], [], []
    for level in (-1.5, -0.5, 0.5, 1.5):
        u, y = moved(rng, 800)
        residuals.append(0.5 * level * np.sign(np.gradient(y)) + noise(rng, "white", 800))
        inputs.append([u, np.full(800, 5.0 + level)])
        outputs.append(y)
    assert predicted_share(residuals, inputs, outputs).above(0.01, EVIDENCE_CRITERIA)


def test_an_effect_of_a_second_input_is_predicted_where_it_is_given():
    rng = np.random.default_rng(37)
    u, y = moved(rng)
    pressure = lfilter([0.01], [1.0, -0.99], rng.standard_normal(N))
    residual = [noise(rng, "white") + 0.5 * pressure / pressure.std() * np.sign(np.gradient(y))]
    assert predicted_share(residual, [[u, pressure]], [y]).above(0.01, EVIDENCE_CRITERIA)
    assert not predicted_share(residual, [[u]], [y]).above(0.01, EVIDENCE_CRITERIA)


@pytest.mark.parametrize("residual", [np.zeros(400), np.full(400, 0.3), np.zeros(3)])
def test_nothing_is_predicted_of_a_residual_that_does_not_move(residual):
    u, y = moved(np.random.default_rng(34), len(residual))
    assert not predicted_share([residual], [[u]], [y]).above(0.0, EVIDENCE_CRITERIA)


def test_a_command_and_an_output_that_do_not_move_predict_nothing():
    rng, still = np.random.default_rng(35), np.ones(500)
    assert not predicted_share([noise(rng, "white", 500)], [[still]], [still]).above(0.0, EVIDENCE_CRITERIA)


def test_long_records_are_shortened_to_twenty_thousand_samples(monkeypatch):
    """Of 25,000 samples two make one, or two thirds of each of twelve stretches stand for it where the band is wide.

    The first 32 samples of a part have no whole past.
    """
    lengths: list[int] = []
    monkeypatch.setattr(model_error, "_most_likely", lambda _, e: lengths.append(len(e)) or (np.zeros(1), 1.0))
    monkeypatch.setattr(model_error, "_features", lambda moving, *_: [moving[0]])
    rng = np.random.default_rng(36)
    for n, most_averaged in ((19_000, 9), (25_000, 9), (30_000, 1)):
        predicted_share([rng.standard_normal(n)], [[rng.standard_normal(n)]], [np.zeros(n)], most_averaged)
    assert lengths[:4] == [19_000, 19_000 - 32, 12_500, 12_500 - 32]
    assert lengths[4:] == [1666] * 12 + [12 * (1666 - 32)]
