"""The compiled loop of a hybrid simulation: substructure, controllers, held commands, machines, sensors, and back.

At sample k the transducers are read, each controller gives u(k) from d(k) and y(k) of its actuator, which is held from
sample k + delay on, and the substructure takes the measured forces and goes to sample k + 1.

Where a specimen joins several actuators, each feels what the motion of the others makes it feel,

    E_i = Σ_{j≠i} K_ij x_j + C_ij x_j' + M_ij x_j''    N

It is known at the begin of the steps before, and goes on along the line through the last two: an explicit multistep
method of second order (Adams and Bashforth) beside the Runge-Kutta steps of each machine. The accelerations in it are
those that all the machines have together, (M_i δ_ij + M_ij) x'' = b.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ident.simulation.jit import in_place, inlined, within
from ident.simulation.machine_call import advance_from

Array = NDArray[np.float64]
Whole = NDArray[np.int64]
LANES = 16
COMMAND, DISPLACEMENT, FORCE, INTERACTION, POSITION, SPEED, ACCELERATION = map(np.int64, range(7))
"""The columns of `rows`: of its command and of what a kernel shows; the last four where a specimen joins actuators.

NumPy's integers have one type, and each of Python's constants one of its own, for which a function is compiled anew.
"""
ROWS = 7
WHOLE, BEFORE, BEHIND = map(np.int64, range(3))
"""What of a sample is done: all of it, what comes before controllers are asked, or what follows their commands."""
_NEVER = 1 << 40  # steps between rows that a kernel writes: the loop reads the buffer itself


class Rig(NamedTuple):
    """What the loop reads and changes: `L` systems side by side, each of `P` actuators, n samples.

    A column c = system × P + actuator is a machine in its lane of a kernel. Of the kernels (G): address, where its
    buffer (rows × 16) begins in `buffer`, its `rows`, steps a sample, lanes that are advanced and what column each is
    (G, 16); delay of the command in steps (G, 16) and whether it has a fraction; what they are fed from. Of the
    columns: its kernel, its lane, its part, the samples of `delay`. `held` (n + delay, C) are the commands that act.
    Of what joins specimens: K, C and M beside the diagonal (3, P, P), inverse of the joint mass (L, P, P), masses of
    machine and of specimen (2, C), what acts and what acted at the last two steps (3, C). Of the numerical part: Φ
    (L, N, N), drives (L, 2P + 2, N) of each f(k) and f̂(k+1), then a(k), a(k+1), its places (P,), state (L, N), last
    forces (C,). Of the controllers: A, B, C, D (P, …), which are such ones (P,), states (C, m) and
    what was computed `ahead` (…, P). `ground` (n,), noise (P, n, 2), the converters' steps (P, 2). `d`, `y` and `f`
    (n, C) are what is recorded; a system of which a |d| exceeds its `limit` (C,) is taken out, its last sample then
    standing in `ended` (L,).
    """

    code: Whole
    begin: Whole
    buffer: Array
    rows: Whole
    steps: Whole
    lanes: Whole
    column: Whole
    whole: Whole
    broken: NDArray[np.bool_]
    window: Array
    window_at: Whole
    places: Whole
    pushes: Array
    pushed_at: Whole
    spare: Array
    kernel: Whole
    lane: Whole
    part: Whole
    delay: Whole
    held: Array
    joined: bool
    coupling: Array
    inverse: Array
    masses: Array
    interaction: Array
    phi: Array
    drives: Array
    place: Whole
    z: Array
    before: Array
    A: Array
    B: Array
    C: Array
    D: Array
    sampled: NDArray[np.bool_]
    x: Array
    ahead: Array
    ground: Array
    noise: Array
    quantum: Array
    d: Array
    y: Array
    f: Array
    limit: Array
    ended: Whole
    scratch: Array
    u: Array


# Machines -----------------------------------------------------------------------------------------------------------


@inlined
def _feed(k: int, g: int, rig: Any) -> None:
    """The commands of the lanes of a kernel before, at and behind the steps of sample k.

    The command that follows is not known at the last step where it hangs on this sample: a jump then acts at once on
    what reads its rate, instead of half before and half behind it.
    """
    steps, first, at = rig.steps[g], rig.begin[g] + rig.rows[g, COMMAND] * LANES, g * LANES
    for lane in range(rig.lanes[g]):
        of, row = rig.column[g, lane], first + lane
        latest = k + rig.delay[of] - 1
        begin = k * steps - rig.whole[g, lane]
        sample, rest = (begin - 1) // steps, (begin - 1) % steps
        window = rig.window_at[g] + lane * steps
        for j in range(-1, steps + 1):
            value = 0.0 if sample < 0 else rig.held[min(sample, latest), of]
            if j == -1:
                rig.buffer[row] = value
            elif j == 0:
                rig.buffer[row + LANES] = value
            else:
                rig.window[window + j - 1] = value
            rest += 1
            if rest == steps:
                sample, rest = sample + 1, 0
        if rig.delay[of] == 1 and rig.whole[g, lane] == 0 and not rig.broken[g, lane]:
            rig.buffer[row] = 2 * rig.buffer[row] - rig.buffer[row + LANES]
        rig.places[at + lane] = window - k * steps - 1


@within()
def _advance_machines(k: int, rig: Any) -> None:
    """The machines from sample k to k + 1; what their transducers read at k is noted."""
    for g in range(len(rig.code)):
        _feed(k, g, rig)
    if rig.joined:
        _advance_joined(k, rig)
        return
    for g in range(len(rig.code)):
        _advance(g, k * rig.steps[g], k * rig.steps[g] + 1, rig)
    for c in range(rig.held.shape[1]):
        _read(k, c, 0.0, rig)
    for g in range(len(rig.code)):
        if rig.steps[g] > 1:
            _advance(g, k * rig.steps[g] + 1, (k + 1) * rig.steps[g], rig)


@inlined
def _advance(g: int, first: int, last: int, rig: Any) -> None:
    advance_from(
        rig.code[g],
        rig.buffer,
        rig.begin[g],
        rig.window,
        rig.pushes,
        rig.places,
        rig.pushed_at,
        g * LANES,
        first,
        last,
        _NEVER,
        rig.spare,
        LANES,
    )


@inlined
def _shown(c: int, what: int | np.int64, rig: Any) -> Any:
    """What the kernel of a column shows of it."""
    g = rig.kernel[c]
    return rig.buffer[rig.begin[g] + rig.rows[g, what] * LANES + rig.lane[c]]


@inlined
def _read(k: int, c: int, beside: float, rig: Any) -> None:
    """The transducers of a column at sample k; the load cell reads a force `beside` that of the kernel."""
    p = rig.part[c]
    y = _shown(c, DISPLACEMENT, rig) + rig.noise[p, k, 0]
    f = _shown(c, FORCE, rig) + beside + rig.noise[p, k, 1]
    rig.y[k, c] = y if rig.quantum[p, 0] == 0 else rig.quantum[p, 0] * np.round(y / rig.quantum[p, 0])
    rig.f[k, c] = f if rig.quantum[p, 1] == 0 else rig.quantum[p, 1] * np.round(f / rig.quantum[p, 1])


# What joins them ----------------------------------------------------------------------------------------------------


@inlined
def _advance_joined(k: int, rig: Any) -> None:
    """As :func:`_advance_machines`, step by step: each machine gets the force that the others exert on it."""
    steps, parts = rig.steps[0], len(rig.place)
    for step in range(k * steps, (k + 1) * steps):
        for g in range(len(rig.code)):
            for lane in range(rig.lanes[g]):
                c = rig.column[g, lane]
                last, earlier = rig.interaction[1, c], rig.interaction[2, c]
                rig.interaction[0, c] = 2 * last - earlier
                rig.buffer[rig.begin[g] + (rig.rows[g, INTERACTION] + 1) * LANES + lane] = 2 * last - earlier
                rig.pushes[g * LANES + lane] = 3 * last - 2 * earlier
                rig.pushed_at[g * LANES + lane] = g * LANES + lane - step - 1
            _advance(g, step, step + 1, rig)
        for system in range(len(rig.phi)):
            _interact(k if step == k * steps else -1, system, parts, rig)


@inlined
def _interact(k: int, system: int, parts: int, rig: Any) -> None:
    """What the machines of a system feel of each other at the begin of the step; at sample k, if any, they are read."""
    felt, push, a = 0, parts, 2 * parts  # where each stands in `rig.u`
    first = system * parts
    for i in range(parts):
        still = 0.0
        for j in range(parts):
            still += rig.coupling[0, i, j] * _shown(first + j, POSITION, rig)
            still += rig.coupling[1, i, j] * _shown(first + j, SPEED, rig)
        moved = rig.masses[0, first + i]
        alone = moved * _shown(first + i, ACCELERATION, rig) if moved else 0.0
        rig.u[felt + i] = still
        rig.u[push + i] = alone + rig.interaction[0, first + i] - still
    for i in range(parts):
        rig.u[a + i] = 0.0
        for j in range(parts):
            rig.u[a + i] += rig.inverse[system, i, j] * rig.u[push + j]
    for i in range(parts):
        for j in range(parts):
            rig.u[felt + i] += rig.coupling[2, i, j] * rig.u[a + j]
        if k >= 0:
            changed = rig.u[a + i] - _shown(first + i, ACCELERATION, rig) if rig.masses[0, first + i] else 0.0
            beyond = rig.u[felt + i] - rig.interaction[0, first + i]
            _read(k, first + i, beyond + rig.masses[1, first + i] * changed, rig)
        rig.interaction[2, first + i] = rig.interaction[1, first + i]
        rig.interaction[1, first + i] = rig.u[felt + i]


# The rest of the loop -----------------------------------------------------------------------------------------------


@inlined
def _control(k: int, c: int, rig: Any) -> Any:
    """u(k) of the sampled controller of a column, whose state goes on, with what was computed ahead."""
    p, d, y, n = rig.part[c], rig.d[k, c], rig.y[k, c], rig.x.shape[1]
    u = rig.D[p, 0, 0] * d + rig.D[p, 0, 1] * y + rig.ahead[min(k, len(rig.ahead) - 1), p]
    for i in range(n):
        u += rig.C[p, 0, i] * rig.x[c, i]
    for i in range(n):
        rig.scratch[i] = rig.B[p, i, 0] * d + rig.B[p, i, 1] * y
        for j in range(n):
            rig.scratch[i] += rig.A[p, i, j] * rig.x[c, j]
    for i in range(n):
        rig.x[c, i] = rig.scratch[i]
    return u


@inlined
def _close(k: int, system: int, rig: Any) -> None:
    """Take the numerical part of a system to sample k + 1, by the forces that were measured."""
    parts, n = len(rig.place), rig.z.shape[1]
    a, then = rig.ground[k], rig.ground[min(k + 1, len(rig.ground) - 1)]
    for i in range(n):
        rig.scratch[i] = 0.0
    for p in range(parts):
        c = system * parts + p
        f = rig.f[k, c]
        guess = 2 * f - rig.before[c]
        rig.before[c] = f
        for i in range(n):
            rig.scratch[i] += rig.drives[system, 2 * p, i] * f
            rig.scratch[i] += rig.drives[system, 2 * p + 1, i] * guess
    for i in range(n):
        on = rig.scratch[i] + rig.drives[system, 2 * parts, i] * a
        on += rig.drives[system, 2 * parts + 1, i] * then
        for j in range(n):
            on += rig.phi[system, i, j] * rig.z[system, j]
        rig.scratch[i] = on
    for i in range(n):
        rig.z[system, i] = rig.scratch[i]


@inlined
def _ask(k: int, system: int | np.int64, rig: Any) -> None:
    """What the substructure asks of the actuators of a system; one that ran away is taken out.

    Its numbers would end in infinities.
    """
    parts = len(rig.place)
    for c in range(system * parts, (system + 1) * parts):
        rig.d[k, c] = rig.z[system, rig.place[c - system * parts]]
        if not (abs(rig.d[k, c]) <= rig.limit[c] and abs(rig.y[k, c]) <= 10 * rig.limit[c]):
            rig.ended[system] = k


@in_place()
def advance_under(first: int, last: int, part: int | np.int64, rig: Any) -> Any:
    """This part of samples first to last − 1; how many systems have not run away.

    The commands of controllers that are not sampled linear ones stand in `held` before what is done :data:`BEHIND`.
    """
    parts, systems = len(rig.place), len(rig.ended)
    left = systems
    for k in range(first, last):
        if part != BEHIND:
            _advance_machines(k, rig)
        left = 0
        for system in range(systems):
            columns = range(system * parts, (system + 1) * parts)
            if rig.ended[system] < k:
                for c in columns:
                    rig.held[k + rig.delay[c], c] = 0.0
                continue
            left += 1
            if part != BEHIND:
                _ask(k, system, rig)
            if part != BEFORE:
                for c in columns:
                    if rig.sampled[rig.part[c]]:
                        rig.held[k + rig.delay[c], c] = _control(k, c, rig)
                _close(k, system, rig)
        if left == 0:
            break
    return left
