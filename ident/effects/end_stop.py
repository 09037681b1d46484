"""The stroke ends at a stop that gives way under force."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

END_STOP = Effect(
    name="end_stop",
    place="load",
    meaning="the stroke ends, at 1/g to both sides of its middle, at a stop that gives way",
    strength=Parameter(
        "inverse_way",
        "g",
        "1/m",
        0.0,
        1e3,
        0.0,
        "inverse of the way to the stop",
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
    looks="displacements beyond a certain one are cut, or need much more pressure",
    source="contact with a linear spring",
    steps=2,
)
