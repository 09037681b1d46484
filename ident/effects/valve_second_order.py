"""The valve has two more poles behind its lag."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

VALVE_SECOND_ORDER = Effect(
    name="valve_second_order",
    place="valve",
    meaning="the valve has two more poles after its lag",
    does="two more poles after the lag",
    strength=Parameter(
        "inverse_frequency", "Tn", "s", 0.0, 3e-3, 0.0, "inverse of the natural frequency, 1/ωn", start=Starts.TIME
    ),
    texts=("q = lag2(q, 2 * zeta * Tn, Tn**2)",),
    units={"q": "m"},
    shape=(Parameter("damping", "zeta", "1", 0.05, 2.0, 0.7, "damping ratio"),),
    looks="more phase lag towards the natural frequency, the same at every amplitude",
    source="Strano and Terzo, second-order valve; Merritt, Hydraulic Control Systems",
    unless="Kt",
)
"""Not of a motor, which has no valve: what rings between its voltage and its motion is a spring between masses."""
