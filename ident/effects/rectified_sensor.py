"""The transducer does not see the sign of the speed."""

from ident.effects.effect import Effect
from ident.effects.needs import rectified
from ident.parameter import Parameter

RECTIFIED_SENSOR = Effect(
    name="rectified_sensor",
    place="sensor",
    meaning="the recorded speed is its absolute value",
    strength=Parameter("share", "s", "1", 0.0, 1.0, 0.0, "share of the speed that is recorded without its sign"),
    texts=("vy = vy + s * (abs(vy) - vy)",),
    units={"vy": "m/s"},
    looks="a speed that never falls below zero, with cusps where the motion reverses",
    source="a pulse counter without direction; Wigren and Schoukens 2017",
    steps=2,
    needs=rectified,
    shown=True,
    whole=True,
)
