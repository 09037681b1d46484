"""What the reader has picked out, as parameters of a chart: a page that draws it live can move them at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import altair as alt

from ident.errors import Unusable
from ident.figures.options import number

LOW, HIGH, RUN, BRUSH = "low", "high", "run", "brush"
_WIDEST = 6.0  # a narrow band is drawn within at least this ratio of frequencies


@dataclass(frozen=True)
class Band:
    """A band of frequencies in Hz; an end that is None is open."""

    low: float | None = None
    high: float | None = None

    def __bool__(self) -> bool:
        return self.low is not None or self.high is not None

    @property
    def words(self) -> str:
        """ "5 to 8 Hz", "from 5 Hz", "up to 8 Hz"; "" where it is open."""
        if self.low is None or self.high is None:
            ends = (("from", self.low), ("up to", self.high))
            return " ".join(f"{word} {end:.3g} Hz" for word, end in ends if end is not None)
        return f"{self.low:.3g} to {self.high:.3g} Hz"


OPEN = Band()
"""Every frequency."""


def band_of(options: Mapping[str, Any]) -> Band:
    """The options low and high. Raises Unusable where they are no band."""
    found = Band(number(options, LOW), number(options, HIGH))
    if (found.low or 0.0) < 0 or (found.high is not None and found.high <= (found.low or 0.0)):
        raise Unusable(
            "not-a-band", f"from {found.low} to {found.high}", "figure option low, high", "let 0 <= low < high, in Hz"
        )
    return found


def band_params(band: Band) -> list[alt.Parameter]:
    """`low` and `high`, 0 where the end is open."""
    return [alt.param(name=name, value=value) for name, value in band_values(band).items()]


def band_values(band: Band) -> dict[str, float]:
    """The values of `low` and `high`."""
    return {LOW: band.low or 0, HIGH: band.high or 0}


def zoomed(lower: str, upper: str) -> list[Any]:
    """Ends of a logarithmic axis that shows all between two parameters, or the surroundings of the chosen band."""
    low, high = f"({LOW} || {lower})", f"({HIGH} || {upper})"
    middle, half = f"sqrt({low}*{high})", f"sqrt(max({_WIDEST:g}, 2*{high}/{low}))"
    return [
        {"expr": f"max({lower}, min({middle}/{half}, {upper} / {_WIDEST:g}))"},
        {"expr": f"min({upper}, max({middle}*{half}, {lower} * {_WIDEST:g}))"},
    ]


def brush() -> alt.Parameter:
    """A band that the reader draws along the frequency axis."""
    return alt.selection_interval(name=BRUSH, encodings=["x"], mark=alt.BrushConfig(fillOpacity=0.15))
