"""What the command predicts of a residual: nothing of coloured noise, a part of a missing effect."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.diagnosis.evidence import model_error
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.model_error import predicted_share

N = 3000
COLOURS = {
    "white": ([1.0], [1.0]), "brown": ([1.0], [1.0, -0.99]), "ringing": ([1.0], [1.0, -1.9 * np.cos(0.3), 0.9]),
}  # fmt: skip


def moved(rng: np.random.Generator, n: int = N) -> tuple[np.ndarray, np.ndarray]:
    """A command and the output of a machine with a lag of forty samples."""
    u = lfilter([0.1], [1.0, -0.9], rng.standard_normal(n))
    return u, lfilter([1 / 40], [1.0, -1 + 1 / 40], u)


def noise(rng: np.random.Generator, colour: str, n: int = N) -> np.ndarray:
    """Noise of a colour, of a deviation of one."""
    found = lfilter(*COLOURS[colour], rng.standard_normal(n))
    return found / found.std()


@pytest.mark.parametrize("colour", COLOURS)
def test_noise_of_any_colour_is_predicted_no_more_often_than_by_chance(colour):
    """Twenty seeds, of which chance passes one; four have a probability of 1.6 %."""
    passed = 0
    for seed in range(20):
        rng = np.random.default_rng([31, seed])
        u, y = moved(rng)
        passed += predicted_share([noise(rng, colour)], [u], [y]).above(0.0, EVIDENCE_CRITERIA)
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
    found = predicted_share([effect + noise(rng, colour)], [u], [y])
    assert found.above(0.0, EVIDENCE_CRITERIA)


def test_several_runs_of_different_lengths_are_predicted_together():
    rng = np.random.default_rng(33)
    runs = [moved(rng, n) for n in (700, 1100, 900)]
    residuals = [0.7 * y**2 / y.var() + noise(rng, "white", len(y)) for _, y in runs]
    assert predicted_share(residuals, *zip(*runs, strict=True)).above(0.0, EVIDENCE_CRITERIA)


@pytest.mark.parametrize("residual", [np.zeros(400), np.full(400, 0.3), np.zeros(3)])
def test_nothing_is_predicted_of_a_residual_that_does_not_move(residual):
    u, y = moved(np.random.default_rng(34), len(residual))
    assert not predicted_share([residual], [u], [y]).above(0.0, EVIDENCE_CRITERIA)


def test_a_command_and_an_output_that_do_not_move_predict_nothing():
    rng, still = np.random.default_rng(35), np.ones(500)
    assert not predicted_share([noise(rng, "white", 500)], [still], [still]).above(0.0, EVIDENCE_CRITERIA)


def test_long_records_are_averaged_to_twenty_thousand_samples(monkeypatch):
    """Of 25,000 samples two make one, of 19,000 one; the first 32 have no whole past."""
    lengths: list[int] = []
    monkeypatch.setattr(model_error, "_most_likely_penalty", lambda _, e: lengths.append(len(e)) or 1.0)
    monkeypatch.setattr(model_error, "_features", lambda u, *_: [u])
    rng = np.random.default_rng(36)
    for n in (19_000, 25_000):
        predicted_share([rng.standard_normal(n)], [rng.standard_normal(n)], [np.zeros(n)])
    assert lengths == [19_000, 19_000 - 32, 12_500, 12_500 - 32]
