"""Two masses with a spring and a damper between them: a motor, and its load behind a shaft, a belt or a joint.

The drive moves the mass m₀, the spring k_j with the damper c_j moves the mass m₁. The record shows the motion of one of
the two, and there the specimen and the effects of the load act. The viscous damping is the drive's, as an induced
voltage is: a damping of each mass would be one parameter more than a transfer function determines.
"""

from collections.abc import Iterable
from dataclasses import replace

from ident.parameter import Parameter
from ident.stages.load import MASS_SPRING_DAMPER
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, Stage, stage

_JOINT = (
    Quantity("xj", "m", "stretch of the spring between the masses"),
    Quantity("vj", "m/s", "speed of the mass at the other end of the spring"),
    Quantity("Fj", "N", "force of spring and damper between the masses"),
)
_PARAMETERS = (
    Parameter("m1", "m₁", "kg", 1e-6, 1e6, 1.0, "mass behind the spring", ORDER_OF_MAGNITUDE),
    Parameter("kj", "k_j", "N/m", 1e-6, 1e12, 1.0, "stiffness between the masses", ORDER_OF_MAGNITUDE),
    Parameter("cj", "c_j", "N*s/m", 1e-9, 1e9, 1e-2, "damping between the masses", ORDER_OF_MAGNITUDE),
)
_SCALES = (
    Scale("m1", "m0", 1e-2, 1e2),
    Scale("kj", "m1 * W**2", 1e-4, 1e2),
    Scale("cj", "sqrt(kj * m1)", 1e-3, 1e0),
)


def _coupled(changed: Iterable[tuple[str, str]], joint: tuple[tuple[str, str], ...]) -> Stage:
    """The load of one mass with another behind a spring: what is `changed` of it, and the equations of the `joint`."""
    one, other = MASS_SPRING_DAMPER.with_equations(*changed), stage("load", _JOINT, *joint)
    return replace(
        one,
        publishes=(*one.publishes, *other.publishes),
        equations=(*one.equations, *other.equations),
        parameters=(*one.parameters, *_PARAMETERS),
        scales=(*one.scales, *_SCALES),
    )


TWO_MASSES = _coupled(
    (
        ("a = (D - R - f - S - Fj) / (m0 + mL)", "the drive's mass, against the spring to the other"),
        ("M = m0 + mL", "drive and specimen stop together"),
    ),
    (
        ("xj' = v - vj", "the spring is stretched by the drive's lead"),
        ("Fj = kj * xj + cj * (v - vj)", "spring and damper between the masses"),
        ("vj' = Fj / m1", "the spring moves the load"),
    ),
)
"""Recorded at the drive: x and v are those of m₀."""

TWO_MASSES_AT_LOAD = _coupled(
    (
        ("R = 0", "no other damping"),
        ("M = m1 + mL", "load and specimen stop together"),
        ("a = (Fj - R - f - S) / (m1 + mL)", "the spring moves the load"),
    ),
    (
        ("xj' = vj - v", "the spring is stretched by the drive's lead"),
        ("Fj = kj * xj + cj * (vj - v)", "spring and damper between the masses"),
        ("vj' = (D - c0 * vj - Fj) / m0", "the drive's mass with its damping, against the spring"),
    ),
)
"""Recorded at the load: x and v are those of m₁."""
