"""A servo whose speed is limited: the same machine looks slower the farther it is sent, and nothing is mislabelled."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from ident.checks.check import check
from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.short_form import short_form

RATE, LIMIT, GAIN = 50.0, 1.5, 9.0  # Hz, rad/s, 1/s


def servo(name: str, command: np.ndarray, seed: int) -> Run:
    """y' = clip(K (u - y), -v, v), by Euler's rule at a fiftieth of a sample, measured in 12 bits."""
    y, went = 0.0, []
    for u in command:
        went.append(y)
        for _ in range(50):
            y += np.clip(GAIN * (u - y), -LIMIT, LIMIT) / (50 * RATE)
    seen = np.round((np.array(went) + 1e-4 * np.random.default_rng(seed).standard_normal(len(went))) * 2048) / 2048
    return Run(
        name,
        "",
        RATE,
        {"command": command, "displacement": seen},
        {"command": "rad", "displacement": "rad"},
        hold="zoh",
    )


@pytest.mark.parametrize("seed", short_form([8, 9, 10], 9))
def test_no_unit_and_no_shift_of_its_records_is_doubted(seed):
    rng, t = np.random.default_rng(seed), np.arange(150) / RATE
    runs = [servo("chirp", 0.625 * np.sin(2 * np.pi * (0.5 * t + 1.5 * t**2)), 1)]
    for number, (size, half) in enumerate(product((0.1, 0.3, 0.6), (8, 20))):
        switched = np.repeat(np.sign(rng.standard_normal(150)) * size, rng.integers(2, 9, 150))[:150]
        square = np.repeat(size * (-1.0) ** np.arange(150), half)[:100]
        runs += [servo(f"switched {number}", switched, number), servo(f"square {number}", square, number)]
    assert not {finding.code for finding in check(Matrix(Actuator("SERVO"), tuple(runs)))} & {"scale", "skew"}
