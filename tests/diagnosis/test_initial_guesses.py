"""The lines of a gain that pulsates, found in what a fitted model leaves, by their frequency."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.diagnosis import initial_guesses as guesses
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.free_shapes import trial_from_everywhere
from ident.diagnosis.initial_guesses import initial_guesses, spectral_lines, strength_in_model
from ident.diagnosis.screening import _trials, predict
from ident.effects.elastic_load import ELASTIC_LOAD
from ident.effects.end_stop import END_STOP
from ident.fit.settings import Settings
from ident.run import Run
from tests.blind.various import Various

SECONDS, BAND = 8.0, 2 * np.pi * 40.0  # rad/s


def base(rate: float, pulsations: dict[float, float], seed: int = 1) -> Any:
    """A refit that leaves of x′, of 64 lines up to the band, shares that pulsate, Hz by their size: in closed form."""
    t, rng = np.arange(round(SECONDS * rate)) / rate, np.random.default_rng(seed)
    x, left = np.zeros_like(t), np.zeros_like(t)
    for f, angle in zip(rng.integers(8, 320, 64) / SECONDS, rng.uniform(0, 2 * np.pi, 64), strict=True):
        x += np.sin(2 * np.pi * f * t + angle) / (2 * np.pi * f)
        for beat, size in pulsations.items():  # cos a · cos b has half a line at the sum and half at the difference
            for at in (f + beat, f - beat):
                if at:
                    left += 0.5 * size * np.sin(2 * np.pi * at * t + angle) / (2 * np.pi * at)
    run = Run("run", "", rate, {"command": x, "displacement": x + left})
    fitness = SimpleNamespace(runs=(run,), band=BAND, outputs=lambda _point: {"run": x})
    return SimpleNamespace(fitness=fitness, point=None)


@pytest.mark.parametrize("rate", [200.0, 4096.0])
def test_pulsations_are_found_clearest_first_whatever_the_sample_rate(rate):
    """Far more samples than the band needs, and hardly any."""
    found = spectral_lines(base(rate, {11.0: 0.02, 4.5: 0.01}), 0.5, 100.0)
    assert found[:2] == pytest.approx([11.0, 4.5], abs=0.5 / SECONDS)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.4, 0.5])
def test_a_pulsation_is_found_to_an_eighth_of_what_the_record_resolves(share):
    """Wherever it lies between two lines of the spectrum."""
    pulsation = (88.0 + share) / SECONDS
    assert spectral_lines(base(400.0, {pulsation: 0.02}), 0.5, 100.0)[0] == pytest.approx(pulsation, abs=0.13 / SECONDS)


def test_the_lines_of_what_does_not_pulsate_are_the_same_at_every_sample_rate():
    """Of a residual like any other: with too few samples the upper half of the product would fold onto the lower."""
    found = []
    for rate in (400.0, 1024.0, 4096.0):
        known, other = base(rate, {}), base(rate, {}, seed=2)
        (run,), (apart,) = known.fitness.runs, other.fitness.runs
        channels = {**run.channels, "displacement": run.measured + 0.01 * apart.measured}
        known.fitness.runs = (replace(run, channels=channels),)
        found.append(spectral_lines(known, 0.5, 100.0))
    assert found[1:] == [pytest.approx(found[0])] * 2


def test_a_stop_that_gives_way_lies_before_the_end_of_the_way():
    """Where the way ends nothing tells of a stop; without a record of the way its range is tried."""
    space: Any = SimpleNamespace(reach=lambda *_: (0.0, 1000.0), names=(), fixed={}, scale_free=True)
    models: Any = SimpleNamespace(effects={"end_stop": END_STOP}, strength=lambda _: "g")
    x = 0.02 * np.sin(np.arange(100.0))
    run = Run("run", "", 100.0, {"displacement": x})
    base: Any = SimpleNamespace(fitness=SimpleNamespace(runs=(run,)))
    ways = [1.0 / trial.strength for trial in _trials(models, base, space, "end_stop", {})]
    assert 0.5 * 0.02 < min(ways) < 0.7 * 0.02
    assert 0.9 * 0.02 < max(ways) < 0.02
    base.fitness.runs = (replace(run, channels={"velocity": x}),)
    assert len({trial.strength for trial in _trials(models, base, space, "end_stop", {})}) > len(ways)


def test_a_part_behind_a_spring_begins_below_the_resonance_of_the_record():
    """ω √(1 − μ) of a record that rings at 40 rad/s, by the part μ of the mass, within the bounds of the search."""
    rate, omega, damping = 200.0, 40.0, 0.1
    t, u = np.arange(2000) / rate, np.repeat(np.random.default_rng(3).uniform(-1, 1, 50), 40)
    steps = [(k / rate, step) for k, step in enumerate(np.diff(u, prepend=0.0)) if step]
    y = sum(
        step * np.where(t > at, 1 - np.exp(-damping * omega * (t - at)) * np.cos(omega * (t - at)), 0.0)
        for at, step in steps
    )
    run = Run("run", "", rate, {"command": u, "velocity": y}, output="velocity", hold="zoh")
    name = "elastic_load__frequency"
    space: Any = SimpleNamespace(names=(name,), bounds=lambda _: {name: (1.0, 35.0)})
    fitness = SimpleNamespace(runs=(run,), band=BAND, outputs=lambda _point: {"run": np.zeros_like(y)})
    found = initial_guesses(SimpleNamespace(fitness=fitness, point=None), ELASTIC_LOAD, space, {})
    shares = np.array(CRITERIA.initial_guesses.hanging_shares)
    below = [one[name] for one in found[: len(shares)]]
    assert below == pytest.approx(np.minimum(omega * np.sqrt(1 - shares), 35.0), rel=0.02)
    assert len(shares) < len(found) <= len(shares) + 2  # and where the residual is large beside it


def test_an_edge_is_looked_for_at_the_top_of_the_model_where_its_zero_is_not_that_of_the_gauge():
    """The tanks were fitted 6 m and more below their gauge: from an edge at the highest reading no refit arrives."""
    models = CandidateModels.of(Various.drawn(168294, True).measured(), Settings(model="two_tanks"))
    base = models.refit((), {"gain": 0.5011, "tau1": 0.2346, "tau2": 0.0366})
    assert min(base.zeros.values()) > 6.0
    top = max(float(run.measured.max()) - base.zeros[run.id] for run in base.fitness.runs)
    assert strength_in_model(base, models.effects["overflow"]) == pytest.approx(1.0 / top)
    (prediction,) = predict(models, base, ["overflow"])
    assert trial_from_everywhere(models, base, prediction).local.error < 0.02


@pytest.mark.parametrize("other", [6.0, 25.0])
def test_what_swings_beside_the_machine_is_seen_in_the_residual(other, monkeypatch):
    """Below its resonance or above, with a damping ratio of 0.03, though the residual at the resonance is larger."""
    known, rate = 12.0, 100.0
    monkeypatch.setattr(guesses, "resonance", lambda _runs: known)
    rng, left = np.random.default_rng(3), np.zeros(4000)
    for frequency, size in ((known, 2.0), (other, 1.0)):
        pole = np.exp((-0.03 + 1j) * frequency / rate)
        swing = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], rng.standard_normal(len(left)))
        left += size * swing / swing.std()
    x = 10.0 * rng.standard_normal(len(left))
    run = Run("run", "", rate, {"command": x, "displacement": x + left})
    fitness = SimpleNamespace(runs=(run,), band=BAND, outputs=lambda _point: {"run": x})
    found: Any = SimpleNamespace(fitness=fitness, point=None)
    begun = [other] if other < known else [other, other * np.sqrt(1 - 0.4)]  # the drive moving, and standing
    assert guesses._away_from_resonance(found) == pytest.approx(begun, rel=0.08)
    monkeypatch.setattr(guesses, "resonance", lambda _runs: None)
    assert guesses._away_from_resonance(found) == []
