"""How finely a chain is to be simulated: the steps that a sample is divided into."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import INPUT_RATE, Chain
from ident.chain.exact_lags import with_exact_lags
from ident.effects.effect import Effect
from ident.parameter import AtReversals
from ident.rounding import TINY

Array = NDArray[np.float64]
Modes = NDArray[np.complex128]
FINE = 0.4  # radians or time constants a step: the largest eigenvalue times the step, above which steps are divided
_STIFF = 1.0  # the same for a mode so fast that it does nothing but follow; from 2.6 a step would go astray
_STIFFER = 1.7
"""The same from :data:`_OVER` steps a sample on. Why: of a jump, what such a mode has left by the next sample is off by
0.7 % as one step of 1.0 leaves it; half as fast again in motion, it is still followed.

Test: tests/simulation/test_steps.py::test_of_a_jump_a_mode_that_only_follows_has_no_more_left_at_the_next_sample"""
_OVER = 4  # steps a sample from which on a jump is over before the next sample
_RINGING = 14.4  # times its damping: the fifth power of the step of a Runge-Kutta scheme that adds a tenth to it
_FOLLOWING = 4.0  # times the band of the commands: where such modes begin
_KINKED = 0.3  # radians a sample of the band for which an effect says how many steps its kinks ask for
MOST = 32  # steps a sample of a record
_CURVED = 0.8
"""Radians a step of the band's edge of a command that is band-limited between its samples. Why: its lines have the
area of the curve but for (ω h)⁴/240; 0.8 loses 2e-3 of what reaches the machine at the edge, and a tenth of that
where a machine answers."""
_SLOPE = 0.125  # of that, where the rate of the command counts: lines have it half a step too early
_SHARE = 0.1
"""Of a way over which a force builds up, the way that may be covered in a step about a reversal: where in a step the
motion turned is not known. Five times as much puts the way off by 2 %."""
_AT_REVERSALS = 8
"""Steps a sample at most for reversals: of a way so short that it asks for more the samples hardly tell the length."""
_MISSED = 5e-4
"""Of the amplitude of a motion, by which a reversal within a step may put it off. Why: a quarter of the least noise of
a sensor, 0.2 %."""
_PASSED = 2.0
"""Widths of a force that falls with the speed, which may be passed in a step."""
_FASTER = 1.5
"""Times as fast as at rest is a mode that motion makes faster. Why: less asks for no more steps, which are powers of
two, and slopes by differences are off by a hundredth where forces are large."""
FASTEST = FINE * MOST  # radians a sample of the fastest mode that is followed closely; one beyond is said


def steps_where_reversed(
    of: AtReversals, size: Array, turned: float, rate: float, force: Array | None, every: int = 1
) -> NDArray[np.int64]:
    """Steps a sample that a way, a speed or a force (v,) asks for where the motion reverses.

    `turned` is that of :func:`steps_at_reversals`, `rate` the sample rate, Hz. `force` (v,) would move the mass by the
    amplitude of its motion in a sample; None where it has no mass, or does not move. `every` is how many samples of the
    record there are for one that is simulated.
    """
    if of is AtReversals.WAY:
        return steps_at_reversals(turned, size, every)
    if of is AtReversals.SPEED:
        return steps_at_passages(turned * rate, size, every)
    jumps = np.zeros(len(size)) if force is None else 2.0 * np.abs(size) / np.maximum(force, TINY)
    return steps_at_jumps(jumps, every)


def steps_at_reversals(turned: float, ways: Array, every: int = 1) -> NDArray[np.int64]:
    """Steps a sample, a power of two, for ways (m, v) over which forces build up.

    `turned` is the way a T² that the motion's largest acceleration a covers in a sample T. In n steps a reversal is
    missed by a T²/n² at most.
    """
    return _at_reversals(np.sqrt(turned / (_SHARE * np.maximum(np.abs(ways), 1e-300))), every)


def steps_at_jumps(jumps: Array, every: int = 1) -> NDArray[np.int64]:
    """Steps a sample, a power of two, for jumps J (v,) of the acceleration where a motion of amplitude x̂ reverses.

    They are given as J T²/x̂, in a sample T. In n steps, which take such a force at its mean, the way is put off by
    J T²/8n² at most.
    """
    return _at_reversals(np.sqrt(jumps / (8.0 * _MISSED)), every)


def steps_at_passages(passed: float, speeds: Array, every: int = 1) -> NDArray[np.int64]:
    """Steps a sample, a power of two, for speeds (v,) over which a force falls; `passed` is the speed's rise in it."""
    return _at_reversals(passed / (_PASSED * np.maximum(np.abs(speeds), 1e-300)), every)


