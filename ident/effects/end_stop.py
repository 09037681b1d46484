"""The stroke ends at a stop that gives way under force."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

END_STOP = Effect(
    name="end_stop",
    place="load",
    meaning="an elastic stop ends the stroke at 1/g on both sides of its middle",
    strength=Parameter(
        "inverse_way",
        "g",
        "1/m",
        0.0,
        1e3,
        0.0,
        "inverse of the distance to the stop",
        start=Starts.STROKE_END,
        of_motion=True,
    ),
    texts=("R = R + ks * sgn(x - xm) * max(abs(x - xm) - 1 / max(g, 1e-9), 0)",),
    units={"R": "N"},
    shape=(
        Parameter("stiffness", "ks", "N/m", 1e3, 1e9, 1e7, "stiffness of the stop", searched=True),
        Parameter(
            "middle", "xm", "m", -10.0, 10.0, 0.0, "middle of the stroke", start=Starts.STROKE_MIDDLE, of_motion=True
        ),
    ),
    looks="displacement is clipped at one level, or needs much more pressure beyond it",
    source="contact with a linear spring",
    steps=2,
    of_place=True,
)
