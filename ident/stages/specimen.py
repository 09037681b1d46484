"""A specimen that is moved: from its prescribed motion to the force that it takes."""

from ident.parameter import Parameter
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

MOVED_SPECIMEN = stage(
    "load",
    (
        Quantity("v", "m/s", "prescribed speed"),
        Quantity("x", "m", "position"),
        Quantity("xL", "m", "position of the specimen"),
        Quantity("vL", "m/s", "speed of the specimen"),
        Quantity("xk", "m", "stretch of the spring"),
        Quantity("S", "N", "force of spring and damper"),
        Quantity("R", "N", "what else resists"),
        Quantity("Ff", "N", "largest dry friction force"),
        Quantity("f", "N", "dry friction force"),
        Quantity("F", "N", "force that moves the specimen"),
    ),
    ("v = u", "the speed is prescribed"),
    ("x' = v", "position is its integral"),
    ("xL = x", "the specimen is what moves"),
    ("vL = v", "speed of the specimen"),
    ("xk = xL", "the spring has no play"),
    ("S = kS * xk + cS * vL", "spring and damper"),
    ("R = 0", "no other damping"),
    ("Ff = 0", "no dry friction"),
    ("f = Ff * sgn(v)", "dry friction against the motion"),
    ("F = S + R + f + mS * du", "the mass is accelerated as well"),
    parameters=(
        Parameter("cS", "c_S", "N*s/m", 1e-6, 1e9, 1.0, "damping of the specimen", ORDER_OF_MAGNITUDE),
        Parameter("kS", "k_S", "N/m", 1e-9, 1e12, 1.0, "stiffness of the specimen", ORDER_OF_MAGNITUDE),
        Parameter("mS", "m_S", "kg", 1e-9, 1e9, 1.0, "mass of the specimen", ORDER_OF_MAGNITUDE),
    ),
    scales=(
        Scale("cS", "X / U", 1e-3, 1e1),
        Scale("kS", "X * W / U", 1e-6, 1e1),
        Scale("mS", "X / (W * U)", 1e-6, 1e1),
    ),
)
