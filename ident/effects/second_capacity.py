"""A second capacity exchanges with the one that is driven."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

SECOND_CAPACITY = Effect(
    name="second_capacity",
    place="load",
    meaning="a second capacity fills from the first and empties into it: what a heated body stands on, a side tank, "
    "or the integral of a controller",
    does="a slow part of the answer",
    strength=Parameter("exchange", "ac", "1", 0.0, 10.0, 0.0, "exchange with it, over what draws the output back"),
    texts=("xc = lag(x, Tc)", "xo = xo + ac * (x - xc)"),
    units={"xo": "m"},
    shape=(
        Parameter(
            "time", "Tc", "s", 1e-3, 1e1, 0.1, "time constant of its filling", searched=True, start=Starts.RELAXATION
        ),
    ),
    looks="a quick answer to each step and then a slow one, in the same proportion at every height",
    source="interacting capacities, Coughanowr and LeBlanc, Process Systems Analysis and Control, chapter 6",
    unless="tau1",
)
