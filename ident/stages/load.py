"""Load: from the driving force to the motion of rod and specimen."""

from dataclasses import replace

from ident.parameter import Parameter
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

MASS_SPRING_DAMPER = stage(
    "load",
    (
        Quantity("v", "m/s", "piston speed"),
        Quantity("x", "m", "piston position"),
        Quantity("xL", "m", "position of the specimen"),
        Quantity("vL", "m/s", "speed of the specimen"),
        Quantity("xk", "m", "stretch of the specimen's spring"),
        Quantity("S", "N", "reaction of the specimen's spring and damper"),
        Quantity("R", "N", "resistance to the rod"),
        Quantity("Ff", "N", "largest dry friction force"),
        Quantity("M", "kg", "mass that dry friction has to stop"),
        Quantity("f", "N", "dry friction force; at standstill only what holds the rod"),
        Quantity("a", "m/s^2", "acceleration of the rod, against its base"),
        Quantity("aB", "m/s^2", "acceleration of the base"),
        Quantity("ay", "m/s^2", "acceleration that is recorded"),
        Quantity("F", "N", "force on the specimen"),
        Quantity("X", "m", "position of what the transducer is fixed to"),
    ),
    ("xL = x", "the specimen moves with the rod"),
    ("vL = v", "the specimen has the speed of the rod"),
    ("xk = xL", "the spring has no play"),
    ("S = k * xk + cL * v", "spring and damper of the specimen"),
    ("R = c0 * v", "viscous damping of the actuator"),
    ("Ff = 0", "no dry friction"),
    ("M = m0 + mL", "rod and specimen stop together"),
    ("f = dry(Ff, v, a, M)", "friction stops a motion, but cannot reverse it"),
    ("aB = 0", "the base stands still"),
    ("a = (D - R - f - S) / (m0 + mL) - aB", "rod and specimen move together (Qian et al. 2014, eq. 6)"),
    ("v' = a", "speed is the integral of acceleration"),
    ("x' = v", "position is the integral of speed"),
    ("ay = a + aB", "an accelerometer shows the acceleration in space"),
    ("F = S + mL * ay", "reading of a load cell between rod and specimen"),
    ("X = x", "the transducer's frame is rigid"),
    parameters=(
        Parameter("m0", "m₀", "kg", 1e-2, 1e6, 1.0, "moving mass", ORDER_OF_MAGNITUDE),
        Parameter("c0", "c₀", "N*s/m", 1e-6, 1e8, 1.0, "viscous damping of the moving mass", ORDER_OF_MAGNITUDE),
    ),
    scales=(Scale("m0", "mL", 1e-2, 1e3), Scale("c0", "m0 * W", 1e-3, 1e3)),
)

MEASURED_LOAD = MASS_SPRING_DAMPER.with_equations(
    ("S = fm", "the load cell measures the force on the specimen"),
    ("M = m0", "the mass behind the load cell is part of its force"),
    ("a = (D - R - f - S) / m0 - aB", "the rod alone, against the measured force"),
    ("F = S", "the measured force"),
)
"""The load with the measured force in place of the specimen's equation."""

DRIVEN_MASS = replace(
    MASS_SPRING_DAMPER.with_equations(("R = c0 * v + k0 * x", "viscous damping and a spring to the ground")),
    parameters=(
        Parameter("m0", "m₀", "kg", 1e-2, 1e4, 1.0, "moving mass", ORDER_OF_MAGNITUDE),
        Parameter("c0", "c₀", "N*s/m", 1e-2, 1e6, 1.0, "viscous friction", ORDER_OF_MAGNITUDE),
        Parameter("k0", "k₀", "N/m", 1e-6, 1e9, 1.0, "stiffness of the spring to the ground", ORDER_OF_MAGNITUDE),
    ),
    scales=(Scale("m0", "mL", 1e-2, 1e3), Scale("c0", "m0 * W", 1e-4, 1e3), Scale("k0", "m0 * W**2", 1e-6, 1e2)),
)
"""A mass with spring and damper of its own, beside the specimen's."""

MASS_ON_BASE = DRIVEN_MASS.with_equations(("aB = r", "the recorded acceleration moves the base"))
"""A mass with spring and damper on a base that is moved: positions and speeds are those against the base."""

PRESSED_SPECIMEN = replace(
    MASS_SPRING_DAMPER.with_equations(
        ("S = (k + kS) * xk + (cL + cS) * v", "spring and damper of the specimen, with what is not stated of them"),
    ),
    parameters=(
        *MASS_SPRING_DAMPER.parameters,
        Parameter(
            "kS", "k_S", "N/m", 1e-9, 1e12, 1.0, "stiffness of the specimen beyond the stated", ORDER_OF_MAGNITUDE
        ),
        Parameter(
            "cS", "c_S", "N*s/m", 1e-9, 1e9, 1.0, "damping of the specimen beyond the stated", ORDER_OF_MAGNITUDE
        ),
    ),
    scales=(*MASS_SPRING_DAMPER.scales, Scale("kS", "m0 * W**2", 1e-6, 1e4), Scale("cS", "m0 * W", 1e-6, 1e3)),
)
"""A specimen whose spring and damper nobody stated: without a force on it there is none to control."""

BLOCKED = stage(
    "load",
    (
        Quantity("v", "m/s", "piston speed"),
        Quantity("F", "N", "force on the stop"),
    ),
    ("v = 0", "a rigid stop holds the piston"),
    ("F = D", "the stop carries the whole force"),
)

FOLLOWING = stage(
    "load",
    (
        Quantity("v", "m/s", "piston speed"),
        Quantity("x", "m", "piston position"),
        Quantity("X", "m", "position of what the transducer is fixed to"),
    ),
    ("v = Vq", "the piston follows the flow (incompressible oil)"),
    ("x' = v", "position is the integral of speed"),
    ("X = x", "the transducer's frame is rigid"),
)
"""Nothing that the flow would have to push: its speed is the piston's."""
