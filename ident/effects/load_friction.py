"""Dry friction of a gear grows with the load that the gear carries.

The load is what a weight or a spring pulls: R without the damping, which a motor's induced voltage makes for the most.
"""

from ident.effects.effect import Effect
from ident.effects.needs import angle_measured
from ident.parameter import Parameter

LOAD_FRICTION = Effect(
    name="load_friction",
    place="load",
    meaning="dry friction of a gear, in proportion to the load that it carries",
    strength=Parameter("coefficient", "mu", "1", 0.0, 2.0, 0.0, "dry friction for each unit of the load"),
    texts=("Ff = Ff + mu * abs(R - c0 * v + S)",),
    units={"Ff": "N"},
    looks="flat tops that are wider where a weight or a spring pulls more",
    source="meshing teeth, pressed together by the load: Armstrong-Hélouvry et al. 1994, section 2.1",
    steps=2,
    needs=angle_measured,
)
