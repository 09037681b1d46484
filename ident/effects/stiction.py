"""A link that rests needs more pressure to break loose than to go on moving."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

STICTION = Effect(
    name="stiction",
    place="load",
    meaning="a link at rest needs more pressure than friction to break away",
    strength=Parameter(
        "pressure",
        "Pst",
        "Pa",
        0.0,
        5e6,
        0.0,
        "pressure difference above friction at breakaway",
        start=Starts.FRICTION,
    ),
    texts=(
        "g := where(Pa > Pn + Pst * (1 - g), 1, 0)",
        "Pn = Pn + Pst * (1 - g)",
    ),
    units={"Pn": "Pa"},
    looks="movements begin late and with a jump; before them the pressure exceeds friction",
    source="static friction above the sliding one; g is 1 while the link moves",
    stride=2e-3,
)
