"""A part of the specimen's stiffness relaxes: a spring and a damper in series, after Maxwell."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import Parameter, Starts

RELAXATION = Effect(
    name="relaxation",
    place="load",
    meaning="a part of the specimen's stiffness relaxes: a spring and a damper in series, as of rubber and polymers",
    does="a force that relaxes",
    strength=Parameter("stiffness", "kr", "N/m", 0.0, 1e8, 0.0, "stiffness that relaxes"),
    texts=(
        "xm' = vL - xm / Tr",
        "S = S + kr * xm",
    ),
    units={"S": "N"},
    shape=(Parameter("time", "Tr", "s", 1e-3, 1e1, 0.1, "relaxation time", searched=True, start=Starts.RELAXATION),),
    looks="stiffer when moved quickly; a force that falls while the motion is held; loops widest at one frequency",
    source="Maxwell element; beside a spring it is the standard linear solid of Zener",
    needs=force_answers,
    of_specimen=True,
)
