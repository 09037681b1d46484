"""The oil volumes change along the stroke."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

STROKE_DEPENDENT_VOLUME = Effect(
    name="stroke_dependent_volume",
    place="pressure",
    meaning="the oil volume of each chamber changes along the stroke",
    does="a stiffness that changes along the stroke",
    strength=Parameter(
        "curvature",
        "kappa",
        "1/m^2",
        0.0,
        200.0,
        0.0,
        "relative fall of the compressibility for each square metre of stroke",
    ),
    texts=("Ke = Ke * (1 - kappa * x**2)",),
    units={"Ke": "m^3/Pa"},
    looks="a stiffer oil column away from mid-stroke; no effect at amplitudes of millimetres",
    source="Merritt, Hydraulic Control Systems, chamber volumes",
)
