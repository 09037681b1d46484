"""The curve of a transducer, or of what it measures, bends to one side."""

from ident.effects.effect import Effect
from ident.effects.needs import one_sided_answer
from ident.parameter import Parameter, Starts

SENSOR_CURVE = Effect(
    name="sensor_curve",
    place="sensor",
    meaning="the characteristic of what is recorded is curved to one side, right at both ends of its range",
    does="an output that is curved to one side",
    strength=Parameter(
        "curvature",
        "c",
        "1/m",
        -10.0,
        10.0,
        0.0,
        "relative error for each metre from the end of the range",
        of_motion=True,
    ),
    texts=("y = y * (1 + c * (y - ye))",),
    units={"y": "m"},
    shape=(
        Parameter(
            "end", "ye", "m", 1e-6, 1e3, 1.0, "end of the range", relative=4.0, start=Starts.AS_KNOWN, of_motion=True
        ),
    ),
    looks="a gain that changes with the level; in open loop the dynamics do not change",
    source="terminal-based linearity of a level or pressure gauge, its second-order term; thrust over the speed of a "
    "propeller",
    needs=one_sided_answer,
)
