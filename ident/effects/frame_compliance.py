"""The transducer's frame gives way under the force on the specimen."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

FRAME_COMPLIANCE = Effect(
    name="frame_compliance",
    place="load",
    meaning="the frame of the transducer deforms elastically under the force on the specimen",
    does="elastic deformation under the force on the load",
    strength=Parameter("compliance", "s", "m/N", 0.0, 1e-6, 0.0, "compliance of the frame, 1/kf"),
    texts=("X = X + s * F",),
    units={"X": "m"},
    looks="reading too small or too large at resonance, in proportion to the force on the specimen",
    source="compliance between transducer and ground",
)
