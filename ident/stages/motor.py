"""A motor whose voltage or current acts at once: from the drive signal to the force on its load."""

from ident.parameter import Parameter
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

TORQUE = stage(
    "pressure",
    (Quantity("D", "N", "force, or torque, that drives the load"),),
    ("D = Kt * w", "proportional to the drive signal; the induced voltage counts as damping"),
    parameters=(
        Parameter("Kt", "K_t", "N/m", 1e-12, 1e12, 1.0, "force for each unit of the drive signal", ORDER_OF_MAGNITUDE),
    ),
    scales=(Scale("Kt", "c0 * V / U", 1e-5, 1e2),),
)
