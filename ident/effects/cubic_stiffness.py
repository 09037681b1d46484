"""The specimen's spring hardens or softens."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

CUBIC_STIFFNESS = Effect(
    name="cubic_stiffness",
    place="load",
    meaning="the stiffness of the specimen increases or decreases with displacement",
    does="stiffness that changes with position",
    strength=Parameter("stiffness", "k3", "N/m^3", -1e11, 1e11, 0.0, "cubic stiffness of the specimen"),
    texts=("S = S + k3 * xL**3",),
    units={"S": "N"},
    looks="static gain and resonance change with amplitude",
    source="Duffing",
    of_place=True,
)
