"""Flow: from the spool's opening to the flow into the cylinder."""

from ident.parameter import Parameter
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

GAIN = Parameter(
    "Z0", "Z₀", "m^4/s", -1e6, 1e6, 1.0, "flow gain of the valve times the piston area", ORDER_OF_MAGNITUDE
)

LINEAR_FLOW = stage(
    "flow",
    (Quantity("Q", "m^3/s", "load flow"),),
    ("Q = Z0 / A * w", "flow proportional to the opening; load far below supply (Qian et al. 2014, eqs. 5, 8)"),
    parameters=(GAIN,),
    scales=(Scale("Z0", "A**2 * W / Kp", 1e-3, 1e2),),
)

SQUARE_ROOT_FLOW = LINEAR_FLOW.with_equations(
    (
        "Q = Z0 / A * w * sqrt(max(0, 1 - sgn(w) * P / Ps))",
        "turbulent flow through the valve's edges, by the pressure left across them (Merritt 1967, eq. 5-30)",
    ),
)

FLOW_TO_SPEED = stage(
    "flow",
    (Quantity("Vq", "m/s", "speed of an incompressible flow"),),
    ("Vq = Kv * w", "the flow sets the speed: compressibility and mass are neglected"),
    parameters=(
        Parameter("Kv", "K_v", "1/s", -1e9, 1e9, 1.0, "speed for each unit of the opening", ORDER_OF_MAGNITUDE),
    ),
    scales=(Scale("Kv", "W / Kp", 1e-3, 1e2),),
)
