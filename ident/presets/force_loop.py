"""A cylinder under a force controller, P or PI, against a specimen: command → force."""

from dataclasses import replace

from ident.presets.description import described
from ident.presets.machine import composed
from ident.presets.preset import Combined

FORCE_LOOP = replace(
    composed(
        described(
            {
                "controller": "pi",
                "of": "force",
                "valve": "first",
                "flow": "linear",
                "pressure": "compressible",
                "load": "mass_spring_damper",
                "sensor": ["force"],
            }
        ),
        "force_loop",
        "Cylinder under a force controller",
    ),
    combinations=(
        Combined("KI / Kp", "1/s", "integral gain over the proportional one"),
        Combined("Z0 / Ka", "1/s", "rate of the force for each unit of the drive signal and of the area"),
        Combined("kS / m0", "1/s^2", "stiffness of the specimen over the moving mass"),
        Combined("(c0 + cS) / m0", "1/s", "damping over the moving mass"),
    ),
)
