"""A run that moves ten times as far for its command as another of the same machine: millimetres called centimetres."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import exp, log

import numpy as np

from ident.checks.finding import Finding
from ident.checks.gain import FACTORS
from ident.checks.response import RELATED, Response
from ident.rounding import TINY
from ident.run import Run
from ident.words.message import message

LEAST = 10.0  # a dead zone or dry friction makes small and large commands differ by less
NEAR = 1.3  # either way, for a factor to be that of a wrong unit
ALIKE = 3.0  # from the frequencies with the smallest ratio to those with the largest
BAND = (0.02, 0.98)  # of the command's power
Measured = tuple[Run, Response]


def scale(measured: Sequence[tuple[Run, Response | None]]) -> Iterator[Finding]:
    """A doubt for each run whose output is a wrong unit's factor from that of the others under the same conditions."""
    known = [(run, response) for run, response in measured if response is not None]
    for run, response in known[1:] if len(known) == 2 else known:
        others = [other for other in known if other[0] is not run and _conditions(other[0]) == _conditions(run)]
        found = [ratio for other in others if (ratio := _ratio((run, response), other)) is not None]
        size = float(np.median(found)) if found else 0.0
        factor = min((f for f in FACTORS if f >= LEAST), key=lambda each: abs(abs(size) - log(each)))
        if abs(abs(size) - log(factor)) < log(NEAR) and _as_far(run, [other for other, _ in others], size):
            values = {"ratio": exp(size), "factor": factor, "units": FACTORS[factor]}
            names = {"channel": run.output, "run": run.id, "others": [other.id for other, _ in others]}
            yield Finding.of(run.id, "doubt", "scale", message("check.scale", **names, **values))


def _as_far(run: Run, others: Sequence[Run], size: float) -> bool:
    """Whether the record's extent, too, is out of the others' by half of that factor at least, in logarithms.

    A fast command leaves a machine of limited speed behind at every frequency, but not in how far it once went.
    """
    usual = float(np.median([_extent(other) for other in others]))
    return (_extent(run) - usual) / size > 0.5


def _extent(run: Run) -> float:
    """The logarithm of how far the output goes for its command."""
    return log(max(np.ptp(run.measured), TINY) / max(np.ptp(run.command), TINY))


def _conditions(run: Run) -> tuple[object, ...]:
    return run.output, run.specimen, run.gain, run.units.get("command"), run.units.get(run.output)


def _ratio(one: Measured, other: Measured) -> float | None:
    """The logarithm of the ratio of two gains where both commands have power.

    None where they have it nowhere, and where the ratio is another at one frequency than at the next: a wrong unit is
    the same factor at all of them, a limit of the speed is not.
    """
    (_, first), (_, second) = one, other
    used = first.between(*BAND) & (first.coherence > RELATED)
    beside = second.between(*BAND) & (second.coherence > RELATED)
    if not used.any() or not beside.any():
        return None
    low, high = second.frequency[beside][[0, -1]]
    used &= (first.frequency >= low) & (first.frequency <= high)
    if not used.any():
        return None
    gain = np.interp(first.frequency[used], second.frequency[beside], np.log(np.abs(second.gain[beside])))
    ratios = np.log(np.abs(first.gain[used])) - gain
    low, high = np.quantile(ratios, [0.1, 0.9])
    return float(np.median(ratios)) if high - low < log(ALIKE) else None
