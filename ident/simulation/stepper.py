"""A chain that a loop outside advances sample by sample, under a held command that is computed on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import STEP, Chain
from ident.errors import Unusable
from ident.simulation.filters import pack_filter
from ident.simulation.kernel import HELD, LANES, SHARE, WIDE, Kernel, constant, exponents_in_code, kernel

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stepper:
    """The kernel of a chain for up to sixteen systems side by side, at rest, and where a loop finds what in it.

    `code` is the address of the kernel's machine code for the first `lanes` lanes, for
    :func:`ident.simulation.machine_call.advance_at`; it lives as long as `kept` does. `buffer` (rows × 16,) holds the
    states and is changed as they go on; `inputs` has the first of the three rows (before, now, then) of the command and
    of each other input, `shown` are the rows of the channels, in their order. Each sample is divided into `steps`; a
    command acts `whole` steps later, (16,), and the fraction `share` of one.
    """

    code: int
    kept: object
    lanes: int
    buffer: Array
    inputs: Mapping[str, int]
    shown: tuple[int, ...]
    steps: int
    whole: NDArray[np.int64]
    share: Array


@dataclass(frozen=True, eq=False)
class PackedKernel:
    """A kernel with its buffer, `rows` (n, 16), at rest under a held command: the lanes beyond those asked for repeat.

    Each sample is divided into `steps`; a command acts `whole` steps later, (16,), and the fraction `share` of one.
    """

    kernel: Kernel
    rows: Array
    steps: int
    whole: NDArray[np.int64]
    share: Array


def packed_kernel(
    chain: Chain,
    values: Mapping[str, Array],
    sample_rate: float,
    steps: int,
    channels: tuple[str, ...],
    driven: tuple[str, ...] = (),
) -> PackedKernel:
    """The kernel of a chain for `values` of every symbol, each (v,) with v at most 16, at `sample_rate` (Hz).

    `channels` are those whose readings are shown at the begin of each step. Raises Unusable where something measured
    drives the chain in addition to its command, but for what the loop says that it is `driven` by: no loop knows it
    beforehand.
    """
    count = max(np.size(value) for value in values.values())
    known = {name: np.array(values[name], dtype=np.float64) for name in chain.symbols}
    known[STEP] = np.array(1.0 / (sample_rate * steps))
    lane = {name: _filled(np.broadcast_to(value, (count,))) for name, value in known.items()}
    built = kernel(chain, channels[0], exponents_in_code(chain, lane), channels[1:])
    if set(built.measured) - set(driven):
        raise Unusable(
            "no-loop",
            "its displacement depends on measured signals other than the command",
            "model",
            "use a model that the command alone drives",
        )
    delay = np.zeros(LANES)
    if built.shift is not None:
        delay = np.broadcast_to(constant(built.shift, lane) / lane[STEP], (LANES,))
    whole = np.floor(delay + 1e-9).astype(np.int64)
    share = np.maximum(delay - whole, 0.0)
    lane |= {HELD: np.ones(LANES), SHARE: share}
    rows = np.zeros((built.rows, LANES))
    built.fill_constants(rows, lane)
    for known_filter in built.filters:
        pack_filter(rows, known_filter, lane)
    return PackedKernel(built, rows, steps, whole, share)


def stepper(
    chain: Chain,
    values: Mapping[str, Array],
    sample_rate: float,
    steps: int,
    channels: tuple[str, ...],
    driven: tuple[str, ...] = (),
) -> Stepper:
    """The stepper of a chain; arguments and refusals are those of :func:`packed_kernel`."""
    packed = packed_kernel(chain, values, sample_rate, steps, channels, driven)
    built, count = packed.kernel, max(np.size(value) for value in values.values())
    lanes = WIDE * -(-count // WIDE)
    code, kept = built.address(lanes)
    shown = (built.shown, *(built.beside[channel] for channel in channels[1:]))
    return Stepper(code, kept, lanes, packed.rows.ravel(), built.inputs, shown, steps, packed.whole, packed.share)


def _filled(values: Array) -> Array:
    return np.concatenate([values, np.full(LANES - len(values), values[-1])])
