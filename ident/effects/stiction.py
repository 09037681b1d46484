"""A link that rests needs more pressure to break loose than to go on moving."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

STICTION = Effect(
    name="stiction",
    place="load",
    meaning="pressure above friction that breaks a resting link loose",
    strength=Parameter(
        "pressure",
        "Pst",
        "Pa",
        0.0,
        5e6,
        0.0,
        "pressure difference above friction that breaks loose",
        start=Starts.FRICTION,
    ),
    texts=(
        "g := where(Pa > Pn + Pst * (1 - g), 1, 0)",
        "Pn = Pn + Pst * (1 - g)",
    ),
    units={"Pn": "Pa"},
    looks="movements that begin late and with a jump, and pressures beyond friction before them",
    source="static friction above the sliding one; g is 1 while the link moves",
    stride=2e-3,
)