def _at_reversals(needed: Array, every: int) -> NDArray[np.int64]:
    """As many steps as are needed, as a power of two within what samples tell."""
    return np.asarray(2 ** np.ceil(np.log2(np.clip(needed, 1.0, _AT_REVERSALS * every))), dtype=np.int64)


def fastest_mode(
    chain: Chain, values: Mapping[str, Any], output: str, motion: Mapping[str, float] | None = None
) -> Modes:
    """The eigenvalue of the chain's small-signal behaviour that is largest, 1/s, for a batch of values.

    About where small signals are taken, and about each state of the `motion` as far as that goes: damping that grows
    with the speed makes a mode faster than it is at rest, and so does a spring that hardens. Lags that are advanced
    exactly ask for no steps: they count as if they followed at once.
    """
    followed = with_exact_lags(chain)
    known = {name: values[name] for name in followed.symbols}
    moved = {} if followed.is_linear else {name: far for name, far in (motion or {}).items() if name in followed.states}
    points = [followed.operating_point(known, at) for at in ({}, *({name: far} for name, far in moved.items()))]
    with np.errstate(
        divide="ignore", invalid="ignore", over="ignore"
    ):  # where no machine is: slopes there count as none
        rest, *others = _fastest(followed.linearise(known, output, _side_by_side(points, known)).A)
    for other in others:
        rest = np.where(np.abs(other) > _FASTER * np.abs(rest), other, rest)
    return np.asarray(rest)


def _side_by_side(points: Sequence[Sequence[Any]], values: Mapping[str, Any]) -> list[Array]:
    """Operating points (p,) of n + 1 numbers each, as n + 1 arrays that broadcast against the values, (p, ...)."""
    dimensions = max(np.ndim(value) for value in values.values())

    def stacked(there: Sequence[Any]) -> Array:
        shape = np.broadcast_shapes(*(np.shape(one) for one in there))
        of_each = np.array([np.broadcast_to(one, shape) for one in there] if shape else there)
        return of_each.reshape(len(there), *[1] * (dimensions - len(shape)), *shape)

    return [stacked(there) for there in zip(*points, strict=True)]


def _fastest(jacobian: Array) -> Modes:
    """The eigenvalue of each of a batch that is largest."""
    found = np.linalg.eigvals(np.where(np.isfinite(jacobian), jacobian, 0.0)).astype(np.complex128)
    modes = found.reshape(-1, found.shape[-1])
    largest = modes[np.arange(len(modes)), np.abs(modes).argmax(axis=-1)]
    return np.asarray(largest.reshape(found.shape[:-1]))


def steps_needed(
    chain: Chain,
    fastest: Modes,
    hold: str,
    on: Sequence[Effect],
    band: float = np.pi / 2,
    kinks: int = 1,
    every: int = 1,
) -> NDArray[np.int64]:
    """Steps a sample, a power of two up to :data:`MOST`, for eigenvalues `fastest`, (v,).

    They and the `band` up to which the command excites the machine are in radians a sample. A mode that does nothing
    but follow is given fewer: a Runge-Kutta step of one time constant is off by 2 % in how fast it decays, and not in
    where it tends to. Not one that rings: a step z of it takes off |z|⁶/144 by itself, which is kept to a tenth of what
    its damping ζ does, 0.1 ζ|z|. Kinks of effects that are on, and those of the core, `kinks`, ask for more, the fewer
    the slower the motion is for the samples, and so does a held command whose jumps act at once or between the samples,
    and a curve that is drawn in lines. `every` is how many samples of the record there are for one that is simulated.
    """
    least = max(kinks, *(effect.steps for effect in on), 1) * min(band / _KINKED, 1.0)
    if hold == "band-limited":
        least = max(least, band / (_CURVED * (_SLOPE if chain.reads(INPUT_RATE) else 1.0)), 2.0)
    if hold == "zoh" and any(chain.reads(name) for name in (INPUT_RATE, "delay")):
        least = max(least, 2.0)
    following = min(_FOLLOWING * band, np.pi / 2)  # at the latest at half of what a record can show
    size = np.abs(fastest)
    damping = -np.real(fastest) / np.maximum(size, 1e-300)
    longest = np.maximum((_RINGING * np.maximum(damping, 0.0)) ** 0.2, FINE)
    stiff = np.maximum(
        size / np.minimum(longest, _STIFFER), np.minimum(size / np.minimum(longest, _STIFF), float(_OVER))
    )
    closely = np.maximum(np.minimum(size, following) / FINE, stiff)
    ratio = np.maximum(closely, max(least, 1.0))
    return np.asarray(np.minimum(2 ** np.ceil(np.log2(ratio)), _most(every)).astype(np.int64))


def _most(every: int) -> int:
    """Most steps for as many samples of a record, a power of two."""
    return MOST << (every.bit_length() - 1)
