"""A whole sample or more between command and displacement that the dynamics do not explain."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.checks.finding import Finding
from ident.checks.local_response import LocalResponse, local_response
from ident.checks.response import Response
from ident.run import Run, Samples
from ident.words.message import Message

POLES = 4  # of the chain: valve, pressure, mass
SEARCHED = 24.0  # samples either way
STEP = 0.5  # samples
ITERATIONS = 4  # of the weights; the poles hardly move after three
POWER = 0.98  # of the command, whose band is looked at
NEAR = 1.25  # times the best misfit: what fits as well cannot be told from it
FLOOR = 0.002  # misfit, relative: below, differences are those of the method
WIDEST = 3.0  # samples between the first and the last delay that fit
LEAST = 0.75  # samples; the scatter of the estimate at 5 % noise is below 0.3
APART = 0.75  # samples between one run and the middle of all
EXPLAINED = 0.1  # misfit, relative: a run with a larger one at the best delay has another fault than a delay
_OUTLIER = 6.0  # times the median deviation from it: the delay of what is limited in speed is another in every run


@dataclass(frozen=True)
class Delay:
    """Samples by which the output lags a model of POLES poles, and the range of delays that fit about as well.

    `by_rate`: what leads may as well answer the rate of the command, by a zero.
    """

    samples: float
    shortest: float
    longest: float
    misfit: float
    by_rate: bool = False

    @property
    def told(self) -> bool:
        """True where the run determines its delay."""
        return self.longest - self.shortest <= WIDEST

    def apart(self, middle: float, least: float) -> bool:
        """Whether the delay differs from the other runs' delay, and theirs does not fit as well."""
        return abs(self.samples - middle) >= least and not self.shortest <= middle <= self.longest


def delays(measured: list[tuple[Run, Response | None]]) -> Iterator[Finding]:
    """A displacement ahead of any model, a run apart from the others, or a delay that all runs share."""
    estimates = [(run, estimate) for run, response in measured if (estimate := delay(run, response)) is not None]
    found = [(run, estimate) for run, estimate in estimates if estimate.misfit <= EXPLAINED]
    told = [estimate.samples for _, estimate in found if estimate.told]
    middle = float(np.median(told)) if told else 0.0
    apart = max(APART, _OUTLIER * float(np.median(np.abs(np.array(told) - middle)))) if told else APART
    if abs(middle) >= LEAST and len(told) > 1:
        leads = "check.lead_all_or_rate" if any(estimate.by_rate for _, estimate in found) else "check.lead_all"
        yield Finding.of(None, "doubt", "delay", late("check.delay_all", leads, middle, count=len(told)))
    for run, estimate in found:
        if estimate.told and len(told) > 2 and estimate.apart(middle, apart):
            values = {"run": run.id, "middle": middle}
            yield Finding.of(run.id, "doubt", "skew", late("check.skew", "check.skew_lead", estimate.samples, **values))
        elif estimate.told and len(told) == 1 and estimate.apart(0.0, LEAST):
            yield alone(run, estimate.samples, estimate.by_rate)
        elif not estimate.told and estimate.longest <= -LEAST:
            yield alone(run, estimate.longest, estimate.by_rate)


def alone(run: Run, samples: float, by_rate: bool) -> Finding:
    """The finding for one run that is judged by itself."""
    leads = "check.lead_or_rate" if by_rate else "check.lead"
    return Finding.of(run.id, "doubt", "delay", late("check.delay", leads, samples, run=run.id))


def late(lags: str, leads: str, samples: float, **values: object) -> Message:
    """One of two messages: that an output lags by more than its model explains, or that it leads."""
    explained = {"poles": POLES} if samples > 0 else {}
    return Message(lags if samples > 0 else leads, {"samples": abs(samples), **explained, **values})


