"""Flow: from the spool's opening to the flow into the cylinder."""

from ident.stages.stage import Quantity, stage

LINEAR_FLOW = stage(
    "flow",
    (Quantity("Q", "m^3/s", "load flow"),),
    ("Q = Z0 / A * w", "flow proportional to the opening; load far below supply (Qian et al. 2014, eqs. 5, 8)"),
)

SQUARE_ROOT_FLOW = stage(
    "flow",
    (Quantity("Q", "m^3/s", "load flow"),),
    (
        "Q = Z0 / A * w * sqrt(max(0, 1 - sgn(w) * P / Ps))",
        "turbulent flow through the valve's edges, by the pressure left across them (Merritt 1967, eq. 5-30)",
    ),
)
