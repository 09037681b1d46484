"""Periodic tests by their seeds: machine, motion or command, noise, and what is hidden, as strong as is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tests.blind.periodic import CREEP, MACHINES, MOST, NOISE, PERIODS, SAMPLES, WORTH, Test, Wave
from tests.blind.periodic_candidates import CANDIDATES
from tests.blind.periodic_class import ALIKE, fits
from tests.blind.periodic_driven import Driven
from tests.reference.periodic_reference import Law


def drawn(seed: int, hidden: bool) -> Test:
    """A test by its seed; the strength of what is hidden is set afterwards, by what it is worth."""
    rng = np.random.default_rng([51, seed, hidden])
    machine = str(rng.choice(list(MACHINES)))
    kind = str(rng.choice(["sine", "triangle", "steps"]))
    samples = float(np.exp(rng.uniform(*np.log(SAMPLES))))
    samples = round(samples) if rng.integers(2) else np.floor(samples) + rng.uniform(0.1, 0.9)
    periods = int(min(np.exp(rng.uniform(*np.log(PERIODS))), MOST / samples))
    noise = float(np.exp(rng.uniform(*np.log(NOISE))))
    begins = "at rest" if machine == "motor" or rng.integers(2) else "moving"
    frequency, amplitude = 10 ** rng.uniform(-1, 1), 10 ** rng.uniform(-2.7, -1)
    corner = max(2.5 / samples, rng.uniform(0.02, 0.08))
    wave = Wave(kind, rng.uniform(-0.5, 0.5))
    if machine == "specimen":
        moving = 0.25 - corner if kind == "triangle" else rng.uniform(0.02, 0.1)
        wave = Wave(kind, moving, corner)
        if kind == "steps":
            wave = Wave(kind, moving, min(corner, 0.22 - moving), CREEP)
    amplitude = {"motor": 10 ** rng.uniform(-0.5, 1), "drive": 10 ** rng.uniform(0, 2.5)}.get(machine, amplitude)
    test = Test(
        seed,
        machine,
        wave,
        float(samples),
        periods,
        float(frequency),
        float(amplitude),
        str(rng.choice(["displacement", "velocity"])),
        begins,
        float(rng.uniform()),
        noise,
        _law(rng, machine, frequency, amplitude),
    )
    if not hidden:
        return test
    name = str(rng.choice(MACHINES[machine]))
    return replace(test, hidden=name, shapes=_shapes(rng, name))


def _law(rng: np.random.Generator, machine: str, frequency: float, amplitude: float) -> Law:
    """A machine that answers within a period or two."""
    w = 2 * np.pi * frequency
    if machine == "specimen":
        size = 10 ** rng.uniform(1, 4)
        c, k, m = size / (amplitude * w) * np.array([1.0, w, 0.3 / w]) * rng.uniform(0.05, 1.0, 3)
        spring, mass = rng.integers(3) > 0, rng.integers(2) > 0
        return Law(c=c, k=k * spring, m=m * mass)
    m = 10 ** rng.uniform(-2, 2)
    if machine == "motor":
        c = m * w / (2 * np.pi * rng.uniform(0.02, 0.4))
        return Law(m=m, c=c, Kt=c * 10 ** rng.uniform(0, 2))
    damping = rng.uniform(0.3, 1.2)
    if machine == "drive":
        wn = w * np.exp(rng.uniform(np.log(0.7), np.log(8.0)))
        return Law(m=m, c=2 * damping * wn * m, k=m * wn**2)
    wn, Kp = w * np.exp(rng.uniform(np.log(2.0), np.log(12.0))), 10 ** rng.uniform(-1, 2)
    return Law(m=m, c=2 * damping * wn * m, Kt=m * wn**2 / Kp, Kp=Kp)


def _shapes(rng: np.random.Generator, name: str) -> dict[str, float]:
    """Shapes, of the sizes of the base's motion: ways of the largest place, speeds of the largest speed."""

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    if name == "presliding_friction":
        return {"xs": between(0.003, 0.2)}
    if name == "stribeck_friction":
        return {"vs": between(0.02, 0.4)}
    if name == "specimen_hysteresis":
        return {"xy": between(0.03, 0.5), "n": float(rng.choice([1.0, between(1.0, 4.0)]))}
    if name == "end_stop":
        return {"way": float(rng.uniform(0.6, 0.92))}
    return {"sign": float(rng.choice([-1.0, 1.0]))} if name in ("gain_asymmetry", "cubic_stiffness") else {}