def delay(run: Run, response: Response | None) -> Delay | None:
    """The delay T of the best H(f) = exp(-i w T) / (a0 + a1 s + ... + a4 s^4); None where there is nothing to fit.

    An actuator lags its command by tens of samples, which its poles explain; T is the rest. What leads as the rate of
    the command does, by a zero, is no shift of channels: a mass on a base that moves, with a damper between them, or a
    loop with a feed-forward of the speed. There is no delay to tell where a zero fits better, and the two are not told
    apart where it fits about as well.
    """
    if response is None or run.output != "displacement" or run.time_unit != "s" or run.kind in ("sine", "frequency"):
        return None
    measured = local_response(run.command, run.measured, run.sample_rate, response.below(POWER))
    if measured is None or not np.all(measured.scatter > 0):
        return None
    trial = np.arange(-SEARCHED, SEARCHED + STEP / 2, STEP)
    cost = misfits(measured, trial / run.sample_rate)
    best = int(np.argmin(cost))
    near = np.flatnonzero(cost <= NEAR * cost[best] + FLOOR)
    by_rate = misfit_with_zero(measured) if trial[best] < 0 else np.inf
    if cost[best] > NEAR * by_rate + FLOOR:
        return None
    alike = by_rate <= NEAR * cost[best] + FLOOR
    ends = float(trial[near[0]]), float(trial[near[-1]])
    return Delay(lowest(trial, cost, best), *ends, float(cost[best]), bool(alike))


def lowest(trial: Samples, cost: Samples, best: int) -> float:
    """The lowest point of the parabola through the squares of the best cost and its neighbours."""
    if not 0 < best < len(trial) - 1:
        return float(trial[best])
    left, middle, right = cost[best - 1 : best + 2] ** 2
    curve = left - 2 * middle + right
    return float(trial[best] + STEP * 0.5 * (left - right) / curve) if curve > 0 else float(trial[best])


def misfit_with_zero(measured: LocalResponse) -> float:
    """Weighted relative error of the best (1 + b s) / (a0 + a1 s + ... + a4 s^4), by iterated linear least squares.

    A transmissibility has b = c/k (Thomson, Theory of Vibration, support motion); a feed-forward its share.
    """
    s, h = 1j * measured.frequency / measured.frequency[-1], measured.gain
    weight = 1 / np.maximum(measured.scatter, FLOOR * np.abs(h))
    poles = s[:, None] ** np.arange(POLES + 1)
    terms = np.column_stack([h[:, None] * poles, -s])
    inverse: NDArray[np.complex128] = 1 / h
    modelled = h
    for _ in range(ITERATIONS):
        scale = weight / np.abs(inverse)
        system = scale[:, None] * terms
        rows, wanted = np.vstack([system.real, system.imag]), np.concatenate([scale, np.zeros_like(scale)])
        found = np.linalg.lstsq(rows, wanted, rcond=1e-14)[0]
        inverse = poles @ found[:-1]
        modelled = (1 + found[-1] * s) / inverse
    return float(np.linalg.norm(weight * (h - modelled)) / np.linalg.norm(weight * h))


def misfits(measured: LocalResponse, seconds: Samples) -> Samples:
    """Weighted relative error of the best all-pole model with each delay (T,), by iterated linear least squares."""
    s = 1j * measured.frequency / measured.frequency[-1]
    h = measured.gain * np.exp(2j * np.pi * measured.frequency * seconds[:, None])  # (T, F)
    weight = 1 / np.maximum(measured.scatter, FLOOR * np.abs(measured.gain))
    basis = s[:, None] ** np.arange(POLES + 1)
    inverse: NDArray[np.complex128] = 1 / h
    for _ in range(ITERATIONS):
        scale = weight / np.abs(inverse)
        system = (scale * h)[:, :, None] * basis  # (T, F, POLES + 1)
        normal = np.real(system.conj().transpose(0, 2, 1) @ system)
        wanted = np.real(system.conj().transpose(0, 2, 1) @ scale[:, :, None])
        inverse = (basis @ (np.linalg.pinv(normal, rcond=1e-14, hermitian=True) @ wanted))[:, :, 0]
    cost: Samples = np.linalg.norm(weight * (h - 1 / inverse), axis=1) / np.linalg.norm(weight * h, axis=1)
    return cost
