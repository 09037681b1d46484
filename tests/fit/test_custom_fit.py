"""A user's own effect, written as a small file, finds what the independent reference hides."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from ident.comparison.compare import compare
from ident.custom.definition import definition_of, read_effect
from ident.diagnosis.candidate_models import CandidateModels
from ident.errors import Unusable
from ident.fit.identification import Identification
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run, Specimen
from ident.workflows import identify
from tests.fit.recovery import NOISE, matrix
from tests.reference import drifting_reference, qian_reference
from tests.short_form import short_form

SECONDS, EVERY = 0.5, 6
OVERLAP = """
name: overlap
place: spool
equation: w = sign(w) * max(abs(w) - h, 0)
strength: {symbol: h, unit: mm, lower: 0, upper: 1}
meaning: the lands overlap
"""
CHURNING = """
name: churning
place: load
equation: R + c2 * v * abs(v)
strength: {symbol: c2, unit: N*s^2/m^2, lower: 0, upper: 5e4}
meaning: resistance with the square of the speed
"""
SAG = """
name: sag
place: flow
equation: Q = Q * (1 - d * z)
strength: {symbol: d, unit: s/m^3, lower: 0, upper: 1e4}
shape: {T: 100 ms}
state: {symbol: z, rate: (abs(Q * (1 - d * z)) - z) / T, initial: 0}
meaning: the supply follows the flow with a lag
"""
RIPPLE = """
name: ripple
place: flow
equation: Q = Q * (1 + rp * sin(2 * pi * fp * t))
strength: {symbol: rp, unit: "%", lower: 0, upper: 50}
shape: {fp: 37 Hz}
meaning: the pump's pulses
"""
WARMING = """
name: warming
place: flow
equation: Q = Q * (1 - d * t)
strength: {symbol: d, unit: 1/min, lower: -60, upper: 60}
meaning: the gain falls as the oil warms
"""
SUPPLIED = """
name: supplied
place: flow
equation: Q = Q * (1 + s * (supply_pressure / 20e6 - 1))
strength: {symbol: s, unit: 1, lower: 0, upper: 2}
meaning: the flow follows the pressure that was measured at the supply
"""
OPENING = """
name: opening
place: flow
equation: Q = Q * (1 + s * h)
strength: {symbol: s, unit: 1, lower: 0, upper: 2}
curve: {symbol: h, of: supply_pressure, knots: [16 MPa, 18 MPa, 20 MPa, 24 MPa], values: [1, 0.5, 0, -0.5],
        unit: 1, lower: -2, upper: 2}
meaning: the flow hangs on the supply by a curve
"""


def supply(t):
    """A pressure that rises and falls by 3.8 MPa."""
    return 20e6 + 3.8e6 * np.sin(2 * np.pi * 9 * t)


def drifting(gain, seed: int = 3) -> Matrix:
    """Some runs of the paper's matrix with a gain that changes with time, 0.5 % noise, and the supply beside it."""
    rng = np.random.default_rng(seed)
    trials = qian_reference.trials()[::EVERY]
    n = round(SECONDS * qian_reference.SAMPLE_RATE)
    commands = np.array([qian_reference.band_limited_noise(n, trial.amplitude, rng) for trial in trials])
    clean = drifting_reference.displacements(qian_reference.Plant(), [t.cell for t in trials], commands, gain)
    noisy = clean + NOISE * clean.std(axis=1, keepdims=True) * rng.standard_normal(clean.shape)
    pressure = supply(np.arange(n) / qian_reference.SAMPLE_RATE)
    runs = tuple(
        Run(
            t.id,
            "",
            qian_reference.SAMPLE_RATE,
            {"command": u, "displacement": x, "supply_pressure": pressure},
            specimen=Specimen(t.cell.mass, t.cell.stiffness, t.cell.damping),
            gain=t.cell.gain,
            kind="blwn",
            use=t.use,
        )
        for t, u, x in zip(trials, commands, noisy, strict=True)
    )
    return Matrix(Actuator("REFERENCE-1", piston_area=qian_reference.Plant().A), runs)


def of_catalogue(name: str, strength: float) -> Matrix:
    return matrix(name, strength, seed=5, seconds=SECONDS, every=EVERY)


