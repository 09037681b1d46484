"""What drives grows faster than the command, such as the thrust of a propeller."""

from ident.effects.effect import Effect
from ident.effects.needs import one_sided_command
from ident.parameter import Parameter

PROGRESSIVE_DRIVE = Effect(
    name="progressive_drive",
    place="spool",
    meaning="the drive grows faster than the command, by a part in proportion to its square",
    strength=Parameter(
        "inverse_command", "s", "1/m", 0.0, 300.0, 0.0, "inverse of the command at which the square is as large"
    ),
    texts=("w = w * (1 + s * abs(w))",),
    units={"w": "m"},
    looks="a gain that grows with the command: small commands move next to nothing, large ones a lot",
    source=(
        "thrust in proportion to the square of the speed of a propeller, force to that of the current of a magnet, "
        "flow of an orifice that widens as it opens (Merritt 1967, section 5-2)"
    ),
    unless="Kp",  # the error of a loop takes both signs, whatever the side of its command
    needs=one_sided_command,
)
