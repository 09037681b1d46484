"""What a servo loop is judged by at a gain Kp: margins, bandwidth, peak and overshoot, of many loops side by side.

The loop opens at the dial: A(Kp) = A0 + Kp b cᵀ, so that 1 + Kp L(s) = det(sI − A(Kp))/det(sI − A0) whatever the sensor
shows, and Kp L(jω) = Π (jω − p)/(jω − p0) − 1 of the poles p of the closed and p0 of the open loop.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import scipy  # linalg, which takes a tenth of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.hybrid.changed_machine import ChangedMachine
from ident.linear import LinearModel

Array = NDArray[np.float64]
QUANTITIES = {"phase_margin": "°", "gain_margin": "dB", "bandwidth": "Hz", "peak": "dB", "overshoot": "%"}
"""What a gain may be chosen for, with its unit."""
HALF_POWER = 10 ** (-3 / 20)
"""Of |G(0)|: where |G| falls below it the band ends."""
_POINTS, _STEPS = 500, 1000  # of a response over frequency, and of one over time
_BEYOND = (0.05, 2.0)  # of the slowest and of the fastest pole: a response is looked at between
_NOTHING = float(np.finfo(float).tiny)  # of |L|: what rounding makes 0 has a logarithm
_SPAN = 8.0  # time constants of the slowest pole: a step is followed so long


def loop_figure(
    machine: ChangedMachine, quantity: str, gain: Array, factors: Mapping[str, Array] | None = None
) -> Array:
    """A quantity of the loop at gains (b,), with parameters times `factors` (b,) where given, (b,).

    NaN where the loop is unstable, inf where there is no limit. `phase_margin` in degrees and `gain_margin` in dB are
    those at the dial; `bandwidth` in Hz reaches to 3 dB below |G(0)|; `peak` is that of |G|/|G(0)| in dB; `overshoot`
    that of the step response in per cent of its final value.
    """
    closed = machine.linear(gain, factors)
    p = np.linalg.eigvals(closed.A).astype(complex)
    size = np.abs(p)
    frequency = np.geomspace(_BEYOND[0] * size.min(), _BEYOND[1] * size.max(), _POINTS) / (2 * np.pi)
    if quantity in _OF_LOOP:
        opened = np.linalg.eigvals(machine.linear(0.0 * gain, factors).A).astype(complex)
        s = 2j * np.pi * frequency[:, None]
        found = _OF_LOOP[quantity](np.prod((s - p[:, None, :]) / (s - opened[:, None, :]), axis=-1) - 1.0)
    elif quantity == "overshoot":
        found = _overshoot(closed, size.min(axis=-1))
    else:
        found = _OF_RESPONSE[quantity](closed, frequency)
    return np.where(p.real.max(axis=-1) < 0, found, np.nan)


def phase_margins(L: NDArray[np.complex128]) -> Array:
    """The least 180° + arg L where |L| crosses 1, of L (b, f) → (b,)."""
    size, turned = np.log(np.maximum(np.abs(L), _NOTHING)), np.degrees(np.unwrap(np.angle(L), axis=-1))
    turned -= 360.0 * np.round(turned[:, :1] / 360.0)  # at its beginning a loop turns by less than half a turn
    at = _between(size, turned)
    return np.asarray(np.min(np.abs(180.0 + at), axis=-1, initial=np.inf, where=np.isfinite(at)))


def gain_margins(L: NDArray[np.complex128]) -> Array:
    """The least −20 lg |L| where L is real and below 0, of L (b, f) → (b,), dB."""
    real = _between(L.imag, L.real)
    crossed = np.isfinite(real) & (real < 0)
    margin = -20 * np.log10(np.where(crossed, -real, 1.0))
    return np.asarray(np.min(margin, axis=-1, initial=np.inf, where=crossed & (margin > 0)))


def _between(crossing: Array, of: Array) -> Array:
    """`of` (b, f) where `crossing` (b, f) passes 0, on straight lines, (b, f − 1); NaN where it does not."""
    before, after = crossing[:, :-1], crossing[:, 1:]
    passes = (before > 0) != (after > 0)
    share = np.divide(before, before - after, out=np.zeros_like(before), where=passes)
    return np.where(passes, of[:, :-1] + share * (of[:, 1:] - of[:, :-1]), np.nan)


def _bandwidth(model: LinearModel, frequency: Array) -> Array:
    """Bandwidth in Hz, (b,)."""
    size = _relative(model, frequency)
    left = _between(size - HALF_POWER, np.broadcast_to(np.log(frequency), size.shape))
    return np.asarray(np.exp(np.min(left, axis=-1, initial=np.inf, where=np.isfinite(left))))


def _peak(model: LinearModel, frequency: Array) -> Array:
    """The largest |G|/|G(0)|, of the parabola through three points, (b,), dB."""
    size = _relative(model, frequency)
    at = size.argmax(axis=-1)
    inside = (at > 0) & (at < size.shape[-1] - 1)
    place = np.clip(at, 1, size.shape[-1] - 2)[:, None]
    a, b, c = (np.take_along_axis(size, place + i, -1)[:, 0] for i in (-1, 0, 1))
    bend = np.where(inside, a - 2 * b + c, -1.0)
    top = np.where(inside, b - (a - c) ** 2 / (8 * np.minimum(bend, -1e-300)), size.max(axis=-1))
    return np.asarray(20 * np.log10(np.maximum(top, 1.0)))


def _relative(model: LinearModel, frequency: Array) -> Array:
    """|G|/|G(0)|, (b, f)."""
    return np.asarray(np.abs(model.frequency_response(frequency)) / np.abs(model.frequency_response(np.zeros(1))))


def _overshoot(model: LinearModel, slowest: Array) -> Array:
    """Of the step response, followed over eight time constants of the `slowest` pole (b,) 1/s, (b,), per cent."""
    n = model.A.shape[-1]
    system = np.zeros((len(slowest), n + 1, n + 1))
    system[:, :n, :n], system[:, :n, n] = model.A, model.B
    step = scipy.linalg.expm(system * (_SPAN / _STEPS / slowest)[:, None, None])
    z, highest = np.zeros((len(slowest), n + 1)), np.zeros(len(slowest))
    z[:, n] = 1.0
    with np.errstate(over="ignore", invalid="ignore"):  # of an unstable loop
        for _ in range(_STEPS):
            z = np.einsum("bij,bj->bi", step, z)
            highest = np.maximum(highest, np.einsum("bi,bi->b", model.C, z[:, :n]) + model.D)
    last = model.frequency_response(np.zeros(1))[:, 0].real
    return np.maximum(100 * (highest / last - 1.0), 0.0)


_OF_LOOP: Mapping[str, Callable[[NDArray[np.complex128]], Array]] = {
    "phase_margin": phase_margins,
    "gain_margin": gain_margins,
}
_OF_RESPONSE: Mapping[str, Callable[[LinearModel, Array], Array]] = {"bandwidth": _bandwidth, "peak": _peak}
