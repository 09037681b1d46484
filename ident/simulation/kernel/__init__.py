"""The compiled simulation of a chain with its effects: generated from the equations, one vector a SIMD lane.

Classical Runge-Kutta steps of order 4, sixteen systems side by side. What an equation writes with `lag`, `lag2` and
`delay`, and a valve that only follows (:mod:`ident.chain.exact_lags`), is advanced exactly over each stage for an input
that is a parabola through its values at the step's start, middle and end, so that a time constant may go to zero
without making the equations stiff, and is an exact identity there. Dry friction is a force held over a step: what
would stop the mass at its end, at most the limit; so it sticks.

One flat buffer holds everything at constant offsets, and comparisons stand for min, max, abs and sgn: only so does the
compiler see that nothing overlaps and put the lanes side by side.
"""

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from ident.chain.chain import Chain
from ident.chain.exact_lags import exact_lags, with_exact_lags
from ident.simulation.kernel.layout import BEYOND, HELD, SHARE, Filter, Kernel
from ident.simulation.kernel.machine_code import LANES, WIDE
from ident.simulation.kernel.source import WRITTEN_OUT, constant
from ident.simulation.kernel.writer import Writer


@lru_cache(maxsize=256)
def kernel(
    chain: Chain,
    output: str,
    plain: frozenset[tuple[str, float]] = frozenset(),
    beside: tuple[str, ...] = (),
    recorded: bool = False,
) -> Kernel:
    """The kernel of a chain for one output; `plain` are symbols that stand as numbers in the code.

    Channels `beside` the output are left in rows of the buffer at every step. Where the command is `recorded`, an
    output that reads its rate at once, as the force on a mass that is moved does, is given the rate at the samples, for
    over the step that begins there it is that of half a step later, and where the command bends within a step.
    """
    written, followers = with_exact_lags(chain), exact_lags(chain)
    return Writer(written, output, dict(plain), beside=beside, followers=followers, recorded=recorded).kernel()


def exponents_in_code(chain: Chain, values: Mapping[str, Any]) -> frozenset[tuple[str, float]]:
    """The exponents of a chain that are `plain` for some `values` of its symbols: one number that is written out.

    Any other number is data of the kernel, so that a fit that searches for it compiles nothing.
    """
    found = {name: np.ravel(values[name]) for name in chain.exponents if name in values}
    return frozenset((name, float(of[0])) for name, of in found.items() if of[0] in WRITTEN_OUT and np.all(of == of[0]))


__all__ = [
    "BEYOND",
    "HELD",
    "LANES",
    "SHARE",
    "WIDE",
    "Filter",
    "Kernel",
    "constant",
    "exponents_in_code",
    "kernel",
]
