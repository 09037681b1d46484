"""A spring connects a drive to its load, and the drive is recorded."""

from ident.effects.effect import Effect
from ident.effects.second_mass import SHAPE, SHARE, TEXTS, UNITS

ELASTIC_LOAD = Effect(
    name="elastic_load",
    place="load",
    meaning="a spring connects the drive to its load, and the motion of the drive is recorded",
    does="a mass behind a spring",
    strength=SHARE,
    texts=TEXTS,
    units=UNITS,
    shape=SHAPE,
    looks="an antiresonance with a resonance above it, the same at every amplitude",
    source="two masses with a spring, sensor and drive on the same one",
    unless="Ka",
)
