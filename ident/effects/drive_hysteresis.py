"""What drives the output lags behind itself by its own way: a piezo, a tendon, a hose or a magnet with hysteresis."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

DRIVE_HYSTERESIS = Effect(
    name="drive_hysteresis",
    place="load",
    meaning="what drives the output has hysteresis: a part of its way comes only behind a reversal",
    does="a loop of output over command that does not depend on the speed",
    strength=Parameter("share", "s", "1", 0.0, 1.0, 0.0, "share of the way that is missing right after a reversal"),
    texts=(
        "z := sgn(xi - xr) + (z - sgn(xi - xr)) * exp(-kx * abs(xi - xr))",
        "xr := xi",
        "xi = xi - s * z / kx",
    ),
    units={"xi": "m"},
    shape=(
        Parameter(
            "inverse_way",
            "kx",
            "1/m",
            1e-1,
            1e2,
            1e1,
            "inverse of the way after a reversal over which the part comes",
            searched=True,
            of_motion=True,
        ),
    ),
    looks="another output upwards than downwards at the same command, however slow it is",
    source=(
        "Coleman and Hodgdon 1986 (ferromagnets), of piezoelectric actuators Adriaens, de Koning and Banning 2000: "
        "z' = kx (w' - |w'| z), here advanced exactly over the way of a step"
    ),
    unless="tau1",
)
