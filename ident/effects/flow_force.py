"""The flow through the valve pulls its spool shut."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

FLOW_FORCE = Effect(
    name="flow_force",
    place="valve",
    meaning="flow forces close the spool, in proportion to opening and load pressure",
    does="less drive under load",
    strength=Parameter(
        "coefficient",
        "f",
        "1/Pa",
        0.0,
        1e-6,
        0.0,
        "closing force for each opening and pascal, in the unit of the drive signal",
    ),
    texts=("e = e - f * q1 * abs(P)",),
    units={"e": "m"},
    looks="less gain and a faster valve under load; odd harmonics",
    source="Merritt, Hydraulic Control Systems, steady flow forces; their part that goes with the load pressure",
)
