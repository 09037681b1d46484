"""A drive without force beyond a speed."""

from ident.effects.effect import Effect
from ident.effects.needs import force_commanded
from ident.parameter import Parameter, Starts

SPEED_LIMIT = Effect(
    name="speed_limit",
    place="pressure",
    meaning="the force of the drive ends at a speed, as of a motor at the limit of its voltage",
    does="a drive that has no force beyond a speed",
    strength=Parameter(
        "inverse_speed",
        "a",
        "s/m",
        0.0,
        20.0,
        0.0,
        "inverse of the speed at which the force ends",
        start=Starts.TOP_SPEED,
        of_motion=True,
    ),
    texts=("D = D * clip((1 - a * v * sgn(D)) / fs, 0, 1)",),
    units={"D": "N"},
    shape=(Parameter("share", "fs", "1", 1e-2, 1.0, 0.1, "share of that speed within which the force ends"),),
    looks="a speed that ends at one value for every larger force; nothing while the drive brakes or rests",
    source="torque of a motor at its voltage, T = Kt (V - Ke ω) / R: Krause, Analysis of Electric Machinery, 2.3",
    steps=2,
    needs=force_commanded,
)
