"""Kononykhin's blocks: open loop, play, speed characteristic, and a load that takes its share of the speed."""

from functools import lru_cache

from ident.parameter import Parameter, Starts
from ident.stages.scale import Scale
from ident.stages.stage import Quantity, stage

FRACTIONS = (0.05, 0.1, 0.25, 0.5, 0.75, 1.0)
"""Where the speed characteristic has its nodes, in rated currents from the zero shift; denser for small signals."""
SOURCE = "Kononykhin 2019, section 4; a middle actuator"
GAIN, ASYMMETRY, NONLINEARITY = 0.1, 0.1, 0.05
"""m/s at rated current; difference of the directions over their mean; distance from the chord over full speed."""


@lru_cache
def node_names(fractions: tuple[float, ...] = FRACTIONS) -> tuple[str, ...]:
    """Names of the speeds of the table: V_p5 at +5 % of rated current … , V_m5 at −5 % … ."""
    return tuple(f"V_{sign}{100 * fraction:.4g}".replace(".", "_") for sign in "pm" for fraction in fractions)


OPEN_LOOP = stage(
    "controller",
    (
        Quantity("r", "1", "current as it acts, in the unit of the record"),
        Quantity("e", "1", "control signal, in rated currents"),
    ),
    ("r = u", "the current acts without delay"),
    ("e = r / Ir", "unit: rated current"),
)

LAG_TIME = Parameter(
    "T", "T", "s", 2e-3, 2e-1, 2e-2, "time constant of amplifier and electronics together", SOURCE, start=Starts.TIME
)

LAG = stage(
    "valve",
    (
        Quantity("q1", "1", "current behind the lag, in rated currents"),
        Quantity("dq", "1/s", "rate of the command"),
        Quantity("q", "1", "output current of the valve, in rated currents"),
    ),
    ("dq = (e - q1) / T", "block a: T I' + I = Iin (Kononykhin, section 4)"),
    ("q1' = dq", "the lag integrates its rate"),
    ("q = q1", "no additional valve dynamics"),
    parameters=(LAG_TIME,),
    scales=(Scale.by_bounds(LAG_TIME),),
)

HALF_WIDTH = Parameter("B", "B", "1", 1e-4, 2e-2, 2e-3, "hysteresis: half-width of the play, in rated currents", SOURCE)
ZERO_SHIFT = Parameter("I0", "I₀", "1", -0.1, 0.1, 0.0, "zero shift: the current at which the speed is 0", SOURCE)

PLAY = stage(
    "spool",
    (
        Quantity("wb", "1", "current behind the play, in rated currents"),
        Quantity("w", "1", "current behind hysteresis, from the zero shift"),
    ),
    ("wb := clip(wb__old, q - B, q + B)", "block b: play of half-width B (Kononykhin, section 4)"),
    ("w = wb - I0", "counted from the zero shift"),
    parameters=(HALF_WIDTH, ZERO_SHIFT),
    scales=(Scale.by_bounds(HALF_WIDTH), Scale.by_bounds(ZERO_SHIFT, logarithmic=False)),
)


def _side(sign: str, names: tuple[str, ...]) -> str:
    nodes = ", ".join(f"{fraction:g}, {sign}{name}" for fraction, name in zip(FRACTIONS, names, strict=True))
    return f"monotone(max({sign}w, 0), 0, 0, {nodes})"


def middle_speed(fraction: float) -> float:
    """f of the middle actuator (m/s) at a fraction of the rated current from the zero shift."""
    side = 1.0 + 0.5 * ASYMMETRY * (1 if fraction > 0 else -1)
    bend = 4.0 * NONLINEARITY
    return GAIN * side * fraction * (1.0 + bend - bend * abs(fraction))


def _speed(name: str, fraction: float) -> Parameter:
    value = middle_speed(fraction)
    lower, upper = sorted((0.2 * value, 5.0 * value))
    printed = f"V({'+' if fraction > 0 else '−'}{100 * abs(fraction):g} %)"
    what = f"speed without load and friction at {100 * fraction:+g} % of rated current from the zero shift"
    return Parameter(name, printed, "m/s", lower, upper, value, what, SOURCE)


_NAMES = node_names()
_HALF = len(FRACTIONS)
SPEEDS = tuple(map(_speed, _NAMES, (*FRACTIONS, *(-fraction for fraction in FRACTIONS))))

SPEED_CHARACTERISTIC = stage(
    "flow",
    (
        Quantity("Vf", "m/s", "speed forward without load and friction"),
        Quantity("Vb", "m/s", "speed back without load and friction, counted positive"),
        Quantity("V0", "m/s", "speed without load and friction"),
    ),
    (f"Vf = {_side('', _NAMES[:_HALF])}", "block c: table of the speed characteristic, forward"),
    (f"Vb = {_side('-', _NAMES[_HALF:])}", "block c: table of the speed characteristic, back"),
    ("V0 = Vf - Vb", "block c: V0 = f(I), zero at the zero shift"),
    parameters=SPEEDS,
    scales=tuple(Scale.by_bounds(speed, logarithmic=False) for speed in SPEEDS),
)

PRESSURE_GAIN = Parameter("kp", "kₚ", "Pa", 5e7, 4e9, 4.2e8, "pressure difference a rated current at rest", SOURCE)
FRICTION = Parameter("dPfr", "ΔP_fr", "Pa", 5e4, 5e6, 5e5, "pressure difference that overcomes friction", SOURCE)

UNLOADED_SPEED = stage(
    "load",
    (
        Quantity("s", "1", "direction commanded by the current"),
        Quantity("Pa", "Pa", "pressure difference available at the current"),
        Quantity("F", "N", "force of the specimen's spring"),
        Quantity("Pn", "Pa", "pressure difference needed against load and friction"),
        Quantity("P", "Pa", "pressure difference of the cavities"),
        Quantity("v", "m/s", "speed"),
        Quantity("x", "m", "position"),
        Quantity("X", "m", "position of what the transducer is fixed to"),
    ),
    ("s = sgn(w)", "the direction of the current from the zero shift"),
    ("Pa = min(kp * abs(w), Ps)", "block d: the available pressure rises with kp up to the supply's"),
    ("F = k * x", "the load; its mass and damping take no part"),
    ("Pn = s * F / A + dPfr", "block d: load and friction need their pressure"),
    ("P = s * where(Pa > Pn, Pn, Pa)", "at rest what is available, in motion what is needed"),
    (
        "v = V0 * where(Pa > Pn, sqrt(max(0, 1 - Pn / max(Pa, 1))), 0)",
        "block d: the share of the speed that load and friction leave",
    ),
    ("x' = v", "position is the integral of speed"),
    ("X = x", "the transducer's frame is rigid"),
    parameters=(PRESSURE_GAIN, FRICTION),
    scales=(Scale.by_bounds(PRESSURE_GAIN), Scale.by_bounds(FRICTION)),
)

RIGID_TRANSDUCER = stage(
    "sensor",
    (Quantity("y", "m", "position that is recorded"),),
    ("y = X", "ideal transducer; 12 bits in simulated records only"),
)
