"""A spring connects a drive to its load, and the load is recorded."""

from ident.effects.effect import Effect
from ident.effects.second_mass import SHAPE, SHARE, TEXTS, UNITS

ELASTIC_COUPLING = Effect(
    name="elastic_coupling",
    place="sensor",
    meaning="a spring connects the drive to its load, and the motion of the load is recorded",
    does="a mass behind a spring, which is recorded",
    strength=SHARE,
    texts=(
        *TEXTS,
        "X = where(mu > 0, x - xj, X)",
        "v_fb = where(mu > 0, vj, v_fb)",
        "vy = where(mu > 0, vj, vy)",
        "ay = where(mu > 0, wj**2 * xj + 2 * zeta * wj * (v - vj), ay)",
    ),
    units={**UNITS, "X": "m", "v_fb": "m/s", "vy": "m/s", "ay": "m/s^2"},
    shape=SHAPE,
    looks="a resonance, the same at every amplitude, and more phase lag beyond it",
    source="two masses with a spring, sensor and drive at its two ends",
    unless="Ka",
)
