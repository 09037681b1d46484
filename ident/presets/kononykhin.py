"""The simplified model of an aviation servo-actuator of Kononykhin (2019), section 4, Fig. 1."""

from ident.chain.chain import Chain
from ident.parameter import Parameter
from ident.presets.preset import Preset, Scale
from ident.stages.bench import (
    FRACTIONS,
    LAG,
    OPEN_LOOP,
    PLAY,
    RIGID_TRANSDUCER,
    SPEED_CHARACTERISTIC,
    UNLOADED_SPEED,
    node_names,
)

SOURCE = "Kononykhin 2019, section 4; a middle actuator"
GAIN, ASYMMETRY, NONLINEARITY = 0.1, 0.1, 0.05
"""m/s at rated current; difference of the directions over their mean; distance from the chord over full speed."""


def middle_speed(fraction: float) -> float:
    """f of the middle actuator (m/s) at a fraction of the rated current from the zero shift."""
    side = 1.0 + 0.5 * ASYMMETRY * (1 if fraction > 0 else -1)
    bend = 4.0 * NONLINEARITY
    return GAIN * side * fraction * (1.0 + bend - bend * abs(fraction))


def _speeds() -> tuple[Parameter, ...]:
    out = []
    for name, fraction in zip(node_names(), (*FRACTIONS, *(-f for f in FRACTIONS)), strict=True):
        value = middle_speed(fraction)
        lower, upper = sorted((0.2 * value, 5.0 * value))
        sign = "+" if fraction > 0 else "−"
        printed = f"V({sign}{100 * abs(fraction):g} %)"
        what = f"speed without load and friction at {100 * fraction:+g} % of rated current from the zero shift"
        out.append(Parameter(name, printed, "m/s", lower, upper, value, what, SOURCE))
    return tuple(out)


KONONYKHIN = Preset(
    name="kononykhin",
    title="Aviation servo-actuator: lag, play, speed characteristic, load",
    citation=(
        "E. Kononykhin: Development of procedures for determining the parameters of an aircraft servo actuator. "
        "Eastern-European Journal of Enterprise Technologies (2019)."
    ),
    chain=Chain(
        stages=(OPEN_LOOP, LAG, PLAY, SPEED_CHARACTERISTIC, UNLOADED_SPEED, RIGID_TRANSDUCER),
        outputs={"displacement": "y", "load_pressure": "P"},
    ),
    parameters=(
        Parameter("T", "T", "s", 2e-3, 2e-1, 2e-2, "time constant of amplifier and electronics together", SOURCE),
        Parameter("B", "B", "1", 1e-4, 2e-2, 2e-3, "hysteresis: half-width of the play, in rated currents", SOURCE),
        Parameter("I0", "I₀", "1", -0.1, 0.1, 0.0, "zero shift: the current at which the speed is 0", SOURCE),
        Parameter("kp", "kₚ", "Pa", 5e7, 4e9, 4.2e8, "pressure difference a rated current at rest", SOURCE),
        Parameter("dPfr", "ΔP_fr", "Pa", 5e4, 5e6, 5e5, "pressure difference that overcomes friction", SOURCE),
        *_speeds(),
    ),
    scales=(
        Scale("T", "1", 2e-3, 2e-1),
        Scale("B", "1", 1e-4, 2e-2),
        Scale("I0", "1", -0.1, 0.1, logarithmic=False),
        Scale("kp", "1", 5e7, 4e9),
        Scale("dPfr", "1", 5e4, 5e6),
        *(Scale(p.name, "1", p.lower, p.upper, logarithmic=False) for p in _speeds()),
    ),
    driven_by="current",
    kind="bench",
    methods=("gradient",),
    search={"population": 80.0, "generations": 40.0, "elite": 8.0},
    figures=(
        "time",
        "evolution",
        "pressure-loop",
        "frequency-characteristics",
        "speed-characteristic",
        "acceptance-sheet",
    ),
    notes=(
        "The second derivative in the printed formula of block a is a misprint: the text says an aperiodic link, "
        "T I' + I = Iin. Currents are in rated currents; Ps is the supply pressure of the actuator.",
        "Block d is not in the paper's text. Read here: the pressure difference available at the current behind the "
        "play is clip(kp (I − I0), −Ps, Ps), the load needs F/Sp + ΔPfr sgn V, and the speed is f times "
        "sqrt(max(0, 1 − needed/available)). f is the characteristic without load and friction.",
    ),
)