HIDDEN = {
    "overlap": (OVERLAP, "h", 2e-4, lambda: of_catalogue("dead_zone", 2e-4)),
    "churning": (CHURNING, "c2", 2e4, lambda: of_catalogue("quadratic_damping", 2e4)),
    "sag": (SAG, "d", 3e3, lambda: of_catalogue("supply_droop", 3e3)),
    "ripple": (RIPPLE, "rp", 0.1, lambda: drifting(lambda t: 1 + 0.1 * np.sin(2 * np.pi * 37 * t))),
    "warming": (WARMING, "d", 0.4, lambda: drifting(lambda t: 1 - 0.4 * t)),
    "supplied": (SUPPLIED, "s", 0.6, lambda: drifting(lambda t: 1 + 0.6 * (supply(t) / 20e6 - 1))),
}


def settings(text: str) -> Settings:
    own = definition_of(text)
    return Settings(effects=(own["name"],), custom=(own,), seed=4)


@pytest.fixture(scope="module")
def overlap() -> tuple[Matrix, FitResult]:
    """The dead zone's data and the fit of the user's overlap to it."""
    data = HIDDEN["overlap"][3]()
    return data, identify(data, settings(OVERLAP))


@pytest.mark.parametrize("name", short_form(HIDDEN, "overlap", "supplied"))
def test_an_own_effect_finds_its_strength(name, overlap):
    """Within 5 %, the error at the floor: a dead zone, damping, a supply with a state or measured, ripple, drift."""
    text, symbol, truth, data = HIDDEN[name]
    found = overlap[1] if name == "overlap" else identify(data(), settings(text))
    assert found.values[f"{name}.{symbol}"] == pytest.approx(truth, rel=0.05)
    assert found.error["fit"] < 1.05 * NOISE


@pytest.mark.full
def test_a_fit_with_an_own_effect_goes_on_after_a_restart(overlap):
    """Settings and state through JSON, each generation in a new process: the same parameters, bit for bit."""
    data, whole = overlap
    kept = Settings.from_json(json.loads(json.dumps(settings(OVERLAP).to_json())))
    state = Identification(data, kept).start()
    while not Identification(data, kept).finished(state):
        state = json.loads(json.dumps(Identification(data, kept).advance(state, 20)))
    assert Identification(data, kept).finish(state).values == whole.values


def test_a_stored_fit_knows_its_own_effect(overlap):
    """The JSON of a fit alone is enough to compare it with the data."""
    data, found = overlap
    again = compare(data, FitResult.from_json(json.loads(json.dumps(found.to_json()))))
    assert again.error["fit"] == pytest.approx(found.error["fit"], rel=1e-6)


def test_a_value_of_a_curve_is_found_with_the_strength():
    """Of a kinked gain over the measured supply: both within 5 %, the error at the floor."""
    data = drifting(lambda t: 1 + 0.4 * np.interp(supply(t) / 1e6, [16, 18, 20, 24], [1, 0.1, 0, -0.5]))
    found = identify(data, replace(settings(OPENING), bounds={"opening.h_2": (-2.0, 2.0)}))
    assert found.values["opening.s"] == pytest.approx(0.4, rel=0.05)
    assert found.values["opening.h_2"] == pytest.approx(0.1, abs=0.05)
    assert found.error["fit"] < 1.05 * NOISE


def test_a_run_without_the_channel_is_refused_and_a_diagnosis_ranks_what_it_can():
    """In one line that names the run, before anything is fitted; the same where the channel is to be shown."""
    data = drifting(np.ones_like)
    first, *others = data.runs
    bare = replace(first, channels={name: first.channels[name] for name in ("command", "displacement")})
    with pytest.raises(
        Unusable, match=rf"run {bare.id}: no supply_pressure channel, which an effect of the model reads"
    ):
        Identification(replace(data, runs=(bare, *others)), settings(SUPPLIED))
    shown = replace(first, output="supply_pressure")
    with pytest.raises(Unusable, match="supply_pressure is what the model has to show"):
        Identification(replace(data, runs=(shown, *others)), settings(SUPPLIED))
    effect = read_effect(SUPPLIED)
    ranked = [
        CandidateModels.of(replace(data, runs=runs), Settings(), (effect,)).effects
        for runs in (data.runs, (bare, *others))
    ]
    assert [effect.name in known for known in ranked] == [True, False]
