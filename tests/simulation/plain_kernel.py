"""The lines of a kernel carried out in plain Python: a chain of any effects is simulated without a compiler.

LLVM takes up to 0.2 s for a kernel. Where many chains are each simulated for a few samples that is most of the time;
`tests/simulation/test_machine_code.py` holds the machine code against the same lines.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from types import CodeType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ident.simulation import simulate
from ident.simulation.kernel import LANES, Kernel

Array = NDArray[np.float64]
CALLS: dict[str, Callable[..., Any]] = {"sqrt": np.sqrt, "pow": np.power, "sin": np.sin, "cos": np.cos, "tanh": np.tanh}


@contextmanager
def plain_kernels() -> Iterator[None]:
    """Simulations carry out the lines of their kernels one lane after the other, all else being as it is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Kernel, "address", lambda kernel, _lanes: (kernel, None))
        patch.setattr(simulate, "advance_groups", advance_groups)
        yield


def advance_groups(
    kernel: Kernel,
    wide: int,
    groups: tuple[int, int],
    buffers: Array,
    u: Array,
    fm: Array,
    u_at: NDArray[np.int64],
    fm_at: NDArray[np.int64],
    first: int,
    last: int,
    every: int,
    out: Array,
    lanes: int,
) -> None:
    """What :func:`ident.simulation.machine_call.advance_groups` does; a lane that repeats the one before is copied."""
    rows, b = out.reshape(-1, lanes), buffers.reshape(lanes // LANES, -1, LANES)
    begun, said = b.copy(), _code(kernel.lines)
    for lane in range(wide * groups[0], wide * groups[1]):
        buffer, own = divmod(lane, LANES)
        before = (buffer, own - 1)
        if (
            lane % wide
            and u_at[lane] == u_at[lane - 1]
            and np.array_equal(begun[buffer, :, own], begun[before[0], :, own - 1])
        ):
            rows[:, lane], b[buffer, :, own] = rows[:, lane - 1], b[buffer, :, own - 1]
            continue
        flat = b[buffer].ravel()
        for k in range(first, last):
            for row, array, column, columns in kernel._fed:
                record, at = (u, u_at) if array == "commands" else (fm, fm_at)
                flat[row * LANES + own] = record[(at[lane] + k + 1) * columns + column]
            with np.errstate(all="ignore"):
                exec(said, {"__builtins__": {}, "b": flat, "lane": own, "k": k, **CALLS})
            if k % every == 0:
                rows[k // every - first // every, lane] = flat[kernel.shown * LANES + own]


@lru_cache(maxsize=4096)
def _code(lines: tuple[str, ...]) -> CodeType:
    return compile("\n".join(lines), "<kernel>", "exec")
