"""Controller: from command and fed-back position to the valve's drive signal."""

from ident.parameter import Parameter, Starts
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, Stage, stage

PROPORTIONAL = stage(
    "controller",
    (
        Quantity("r", "m", "command as it acts"),
        Quantity("dr", "m/s", "rate of the command"),
        Quantity("y_in", "m", "position that the controller uses"),
        Quantity("v_in", "m/s", "rate of that position"),
        Quantity("e", "m", "drive signal, in metres times the dial of the gain"),
    ),
    ("r = u", "the command acts without delay"),
    ("dr = du", "rate of the command"),
    ("y_in = y_fb", "the controller reads the transducer without delay"),
    ("v_in = v_fb", "rate of the same reading"),
    ("e = Kp * (r - y_in)", "proportional position loop with gain Kp (Qian et al. 2014, section 2.1.1)"),
)

OPENED_BY_COMMAND = stage(
    "controller",
    (
        Quantity("r", "m", "command as it acts"),
        Quantity("dr", "m/s", "rate of the command"),
        Quantity("e", "m", "drive signal: the opening that is asked for"),
    ),
    ("r = u", "the command acts without delay"),
    ("dr = du", "rate of the command"),
    ("e = r", "no loop: the command opens the valve"),
)

_INTEGRAL = Parameter("KI", "K_I", "1/s", 0.0, 1e6, 0.0, "integral gain, in the unit of the dial", ORDER_OF_MAGNITUDE)
_DERIVATIVE = Parameter(
    "KD", "K_D", "s", 0.0, 1e6, 0.0, "derivative gain, in the unit of the dial", ORDER_OF_MAGNITUDE, start=Starts.TIME
)
_FILTER = Parameter(
    "Tf", "T_f", "s", 1e-6, 1e2, 1e-3, "time constant of the derivative's filter", ORDER_OF_MAGNITUDE, start=Starts.TIME
)
_OF_SPEED = Parameter(
    "Tv",
    "T_v",
    "s",
    1e-5,
    1e2,
    1e-2,
    "gain of the speed loop over that of the position loop",
    ORDER_OF_MAGNITUDE,
    start=Starts.TIME,
)


def _law(
    text: str,
    meaning: str,
    states: tuple[tuple[Quantity, str, str], ...] = (),
    parameters: tuple[Parameter, ...] = (),
    scales: tuple[Scale, ...] = (),
) -> Stage:
    """The controller with another law, whose states integrate what their equations say."""
    made = PROPORTIONAL.with_equations((text, meaning))
    extra = stage("controller", tuple(q for q, _, _ in states), *((line, said) for _, line, said in states))
    return Stage(
        "controller", (*made.publishes, *extra.publishes), (*made.equations, *extra.equations), parameters, scales
    )


_RESET = (
    "the error is integrated, as far as the drive signal follows it (automatic reset, Åström and Murray 2021, 11.4)"
)
_ERROR_SUM = (Quantity("ei", "m*s", "integral of the error"), "ei' = (e - KI * ei) / Kp", _RESET)
_ERROR_OF_PID = (_ERROR_SUM[0], "ei' = (e - KI * ei - KD * (r - y_in - ef) / Tf) / Kp", _RESET)
_ERROR_LAG = (Quantity("ef", "m", "error behind the filter"), "ef' = (r - y_in - ef) / Tf", "the error is filtered")

PI = _law(
    "e = Kp * (r - y_in) + KI * ei",
    "proportional and integral",
    (_ERROR_SUM,),
    (_INTEGRAL,),
    (Scale("KI", "Kp * W", 0.0, 1e1, logarithmic=False),),
)

PID = _law(
    "e = Kp * (r - y_in) + KI * ei + KD * (r - y_in - ef) / Tf",
    "proportional, integral, and filtered derivative",
    (_ERROR_OF_PID, _ERROR_LAG),
    (_INTEGRAL, _DERIVATIVE, _FILTER),
    (
        Scale("KI", "Kp * W", 0.0, 1e1, logarithmic=False),
        Scale("KD", "Kp / W", 0.0, 1e1, logarithmic=False),
        Scale("Tf", "1 / W", 1e-2, 1e0),
    ),
)

SPEED_INSIDE = _law(
    "e = Kp * (r - y_in - Tv * v_in)",
    "position loop around a speed loop, the gain of the outer one on the dial",
    parameters=(_OF_SPEED,),
    scales=(Scale("Tv", "1 / W", 1e-3, 1e2),),
)
