"""The weight of an arm turns with its angle."""

from ident.effects.effect import Effect
from ident.effects.needs import angle_measured
from ident.parameter import Parameter, Starts

ARM_GRAVITY = Effect(
    name="arm_gravity",
    place="load",
    meaning="the weight of an arm resists in proportion to the sine of its angle",
    strength=Parameter(
        "torque", "G", "N", 0.0, 1e4, 0.0, "torque of the weight with the arm held level", of_motion=True
    ),
    texts=("R = R + G * sin((x - x0) / ra)",),
    units={"R": "N"},
    shape=(
        Parameter("hanging", "x0", "m", -3.2, 3.2, 0.0, "angle at which the arm hangs down", searched=True),
        Parameter(
            "gear", "ra", "m", 1e-2, 1e2, 1.0, "measured angle for each radian of the arm", start=Starts.AS_KNOWN
        ),
    ),
    looks="a load torque that varies as the sine of the angle; oscillation about the hanging position",
    source="pendulum behind a gear: J x'' = -m g l sin((x - x0)/r)",
    needs=angle_measured,
    takes_over=("k0",),
)
