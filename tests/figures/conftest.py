"""A small matrix with hand-made responses, so that the figures can be tested without a fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from ident.fit.result import Estimate, FitResult, Generation, RunError, Starts
from ident.matrix import Actuator, Matrix
from ident.run import Run, Specimen
from ident.words.error import ErrorOf

SPECIMENS = ((0.0, 0.0), (0.87, 36.3e3), (2.1, 17.5e3), (4.25, 17.5e3), (4.25, 67.6e3), (8.5, 36.3e3), (10.2, 67.6e3))
RATE = 512.0


def second_order(run: Run, frequency):
    """ω²/(s² + 2ζωs + ω²) with ω from specimen and gain: enough to look like an actuator."""
    mass = 4.0 + run.specimen.mass
    s = 2j * np.pi * frequency
    omega = np.sqrt((60e3 + run.specimen.stiffness + 20e3 * run.Kp) / mass)
    return omega**2 / (s**2 + 0.5 * omega * s + omega**2) / (1 + s * 0.004)


def make_run(mass: float, stiffness: float, kp: float, amplitude: float, seed: int) -> Run:
    rng = np.random.default_rng(seed)
    spectrum = np.fft.rfft(rng.standard_normal(1024))
    frequency = np.fft.rfftfreq(1024, 1 / RATE)
    spectrum[(frequency > 80) | (frequency == 0)] = 0
    command = np.fft.irfft(spectrum)
    command *= amplitude / command.std()
    channels = {"command": command}
    run = Run(
        id=f"m{mass:g}-k{stiffness / 1000:g}-kp{kp:g}-a{1000 * amplitude:g}",
        file="-",
        sample_rate=RATE,
        channels=channels,
        units={"command": "m", "displacement": "m"},
        specimen=Specimen(mass, stiffness),
        gain=kp,
        amplitude=amplitude,
        kind="blwn",
        use="verify" if kp == 6 else "fit",
    )
    clean = np.fft.irfft(np.fft.rfft(command) * second_order(run, frequency))
    channels["displacement"] = clean + 0.005 * clean.std() * rng.standard_normal(1024)
    return run


@dataclass(frozen=True)
class HandMade:
    """What a figure reads of a compared run."""

    run: Run
    error: float
    offset: float
    frequency: np.ndarray
    measured: np.ndarray
    coherence: np.ndarray
    modelled: np.ndarray
    unstable: bool = False

    @property
    def residual(self) -> np.ndarray:
        """Measured − modelled, (n,)."""
        return self.run.measured - self.modelled

    @property
    def unit(self) -> str:
        """The unit of the residual."""
        return self.run.units[self.run.output]

    def response(self, frequency: np.ndarray) -> np.ndarray:
        """The exact one."""
        return second_order(self.run, frequency)

    @property
    def random_error(self) -> np.ndarray:
        """As of ten windows."""
        return np.sqrt((1 - np.minimum(self.coherence, 1)) / (20 * np.maximum(self.coherence, 1e-3)))

    @property
    def words(self) -> ErrorOf:
        """Its error as a caption has it."""
        return ErrorOf(self.error, unstable=(self.run.id,) if self.unstable else ())


def make_comparison(run: Run) -> HandMade:
    """The exact response as model; the measured one noisy, the more the higher the frequency."""
    rng = np.random.default_rng(len(run.id))
    frequency = np.fft.rfftfreq(1024, 1 / RATE)[1:]
    model = second_order(run, frequency)
    coherence = np.clip(1.02 - (frequency / 95) ** 6, 0.0, 1.0)
    noise = (1.02 - coherence) * 0.4 * (rng.standard_normal(512) + 1j * rng.standard_normal(512))
    modelled = np.fft.irfft(np.fft.rfft(run.command) * second_order(run, np.fft.rfftfreq(1024, 1 / RATE)))
    return HandMade(run, 0.005, 0.001, frequency, model * (1 + noise), coherence, modelled)


@pytest.fixture(scope="session")
def matrix() -> Matrix:
    """Seven specimens, gains 5, 6, 7, 10 (Kp 6 to verify), three amplitudes: 84 runs of 2 s."""
    runs = [
        make_run(mass, stiffness, kp, amplitude, seed)
        for seed, (mass, stiffness, kp, amplitude) in enumerate(
            (m, k, kp, a) for m, k in SPECIMENS for kp in (5.0, 6.0, 7.0, 10.0) for a in (0.508e-3, 1.27e-3, 2.54e-3)
        )
    ]
    return Matrix(Actuator("SW-910D-0001", piston_area=497e-6), tuple(runs), "0" * 64)


@pytest.fixture(scope="session")
def fit(matrix: Matrix) -> FitResult:
    """Two searched parameters that converge over twelve generations."""
    rng = np.random.default_rng(0)
    generations = []
    for index in range(1, 13):
        width = 0.75**index
        z0 = np.clip(2.592e-6 + width * 1e-6 * rng.standard_normal(60), 1.751e-6, 3.503e-6)
        c0 = np.clip(3200 + width * 2000 * rng.standard_normal(60), 800, 5000)
        errors = 0.005 + np.abs(z0 / 2.592e-6 - 1) + 0.2 * np.abs(c0 / 3200 - 1)
        population = tuple(zip(z0.tolist(), c0.tolist(), strict=True))
        generations.append(
            Generation(index, float(errors.min()), float(errors.mean()), population, tuple(errors.tolist()))
        )
    return FitResult(
        model="qian2014",
        effects=(),
        parameters={
            "Z0": Estimate(2.592e-6, "m^4/s", 1e-9, 1.751e-6, 3.503e-6, False),
            "c0": Estimate(3200.0, "N*s/m", 2.0, 800.0, 5000.0, False),
            "tau": Estimate(0.0036, "s", 1e-6, 0.001, 0.006, False),
            "Cl": Estimate(1e-11, "m^3/(s*Pa)", 1e-14, 2e-12, 2e-11, False),
            "m0": Estimate(4.25, "kg", 0.001, 1.0, 10.0, False),
            "Ka": Estimate(1.39e-13, "m^3/Pa", 1e-16, 2e-15, 2e-13, False),
        },
        correlation={},
        determined=(),
        undetermined=(),
        error={"fit": 0.00512, "held_out": None, "verify": 0.00507},
        offset={"fit": 0.001, "verify": 0.001},
        noise_floor={"fit": 0.005, "verify": 0.005},
        runs=tuple(RunError(run.id, run.use, 0.005, 0.0) for run in matrix.runs),
        method="paper-ga",
        seed=0,
        evaluations=12000,
        seconds=1.0,
        version="0",
        data_hash="0" * 64,
        searched=("Z0", "c0"),
        evolution=tuple(generations),
        starts=Starts(3, 2, (0.005, 0.005, 0.02), {"Z0": (2.6e-6, 2.6e-6, 3e-6), "c0": (3200.0, 3201.0, 900.0)}),
    )
