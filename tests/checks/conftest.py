"""A healthy matrix, simulated with scipy, into which the tests put one fault at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy import signal

from ident.checks import check as checks
from ident.checks.check import check, one_run
from ident.checks.delay import delay
from ident.checks.response import Response
from ident.matrix import Actuator, Matrix
from ident.run import Run, Samples, Specimen

RATE = 4096.0
SECONDS = 2
SPECIMENS = (Specimen(0.87, 36300.0, 0.0), Specimen(2.0, 6000.0, 0.0), Specimen(0.87, 0.0, 0.0))


def noise_of(random: np.random.Generator, band: float, rms: float, rate: float = RATE) -> Samples:
    """White noise from 0 to `band` in Hz."""
    spectrum = np.fft.rfft(random.normal(size=int(SECONDS * rate)))
    spectrum[np.fft.rfftfreq(int(SECONDS * rate), 1 / rate) > band] = 0
    found = np.fft.irfft(spectrum)
    return found * rms / found.std()


def displacement_of(command: Samples, specimen: Specimen, gain: float, rate: float = RATE) -> Samples:
    """Qian's chain with the values of Table 4, solved by scipy; states q, P, v, x."""
    Z0, tau, Cl, c0, m0, Ka, A = 2.592e-6, 3.6e-3, 1e-11, 3200.0, 4.25, 1.39e-13, 4.97e-4
    m, c, k = m0 + specimen.mass, c0 + specimen.damping, specimen.stiffness
    dynamics = [
        [-1 / tau, 0, 0, -gain / tau],
        [Z0 / A / Ka, -Cl / Ka, -A / Ka, 0],
        [0, A / m, -c / m, -k / m],
        [0, 0, 1, 0],
    ]
    system = signal.StateSpace(dynamics, [[gain / tau], [0], [0], [0]], [[0, 0, 0, 1.0]], [[0.0]])
    return np.ascontiguousarray(signal.lsim(system, command, np.arange(len(command)) / rate)[1])


def run_of(number: int, specimen: Specimen, gain: float, band: float = 80.0) -> Run:
    """One run with half a per cent of noise; every run has its own command."""
    random = np.random.default_rng(number)
    command = noise_of(random, band, 0.00127)
    clean = displacement_of(command, specimen, gain)
    channels = {"command": command, "displacement": clean + 0.005 * clean.std() * random.normal(size=len(clean))}
    return Run(
        id=f"run-{number}",
        file=f"runs/{number}.npz",
        sample_rate=RATE,
        channels=channels,
        units=dict.fromkeys(channels, "m"),
        specimen=specimen,
        gain=gain,
        amplitude=0.00127,
        kind="blwn",
        use="verify" if gain == 6 else "fit",
    )


@pytest.fixture(scope="session")
def healthy() -> Iterator[Matrix]:
    """Three specimens at Kp 5 and 10 to fit and 6 to verify: nine runs of 2 s.

    What is said of each by itself is worked out once: a test changes one of them, and the others are as they were.
    """
    runs = [
        run_of(3 * number + place, specimen, gain)
        for number, specimen in enumerate(SPECIMENS)
        for place, gain in enumerate((5.0, 10.0, 6.0))
    ]
    own = {id(run) for run in runs}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(checks, "one_run", _once(own, lambda *given: tuple(one_run(*given))))
        patch.setattr("ident.checks.delay.delay", _once(own, delay))
        yield Matrix(Actuator("SW-1", piston_area=4.97e-4, stroke=0.15), tuple(runs))


def _once(own: set[int], function: Callable[..., Any]) -> Callable[..., Any]:
    """`function(run, response, actuator)`: for runs that are `own`, of which the response follows, once an actuator."""
    known: dict[tuple[int, str], Any] = {}

    def answered(run: Run, response: Response | None, *of: Actuator) -> Any:
        if id(run) not in own:
            return function(run, response, *of)
        key = id(run), repr(of)
        if key not in known:
            known[key] = function(run, response, *of)
        return known[key]

    return answered


class Faulty:
    """A matrix one of whose runs is changed, and the findings that follow."""

    def __init__(self, matrix: Matrix) -> None:
        self.matrix = matrix

    def run(self, number: int, **changes: object) -> Faulty:
        """Replace fields of one run."""
        runs = list(self.matrix.runs)
        runs[number] = replace(runs[number], **changes)
        return Faulty(replace(self.matrix, runs=tuple(runs)))

    def channel(self, number: int, name: str, samples: Samples, unit: str = "m") -> Faulty:
        """Replace or add a channel of one run."""
        run = self.matrix.runs[number]
        return self.run(number, channels={**run.channels, name: samples}, units={**run.units, name: unit})

    def all_runs(self, **changes: object) -> Faulty:
        """Replace fields of every run."""
        return Faulty(replace(self.matrix, runs=tuple(replace(run, **changes) for run in self.matrix.runs)))

    def found(self) -> dict[tuple[str | None, str], str]:
        """Severity by run and code, doubts and faults and notes."""
        return {(finding.run, finding.code): finding.severity for finding in check(self.matrix)}

    def text(self, code: str) -> str:
        """The words of the first finding of a code."""
        return next(finding.text for finding in check(self.matrix) if finding.code == code)


@pytest.fixture
def faulty(healthy: Matrix) -> Faulty:
    """The healthy matrix, to be changed."""
    return Faulty(healthy)
