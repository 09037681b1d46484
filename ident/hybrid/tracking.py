"""Tracking an actuator's closed loop in real time: τyr and kyr of τyr y′ + y = kyr r, by an extended Kalman filter.

Source: S. Strano, M. Terzo et al., eqs. (20)-(25). The paper takes the forward difference for the step between samples;
here it is exact for a reference that runs straight between its samples, with which the difference agrees up to the
first power of Δt/τ, or for one that is held. For a reference that is continuous a held step would put τ wrong by −Δt/2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ident.errors import Unusable
from ident.hybrid import kalman
from ident.hybrid.innovation_test import InnovationTest, innovation_test
from ident.run import HOLDS

Array = NDArray[np.float64]
Sample = tuple[float, float, float, float, float, float]
"""τ (s), k, y (m), var τ (s²), var k, normalised innovation squared."""
COLUMNS = ("tau", "gain", "y", "var_tau", "var_gain", "nis")

SENSOR = 1.2e-4
"""m, the position uncertainty of the paper's rig, taken as a standard deviation."""
TEST_WAY = 0.05 / math.sqrt(2.0)
"""m, RMS of the paper's test, a sine of 0.05 m."""
TEST_SPEED = 2 * math.pi * 1.0 * TEST_WAY
"""m/s, RMS of its speed at 1 Hz."""
FOLLOWED_IN = 1 / 6
"""s, the time constant with which the estimates follow a parameter that changes in such a test."""
TAU, GAIN = 0.02, 1.0
"""s and 1, where a filter starts unless it is told."""
_SPREAD_P, _SPREAD_G = 5.0, 25.0  # relative standard deviations of 1/τ and k/τ at a start: each up to five times off
_FURTHEST = 100.0  # times the start: the limits of what is reported
_LARGEST_RATE = 1e7  # Hz


@dataclass(frozen=True)
class Noise:
    """`measurement` of the sensor (standard deviation, m); fictitious noise of τ (s/√s) and of k (1/√s).

    Raises Unusable where one is not finite, or the sensor's not positive.
    """

    measurement: float
    tau: float
    gain: float

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not (math.isfinite(value) and (value > 0 or (value == 0 and name != "measurement"))):
                raise Unusable(
                    "bad-noise",
                    f"{value:g} is not a size of a noise",
                    f"noise {name}",
                    "give a standard deviation above 0, of what is fictitious also 0",
                )

    @classmethod
    def of_sensor(
        cls, sample_rate: float, measurement: float = SENSOR, way: float = TEST_WAY, speed: float = TEST_SPEED
    ) -> Noise:
        """The fictitious noise that the sensor's allows, for a reference of RMS `way` (m) and `speed` (m/s).

        Of a parameter θ by which y moves ∂y/∂θ = S (RMS; for k the way, for τ the speed), a filter in its steady state
        forgets with the time constant T = σ √Δt / (S q). With T = 1/6 s that is q = σ √Δt / (S T): in the paper's test
        at 4096 Hz 5·10⁻⁵ s/√s and 3·10⁻⁴ 1/√s. With 3·10⁻³ s/√s an estimate of 5 ms scatters by 3 %, ten times as much.
        """
        size = measurement / math.sqrt(sample_rate) / FOLLOWED_IN
        return cls(measurement, size / speed, size / way)


