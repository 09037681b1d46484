"""Two levels in series, such as tanks: each runs out with its root, the upper one into the lower.

The outflow at a level h is √(h · 1 m) (Torricelli 1643), so a time constant is that at a level of a quarter of 1 m.
Below a level of 1 cm it is laminar, in proportion to the level.
"""

from ident.parameter import Parameter, Starts
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

UPPER_LEVEL = stage(
    "flow",
    (
        Quantity("hu", "m", "level of the upper tank, in the unit of the lower one"),
        Quantity("hm", "m", "level at which the outflow is as large as the level"),
        Quantity("hb", "m", "what runs out of the upper tank at its bottom"),
        Quantity("hi", "m", "what of it the lower tank catches"),
        Quantity("xi", "m", "what runs into the lower tank"),
        Quantity("ho", "m", "what leaves the upper tank"),
    ),
    ("hu' = (gain * w - ho) / tau1", "the command fills the upper tank"),
    ("hm = 1", "a metre, to which the time constants belong"),
    ("hb = hu / sqrt(max(abs(hu), 0.01) / hm)", "outflow with the root of the level"),
    ("ho = hb", "nothing else leaves it"),
    ("hi = hb", "all of it runs into the lower one"),
    ("xi = hi", "nothing else runs into that"),
    parameters=(
        Parameter("gain", "k", "1", 1e-2, 1e2, 1.0, "inflow for each unit of the command", ORDER_OF_MAGNITUDE),
        Parameter(
            "tau1", "τ₁", "s", 1e-4, 1e6, 1.0, "time constant of the upper tank at a level of 0.25 m", start=Starts.TIME
        ),
    ),
    scales=(Scale("gain", "sqrt(X) / U", 1e-2, 1e2), Scale("tau1", "1 / W", 1e-3, 1e3)),
)

LOWER_LEVEL = stage(
    "load",
    (
        Quantity("xo", "m", "what runs out of the lower tank"),
        Quantity("v", "m/s", "rate of the lower level"),
        Quantity("x", "m", "level of the lower tank"),
        Quantity("X", "m", "position of what the transducer is fixed to"),
    ),
    ("xo = x / sqrt(max(abs(x), 0.01) / hm)", "outflow with the root of the level"),
    ("v = (xi - xo) / tau2", "what runs in and not out stays"),
    ("x' = v", "the level is the integral of its rate"),
    ("X = x", "the gauge stands still"),
    parameters=(
        Parameter(
            "tau2", "τ₂", "s", 1e-4, 1e6, 1.0, "time constant of the lower tank at a level of 0.25 m", start=Starts.TIME
        ),
    ),
    scales=(Scale("tau2", "1 / W", 1e-3, 1e3),),
)
