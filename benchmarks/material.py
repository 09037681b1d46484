"""The matrix that every benchmark works on: 63 + 21 runs of the independent reference, in memory."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np

from ident.matrix import Actuator, Matrix
from ident.run import Run, Specimen
from tests.reference import qian_reference as reference

CHANNELS = ("command", "displacement")


def run_of(trial: reference.Trial, channels: dict[str, np.ndarray], hold: str = "linear") -> Run:
    """One run of the reference as the program reads it."""
    cell = trial.cell
    return Run(
        id=trial.id,
        file="",
        sample_rate=reference.SAMPLE_RATE,
        channels=channels,
        units=dict.fromkeys(CHANNELS, "m"),
        specimen=Specimen(cell.mass, cell.stiffness, cell.damping),
        gain=cell.gain,
        amplitude=trial.amplitude,
        kind="blwn",
        hold=hold,
        use=trial.use,
    )


@lru_cache(maxsize=2)
def matrix(seconds: float = 30.0, hold: str = "linear") -> Matrix:
    """The paper's test matrix at Table 4's parameters, 0.5 % noise."""
    plant = reference.Plant()
    records = reference.measure_all(plant, reference.trials(), seconds=seconds, noise=0.005, seed=1, hold=hold)
    runs = tuple(run_of(r.trial, dict(zip(CHANNELS, r[1:], strict=True)), hold) for r in records)
    return Matrix(Actuator("REFERENCE-1", piston_area=plant.A), runs, data_hash="0" * 64)


def save(path: Path, seconds: float) -> None:
    """The matrix's samples as one array file (run, channel, sample), for a process that must not generate them."""
    runs = matrix(seconds).runs
    np.save(path, np.array([[run.channels[name] for name in CHANNELS] for run in runs]))


def load(path: Path) -> Matrix:
    """The matrix of :func:`save`."""
    samples = np.load(path)
    runs = tuple(
        run_of(trial, dict(zip(CHANNELS, channels, strict=True)))
        for trial, channels in zip(reference.trials(), samples, strict=True)
    )
    return Matrix(Actuator("REFERENCE-1", piston_area=reference.Plant().A), runs, data_hash="0" * 64)


def random_vectors(count: int, seed: int = 2) -> np.ndarray:
    """Parameter vectors spread evenly over Table 2's bounds, (count, 6), in the order of the reference's names."""
    lower, upper = np.array([reference.BOUNDS[name] for name in reference.PARAMETERS]).T
    return np.random.default_rng(seed).uniform(lower, upper, (count, len(lower)))