class Tracker:
    """The filter, a sample or a block at a time. `hold` says what r does between samples: "linear" or "zoh".

    A "band-limited" r is drawn in lines too: a filter in real time does not know the samples that follow.

    It starts at `tau0` (s) and `gain0`, each of which may be up to five times off. Single samples far off are not
    believed; where they last, the parameters have changed and are found anew (unless `reopens` is false: then they are
    followed at the speed of the fictitious noise alone). Without motion the parameters rest, and their variance stays
    below a tenth of their value. Raises Unusable for numbers that no filter can work with.
    """

    def __init__(
        self,
        sample_rate: float,
        hold: str = "linear",
        tau0: float = TAU,
        gain0: float = GAIN,
        noise: Noise | None = None,
        *,
        reopens: bool = True,
    ) -> None:
        _check(sample_rate, hold, tau0, gain0)
        self.sample_rate, self.hold = sample_rate, hold
        self.noise = noise or Noise.of_sensor(sample_rate)
        self.state, self.constants = np.zeros(kalman.STATE), np.zeros(kalman.CONSTANTS)
        p0 = 1.0 / tau0
        self.constants[:] = (
            1.0 / sample_rate,
            self.noise.measurement**2,
            self.noise.tau**2,
            self.noise.gain**2,
            _SPREAD_P**2,
            _SPREAD_G**2,
            p0 / _FURTHEST,
            max(2.0 * sample_rate, 2.0 * p0),
            _FURTHEST * abs(gain0),
            float(reopens),
        )
        self.state[[kalman.P, kalman.G]] = p0, gain0 * p0
        self.state[[kalman.DP, kalman.DG]] = (_SPREAD_P * p0) ** 2, (_SPREAD_G * gain0 * p0) ** 2
        self._held, self._sample = hold == "zoh", kalman.sample

    def step(self, r: float, y: float) -> Sample:
        """One sample of the reference r and the measured y (m); a y that is not finite was not measured."""
        found: Sample = self._sample(self.state, self.constants, self._held, r, y)
        return found

    def block(self, r: ArrayLike, y: ArrayLike) -> Array:
        """A block of samples, r and y (n,) → (n, 6), the columns of `COLUMNS`. Raises Unusable where r is not finite,
        or the two are not of one length.
        """
        given, measured = (np.ascontiguousarray(samples, dtype=np.float64) for samples in (r, y))
        if given.ndim != 1 or given.shape != measured.shape:
            raise Unusable(
                "bad-samples",
                f"{given.size} samples of r and {measured.size} of y",
                "samples",
                "give as many of one as of the other",
            )
        if not np.isfinite(given).all():
            raise Unusable("bad-samples", "a sample of the reference is not finite", "samples r", "give every one")
        rows = np.empty((len(given), len(COLUMNS)))
        kalman.follow(self.state, self.constants, self._held, given, measured, rows)
        return rows

    @property
    def estimate(self) -> tuple[float, float]:
        """τ (s) and k as they are known now."""
        tau, gain, *_ = kalman.estimate(self.state, self.constants)
        return tau, gain

    @property
    def covariance(self) -> Array:
        """Of (y, τ, k), shape (3, 3), to first order."""
        s, (tau, gain) = self.state, self.estimate
        factor = np.array([[1.0, s[kalman.UYP], s[kalman.UYG]], [0.0, 1.0, s[kalman.UPG]], [0.0, 0.0, 1.0]])
        to_parameters = np.array([[1.0, 0.0, 0.0], [0.0, -tau * tau, 0.0], [0.0, -gain * tau, tau]])
        root = to_parameters @ factor * np.sqrt(s[[kalman.DY, kalman.DP, kalman.DG]])
        found: Array = root @ root.T
        return found

    @property
    def verdict(self) -> InnovationTest:
        """Whether the first-order loop holds for what was seen until now, and why."""
        return innovation_test(self.state)


def _check(sample_rate: float, hold: str, tau0: float, gain0: float) -> None:
    if not 0 < sample_rate <= _LARGEST_RATE:
        raise Unusable(
            "bad-sample-rate", f"{sample_rate:g} Hz", "sample_rate", f"give more than 0, to {_LARGEST_RATE:g} Hz"
        )
    if hold not in HOLDS:
        raise Unusable("unknown-hold", f"hold {hold!r} is not known", "hold", f"use {' or '.join(HOLDS)}")
    if not (math.isfinite(tau0) and 1e-9 < tau0 < 1e9):
        raise Unusable("bad-start", f"a time constant of {tau0:g} s", "tau0", "give a positive one")
    if not (math.isfinite(gain0) and 1e-9 < abs(gain0) < 1e9):
        raise Unusable("bad-start", f"a gain of {gain0:g}", "gain0", "give one that is not 0")
