"""By what a value that may be zero or negative is measured: a size of the machine itself, where it has one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ident.bench.model import Model
from ident.bench.records import Record
from ident.parameter import Starts
from ident.rounding import TINY


def ends_of_the_way(records: Sequence[Record]) -> tuple[float, float]:
    """The least and the largest position of all records, m."""
    return (
        min(float(record.position.min()) for record in records),
        max(float(record.position.max()) for record in records),
    )


def natural_sizes(model: Model, records: Sequence[Record]) -> Mapping[Starts, float]:
    """The sizes by which the strength of an effect is measured, SI, by what its search begins from.

    A time is as long as T, a pressure as large as ΔPfr, and a pressure over a way takes ΔPfr at both ends of the way.
    """
    low, high = ends_of_the_way(records)
    return {
        Starts.TIME: model.T,
        Starts.FRICTION: model.dPfr,
        Starts.FRICTION_GRADIENT: model.dPfr / max(0.5 * (high - low), TINY),
    }
