"""The compiled loop of a hybrid simulation: substructure, controller, held command, machine, sensors, and back.

At sample k the transducers are read, the controller gives u(k) from d(k) and y(k), which is held from sample k + delay
on, and the substructure takes the measured force and goes to sample k + 1.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ident.simulation.jit import jit
from ident.simulation.machine_call import advance_at

Array = NDArray[np.float64]
LANES = 16
_NEVER = 1 << 40  # steps between rows that a kernel writes: the loop reads the buffer itself


class Rig(NamedTuple):
    """What the loop reads and changes; `L` systems side by side, n samples.

    Of the machine: address, buffer (rows × 16,), its rows of command, displacement and force, steps a sample, the delay
    of the command in them (16,) and whether it has a fraction, lanes that are advanced. `held` (n + delay, L) are the
    commands that act. Of the numerical part: Φ (L, N, N), drives (L, 4, N) of f(k), f̂(k+1), a(k), a(k+1), its storey,
    state (L, N), last force (L,). Of the controller: A, B, C, D and its state (L, m). `ground` (n,), noise (n, 2), the
    converters' steps (2,). `d`, `y` and `f` (n, L) are what is recorded; a lane whose |d| exceeds its `limit` (L,) is
    taken out, its last sample then standing in `ended` (L,).
    """

    code: int
    buffer: Array
    command: int
    displacement: int
    force: int
    steps: int
    whole: NDArray[np.int64]
    broken: NDArray[np.bool_]
    lanes: int
    window: Array
    places: NDArray[np.int64]
    spare: Array
    delay: int
    held: Array
    phi: Array
    drives: Array
    place: int
    z: Array
    before: Array
    A: Array
    B: Array
    C: Array
    D: Array
    x: Array
    ground: Array
    noise: Array
    quantum: Array
    d: Array
    y: Array
    f: Array
    limit: Array
    ended: NDArray[np.int64]
    scratch: Array


@jit(nogil=True)
def _feed(k: int, lane: int, of: int, rig: Any) -> None:
    """The command of a lane, that of system `of`, before, at and behind the steps of sample k.

    The command that follows is not known at the last step where it hangs on this sample: a jump then acts at once on
    what reads its rate, instead of half before and half behind it.
    """
    steps, before, now = rig.steps, rig.command * LANES + lane, (rig.command + 1) * LANES + lane
    begin = k * steps - rig.whole[lane]
    sample, rest = (begin - 1) // steps, (begin - 1) % steps
    for j in range(-1, steps + 1):
        value = 0.0 if sample < 0 else rig.held[min(sample, k + rig.delay - 1), of]
        if j == -1:
            rig.buffer[before] = value
        elif j == 0:
            rig.buffer[now] = value
        else:
            rig.window[lane * steps + j - 1] = value
        rest += 1
        if rest == steps:
            sample, rest = sample + 1, 0
    if rig.delay == 1 and rig.whole[lane] == 0 and not rig.broken[lane]:
        rig.buffer[before] = 2 * rig.buffer[before] - rig.buffer[now]


@jit(nogil=True)
def advance_machine(k: int, rig: Any) -> None:
    """The machine from sample k to k + 1; what its transducers read at k is noted."""
    steps, lanes = rig.steps, rig.held.shape[1]
    for lane in range(rig.lanes):
        _feed(k, lane, min(lane, lanes - 1), rig)
        rig.places[lane] = (lane - k) * steps - 1
    _advance(k * steps, k * steps + 1, rig)
    for lane in range(lanes):
        y = rig.buffer[rig.displacement * LANES + lane] + rig.noise[k, 0]
        f = rig.buffer[rig.force * LANES + lane] + rig.noise[k, 1]
        rig.y[k, lane] = y if rig.quantum[0] == 0 else rig.quantum[0] * np.round(y / rig.quantum[0])
        rig.f[k, lane] = f if rig.quantum[1] == 0 else rig.quantum[1] * np.round(f / rig.quantum[1])
    if steps > 1:
        _advance(k * steps + 1, (k + 1) * steps, rig)


@jit(nogil=True)
def _advance(first: int, last: int, rig: Any) -> None:
    advance_at(
        rig.code, rig.buffer, rig.window, rig.window, rig.places, rig.places, first, last, _NEVER, rig.spare, LANES
    )


@jit(nogil=True)
def control(k: int, lane: int, rig: Any) -> Any:
    """u(k) of the sampled controller, whose state goes on."""
    d, y, x, n = rig.d[k, lane], rig.y[k, lane], rig.x[lane], rig.A.shape[0]
    u = rig.D[0, 0] * d + rig.D[0, 1] * y
    for i in range(n):
        u += rig.C[0, i] * x[i]
    on = rig.scratch[:n]
    for i in range(n):
        on[i] = rig.B[i, 0] * d + rig.B[i, 1] * y
        for j in range(n):
            on[i] += rig.A[i, j] * x[j]
    for i in range(n):
        x[i] = on[i]
    return u


@jit(nogil=True)
def close(k: int, lane: int, u: float, rig: Any) -> None:
    """Hold the command of sample k, and take the numerical part to k + 1."""
    rig.held[k + rig.delay, lane] = u
    f, z, n = rig.f[k, lane], rig.z[lane], rig.z.shape[1]
    guess = 2 * f - rig.before[lane]
    rig.before[lane] = f
    a, then = rig.ground[k], rig.ground[min(k + 1, len(rig.ground) - 1)]
    on, drives = rig.scratch[:n], rig.drives[lane]
    for i in range(n):
        on[i] = drives[0, i] * f + drives[1, i] * guess + drives[2, i] * a + drives[3, i] * then
        for j in range(n):
            on[i] += rig.phi[lane, i, j] * z[j]
    for i in range(n):
        z[i] = on[i]


@jit(nogil=True)
def _watch(k: int, lane: int, rig: Any) -> None:
    """Take a lane out that ran away: its numbers would end in infinities."""
    if not (abs(rig.d[k, lane]) <= rig.limit[lane] and abs(rig.y[k, lane]) <= 10 * rig.limit[lane]):
        rig.ended[lane] = k


@jit(nogil=True)
def advance_under(first: int, last: int, rig: Any) -> Any:
    """Samples first to last − 1 under the sampled controller; how many systems have not run away."""
    lanes = rig.held.shape[1]
    left = lanes
    for k in range(first, last):
        advance_machine(k, rig)
        left = 0
        for lane in range(lanes):
            if rig.ended[lane] < k:
                rig.held[k + rig.delay, lane] = 0.0
                continue
            left += 1
            rig.d[k, lane] = rig.z[lane, rig.place]
            _watch(k, lane, rig)
            close(k, lane, control(k, lane, rig), rig)
        if left == 0:
            break
    return left


@jit(nogil=True)
def read(k: int, rig: Any) -> Any:
    """d(k) and y(k) of the one system there is, for a controller that is no sampled linear one."""
    advance_machine(k, rig)
    rig.d[k, 0] = rig.z[0, rig.place]
    _watch(k, 0, rig)
    return rig.d[k, 0], rig.y[k, 0]
