"""A cylinder of long stroke behind a valve with overlap, as the hybrid-simulation paper prints it: four places.

The drive signal, of which a metre stands for a volt, is what the driver of the valve is given.
"""

from dataclasses import replace

from ident.parameter import Parameter
from ident.stages.load import MASS_SPRING_DAMPER
from ident.stages.pressure import COMPRESSIBLE
from ident.stages.scale import Scale
from ident.stages.stage import Quantity, stage

RATING = "assumed: chosen from the rig's ratings of 190 kN, 2.2 m/s, ±0.2 m; the paper prints no value"
_OPENING = "0.5 * kep * Kp * L"  # of the spool, from the size of the error that the motion leaves

DRIVEN_VALVE = stage(
    "valve",
    (
        Quantity("vc", "m", "command of the driver to the valve, without its bias"),
        Quantity("q1", "m", "spool signal without the bias of the driver"),
        Quantity("dq", "m/s", "rate of the command"),
        Quantity("q", "m", "spool signal"),
    ),
    ("vc = where(e >= 0, kep * e, ken * e)", "the driver, with another gain to either side (our reading)"),
    ("q1' = dq", "the spool integrates its rate"),
    ("dq' = wn**2 * (vc - q1) - 2 * xi * wn * dq", "second-order valve"),
    ("q = q1 + ve0", "the bias of the driver passes the valve, whose static gain is 1"),
    parameters=(
        Parameter("ve0", "vₑ₀", "V", -1.0, 1.0, 0.05, "bias of the valve's driver", RATING),
        Parameter("kep", "kₑₚ", "1", 0.1, 2.0, 0.5, "gain of the driver for a positive command", RATING),
        Parameter("ken", "kₑₙ", "1", 0.1, 2.0, 0.5, "gain of the driver for a negative command", RATING),
        Parameter("wn", "ωₙᵥ", "1/s", 50.0, 1000.0, 220.0, "natural frequency of the valve", RATING),
        Parameter("xi", "ξᵥ", "1", 0.2, 2.0, 0.8, "damping ratio of the valve", RATING),
    ),
    scales=(
        Scale("ve0", _OPENING, -1.0, 1.0, logarithmic=False),
        Scale("kep", "1", 1e-2, 1e1),
        Scale("ken", "kep", 1e-1, 1e1),
        Scale("wn", "W", 1e-1, 1e2),
        Scale("xi", "1", 5e-2, 5e0),
    ),
)

OVERLAP = stage(
    "spool",
    (Quantity("w", "m", "opening beyond the overlap, negative to the other side"),),
    ("w = q - clip(q, ven, vep)", "lands longer than the ports: a dead zone that need not be in the middle"),
    parameters=(
        Parameter("ven", "vₑₙ", "V", -2.0, 0.0, -0.4, "edge of the dead zone to the negative side", RATING),
        Parameter("vep", "vₑₚ", "V", 0.0, 2.0, 0.4, "edge of the dead zone to the positive side", RATING),
    ),
    scales=(
        Scale("ven", _OPENING, -1.0, 1.0, logarithmic=False),
        Scale("vep", _OPENING, -1.0, 1.0, logarithmic=False),
    ),
)

_FLOW = "m^3/(s*V*Pa^0.5)"
TWO_SIDED_FLOW = stage(
    "flow",
    (Quantity("Q", "m^3/s", "load flow"),),
    (
        "Q = where(w > 0, kqp, kqn) * w * sqrt(max(0, Ps - sgn(w) * P))",
        "turbulent flow by the pressure left across the edges, with another gain to either side (eq. 4)",
    ),
    parameters=(
        Parameter("kqn", "k_qn", _FLOW, 1e-7, 1e-5, 9.4e-7, "gain of the flow to the negative side", RATING),
        Parameter("kqp", "k_qp", _FLOW, 1e-7, 1e-5, 9.4e-7, "gain of the flow to the positive side", RATING),
    ),
    scales=(
        Scale("kqp", "A * L * W / (kep * Kp * L * sqrt(Ps))", 1e-2, 1e2),
        Scale("kqn", "kqp", 1e-1, 1e1),
    ),
)

TIGHT_CYLINDER = replace(
    COMPRESSIBLE.with_equations(("L = 0", "no leakage"), ("Ke = C", "constant compressibility of the oil")),
    parameters=(Parameter("C", "C", "m^3/Pa", 1e-13, 1e-11, 1e-12, "compressibility of the oil, V0/(2 β)", RATING),),
    scales=(Scale("C", "A**2 / (m * W**2)", 1e-4, 1e2),),
)

TABLE_ON_GUIDES = replace(
    MASS_SPRING_DAMPER.with_equations(
        ("R = sigma * v", "viscous friction (eq. 3)"),
        (
            "Ff = Fc + mu * Nv",
            "dry friction of the seals, and of the guides under the vertical load (eqs. 2, 3)",
        ),
        ("M = m + mL", "table and specimen stop together"),
        ("a = (D - R - f - S) / (m + mL)", "table and specimen move together (eq. 2)"),
    ),
    parameters=(
        Parameter("m", "m", "kg", 50.0, 5000.0, 450.0, "moving mass", RATING),
        Parameter("sigma", "σ", "N*s/m", 1e3, 2e5, 2.5e4, "viscous friction", RATING),
        Parameter("Fc", "F_c", "N", 50.0, 2e4, 1000.0, "dry friction of the cylinder", RATING),
        Parameter("mu", "μ", "1", 1e-4, 0.1, 0.005, "coefficient of the guides' dry friction", RATING),
    ),
    scales=(
        Scale("m", "A * Ps / (L * W**2)", 1e-4, 1e2),
        Scale("sigma", "m * W", 1e-3, 1e2),
        Scale("Fc", "A * Ps", 1e-5, 1.0),
        Scale("mu", "1", 1e-5, 1.0),
    ),
)
