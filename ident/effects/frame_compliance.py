"""The transducer's frame gives way under the force on the specimen."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

FRAME_COMPLIANCE = Effect(
    name="frame_compliance",
    place="load",
    meaning="the transducer's frame gives way under the force on the specimen",
    does="give under the force on the load",
    strength=Parameter("compliance", "s", "m/N", 0.0, 1e-6, 0.0, "compliance of the frame, 1/kf"),
    texts=("X = X + s * F",),
    units={"X": "m"},
    looks="reading too small at resonance or too large, in proportion to the specimen's force",
    source="compliance between transducer and ground",
)
