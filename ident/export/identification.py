"""The identification of a bench's actuator as one C header: least squares over its records, for a control unit.

The residual is that of :mod:`ident.bench.residual`: the exact simulation of :mod:`ident.bench.exact_response` with its
derivatives, at the readings that tell a position, each over its deviation, less the mean of each part; and the pressure
difference of the static records. The unit hands out its records sample by sample, as often as the search passes over
them, so no memory grows with them. What each record weighs is that of the set which the header was made from.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ident.bench.analysis import Analysis
from ident.bench.model import Model
from ident.bench.reduced_record import Observed
from ident.bench.speed_table import SPLINE, SpeedTable
from ident.errors import Unusable
from ident.export.bench_code import SIMULATION
from ident.export.c_lines import comment, number
from ident.export.identification_code import CODE

QUANTITIES = (
    "zero_shift", "dead_space", "hysteresis", "kp", "friction", "T", "gain", "gain_forward", "gain_back",
    "nonlinearity", "asymmetry",
)  # fmt: skip
"""What the unit finds of the sheet, in this order."""


def as_identification(analysis: Analysis) -> str:
    """The header for the program of records of an analysed set. Raises Unusable where the set is not whole."""
    whole = analysis.complete().whole
    assert whole is not None
    model, seen = whole.model, whole.residual.observed
    if (
        model.chain is not None
        or any(model.strengths.values())
        or model.table.kind != SPLINE
        or any(one.readings is None for one in seen)
    ):
        raise Unusable(
            "no-export",
            "the model has effects, which a control unit does not identify",
            "fit",
            "identify the actuator without effects",
        )
    steps = {one.readings.step for one in seen if one.readings is not None}
    parts = [part for one in seen for part in one.parts]
    return CODE.substitute(
        records=len(seen),
        parts=max(len(parts), 1),
        nodes=len(model.table.fractions),
        supply=_c(model.Ps),
        converter=number(max(steps)),
        begin=_listed(values_of(model)),
        moving=_listed(values_of(seen[0].moving or model)),
        node_places=_listed(model.table.nodes.tolist()),
        basis=_basis(model.table),
        part_ends=",\n    ".join(f"{{{first}, {end}}}" for first, end in parts) or "{0, 0}",
        table=",\n    ".join(_record(one, sum(len(each.parts) for each in seen[:i])) for i, one in enumerate(seen)),
        order="\n".join(f" *   {i} {comment(one.record.id)}" for i, one in enumerate(seen)),
        names="\n".join(f"#define SERVOIDENT_{name.upper()} {i}" for i, name in enumerate(QUANTITIES)),
        quantities=len(QUANTITIES),
        simulation=SIMULATION,
    )


def values_of(model: Model) -> list[float]:
    """The values that a unit finds, in the order of the header."""
    return [model.T, model.B, model.I0, model.kp, model.dPfr, *model.table.values().values()]


def _record(one: Observed, first_part: int) -> str:
    """A row of the table of records."""
    assert one.readings is not None
    told = one.positions > 0
    fields = (
        one.record.length,
        first_part,
        len(one.parts),
        int(one.record.hold == "zoh"),
        int(told),
        number(1.0 / one.record.rate),
        number(one.readings.extra if told else 1.0),
        number(one.pressure_scale or 0.0),
        number(one.reach),
    )
    return f"{{{', '.join(map(str, fields))}}}"


def _basis(table: SpeedTable) -> str:
    """The pieces of the spline that has the speed 1 at one node and 0 at the others: a table is a sum of these."""
    rows = []
    for place in range(len(table.fractions)):
        unit = tuple(np.eye(len(table.fractions))[place].tolist())
        pieces = SpeedTable(unit, unit, table.fractions, SPLINE).pieces[0]
        rows.append("{" + ",\n     ".join(f"{{{_listed(piece.tolist())}}}" for piece in pieces) + "}")
    return ",\n    ".join(rows)


def _listed(values: Sequence[float]) -> str:
    return ", ".join(map(number, values))


def _c(value: float) -> str:
    """A number that may be infinite."""
    return number(value) if np.isfinite(value) else "HUGE_VAL"
