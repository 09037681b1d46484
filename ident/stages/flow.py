"""Flow: from the spool's opening to the flow into the cylinder."""

from ident.stages.stage import Quantity, stage

LINEAR_FLOW = stage(
    "flow",
    (Quantity("Q", "m^3/s", "load flow"),),
    ("Q = Z0 / A * w", "flow proportional to the opening; load far below supply (Qian et al. 2014, eqs. 5, 8)"),
)