_MOST: dict[str, float] = {
    "coulomb_friction": 0.6,
    "presliding_friction": 0.6,
    "stribeck_friction": 0.6,
    "quadratic_damping": 3.0,
    "cubic_stiffness": 2.0,
    "specimen_hysteresis": 1.0,
    "specimen_free_play": 0.6,
    "end_stop": 30.0,
    "dead_zone": 0.6,
    "gain_asymmetry": 0.5,
    "backlash": 0.6,
}
"""The largest strength, in its scale: a machine that does not move tells nothing."""
_CLOSE = 0.1  # of the wanted excess
_TRIES = 8
_SHORT = 6  # periods by which a strength is set


def completed(seed: int, hidden: bool) -> Test:
    """A test by its seed, with the strength of what is hidden set so that the base leaves a drawn number of floors."""
    test = drawn(seed, hidden)
    if not hidden:
        return test
    wanted = float(np.exp(np.random.default_rng([52, seed]).uniform(*np.log(WORTH))))
    goal, most = np.sqrt(wanted**2 - 1.0), _MOST[test.hidden]
    scales = _sizes(replace(test, hidden="", periods=_SHORT))
    strength, tries = 0.1 * most, []
    for _ in range(_TRIES):
        found = hiding(test, strength, scales)
        short = replace(found, periods=_SHORT)
        excess = np.inf
        if np.all(np.isfinite(short.truth)) and short.sigma > 0:
            excess = float(np.sqrt(fits(short).d2("", ALIKE) / short.fitted))
        tries.append((abs(np.log(max(excess, 1e-9) / goal)), strength))
        if abs(excess / goal - 1.0) < _CLOSE or (strength == most and excess < goal):
            break
        strength = float(min(most, strength * np.clip(goal / max(excess, 1e-9), 0.1, 8.0)))
    return hiding(test, min(tries)[1], scales)


def _sizes(test: Test) -> dict[str, float]:
    """What strengths and shapes are measured by."""
    if test.machine != "specimen":
        return Driven(test).scales
    x, v, a = (float(np.abs(one).max()) for one in test.motion(np.linspace(2, 3, 2000) / test.frequency))
    law = test.law
    force = law.c * v + law.k * x + law.m * a
    return {
        "way": x,
        "speed": v,
        "force": force,
        "force/way": force / x,
        "force/way^3": force / x**3,
        "force/speed^2": force / v**2,
    }


def hiding(test: Test, strength: float, scales: Mapping[str, float]) -> Test:
    """The test with what is hidden so strong, in its scale."""
    name, shapes = test.hidden, dict(test.shapes)
    if name == "specimen_free_play":
        return replace(test, free_play=strength * scales["way"])
    if name == "specimen_hysteresis":
        own = {"fy": strength * scales["force"], "xy": shapes["xy"] * scales["way"], "n": shapes["n"]}
        return replace(test, law=test.law._replace(**{f"{name}_{key}": value for key, value in own.items()}))
    how = CANDIDATES[name]
    sign = shapes.pop("sign", 1.0) * (0.2 if name == "cubic_stiffness" and test.shapes["sign"] < 0 else 1.0)
    values = {f"{name}_{how.strength}": sign * strength * scales[how.scale]}
    for shape in how.shapes:
        if shape.name in shapes:
            values[f"{name}_{shape.name}"] = shapes[shape.name] * scales[shape.scale]
    return replace(test, law=test.law._replace(**values))
