"""The exact response of a linear chain to a sampled command.

Between samples the command is what the run's `hold` says, a polynomial through its values at nodes of the sample (see
:mod:`ident.simulation.intersample_command`), so that the response at the samples is a recursion without any error of
integration:

    s[k+1] = Φ s[k] + Σ_j Γj u(k + τj),   y[k] = C s[k] + D u[k],   Φ = exp(A T)

Sixteen systems run side by side through one command, one a SIMD lane; blocks of samples keep the memory small.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.special import factorial

from ident.linear import LinearModel
from ident.simulation.intersample_command import nodes
from ident.simulation.kernel.machine_code import address
from ident.simulation.machine_call import advance_groups
from ident.time_budget import check_time

Array = NDArray[np.float64]
LANES = 16
_BLOCK = 24_576  # outputs of a block
_TINY = "1e-120"  # added and taken off again: what has died away stays a number whose square is none that costs time


@dataclass(frozen=True)
class Recursion:
    """A batch of b systems in discrete time: Φ (b, n, n), Γ (b, q, n), C (b, n), D (b), start state s0 (b, n)."""

    phi: Array
    gamma: Array
    C: Array
    D: Array
    start: Array

    def packed(self) -> Array:
        """One flat buffer of sixteen lanes, the lane its fastest index: Φ, Γ, C, D, state, then the command at its
        nodes and the output. Spare lanes are zero systems.
        """
        own = [*self._parts, np.zeros((len(self.D), self.gamma.shape[1] + 1))]
        pad = [np.concatenate([a, np.zeros((LANES - len(self.D), *a.shape[1:]))]) for a in own]
        return np.concatenate([np.moveaxis(a, 0, -1).ravel() for a in pad])

    def part(self, first: int, last: int) -> Recursion:
        """The systems first to last − 1 of the batch."""
        return Recursion(*(a[first:last] for a in self._parts))

    def at(self, places: NDArray[np.int64]) -> Recursion:
        """The systems at some places of the batch, in that order."""
        return Recursion(*(a[places] for a in self._parts))

    def beside(self, other: Recursion) -> Recursion:
        """The systems of both batches in one."""
        return Recursion(*(np.concatenate(pair) for pair in zip(self._parts, other._parts, strict=True)))

    @property
    def _parts(self) -> tuple[Array, ...]:
        return self.phi, self.gamma, self.C, self.D, self.start


def discretise(model: LinearModel, sample_rate: float, hold: str) -> Recursion:
    """The recursion of a batch of linear models, shape (b, ...), at rest in the beginning.

    Φ and the responses to τ^m/m! come from one matrix exponential of the system with its input's own dynamics appended:
    a constant for "zoh", and a ramp for "linear" (the exact first-order hold), or more for "band-limited".
    """
    T, at = 1.0 / sample_rate, nodes(hold)
    (batch, n), q = model.B.shape, len(at)
    augmented = np.zeros((batch, n + q, n + q))
    augmented[:, :n, :n] = model.A * T
    augmented[:, :n, n] = model.B * T
    augmented[:, range(n, n + q - 1), range(n + 1, n + q)] = 1.0
    phi = expm(augmented)
    powers = phi[:, :n, n:].transpose(0, 2, 1)
    if hold == "zoh":
        gamma = np.stack([powers[:, 0], np.zeros((batch, n))], axis=1)
    elif hold == "linear":
        gamma = np.stack([powers[:, 0] - powers[:, 1], powers[:, 1]], axis=1)
    else:
        gamma = np.linalg.solve((at[:, None] ** np.arange(q) / factorial(np.arange(q))).T, powers)
    return Recursion(phi[:, :n, :n], gamma, model.C, model.D, np.zeros((batch, n)))


@lru_cache
def advance(order: int, inputs: int = 2) -> Callable[..., None]:
    """The recursion for `order` states: kernel(b, u, first, last, out, lanes) takes the packed buffers b of so many
    lanes over the samples first to last − 1 and writes the outputs to the flat out, a row of lanes a sample.
    Of each sample the command has `inputs` values, at its nodes, one after the other in the flat u.
    """
    n = order
    gamma, C, D = n * n, n * n + inputs * n, n * n + (inputs + 1) * n
    state, given = D + 1, D + 1 + n

    def at(row: int) -> str:
        return f"b[{row * LANES} + lane]"

    reading = " + ".join([f"{at(D)} * {at(given)}", *(f"{at(C + i)} * s{i}" for i in range(n))])
    lines = [*(f"s{i} = {at(state + i)}" for i in range(n)), f"{at(given + inputs)} = {reading}"]
    for i in range(n):
        drive = " + ".join(f"{at(gamma + j * n + i)} * {at(given + j)}" for j in range(inputs))
        terms = " + ".join(f"{at(i * n + j)} * s{j}" for j in range(n))
        lines.append(f"{at(state + i)} = {drive} + {terms} + {_TINY} - {_TINY}")
    fed = tuple((given + j, "shared", j, inputs) for j in range(inputs))
    code, engine = address(tuple(lines), fed, given + inputs, LANES)

    def kernel(b: Array, u: Array, first: int, last: int, out: Array, lanes: int, _kept: object = engine) -> None:
        begins = np.zeros(lanes, np.int64)
        advance_groups(code, LANES, (0, lanes // LANES), b, u, u, begins, begins, first, last, 1, out, lanes)

    return kernel


def responses(recursion: Recursion, u: Array, spare: int = 0) -> Iterator[tuple[Array, int, int]]:
    """Outputs of all systems of a batch to one command at its nodes, (n, q), block by block: (rows, first, last).

    `rows` (samples, lanes) has a column for each system, then at least `spare` of zeros. It is one buffer that every
    block overwrites, small enough to stay in the processor's cache: memory that is touched for the first time costs
    more than the recursion itself.
    """
    batch, order = recursion.C.shape
    lanes = -(-(batch + spare) // LANES) * LANES
    kernel, length, flat = advance(order, u.shape[1]), max(1, _BLOCK // lanes), np.ascontiguousarray(u).ravel()
    buffer = np.empty(length * lanes)
    packed = np.concatenate([recursion.part(i, i + LANES).packed() for i in range(0, lanes, LANES)])
    for first in range(0, len(u), length):
        last = min(first + length, len(u))
        check_time()
        kernel(packed, flat, first, last, buffer, lanes)
        yield buffer[: (last - first) * lanes].reshape(-1, lanes), first, last


def respond(recursion: Recursion, u: Array) -> Array:
    """Outputs of all systems of a batch to one command at its nodes: (n, q) → (b, n)."""
    out = np.empty((len(recursion.D), len(u)))
    for group in range(0, len(out), LANES):
        there = out[group : group + LANES]
        for rows, first, last in responses(recursion.part(group, group + LANES), u):
            there[:, first:last] = rows[:, : len(there)].T
    return out
