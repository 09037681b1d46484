"""What made a loop unstable that was stable before: which of its changed parts, put back alone, brings it back.

The share of a part is (M' − M)/(M0 − M): M0 and M are the gain margins before and after in dB, M' that of the loop
after with this part as it was before. Parts whose shares are alike cannot be told apart, and are named together.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ident.stability.gain_margin import LARGEST, gain_margin
from ident.stability.loop import Loop, from_to

ALIKE = 0.9
"""Of the largest share: parts from there on are named together."""
LEAST = 0.5
"""Of the loss of margin: a part that brings back less is not what made the loop unstable."""
_SAME = 1e-9  # of a value: unchanged


@dataclass(frozen=True)
class Cause:
    """A quantity that changed `before` → `after`, and the share of the lost gain margin that it alone brings back."""

    name: str
    kind: str
    meaning: str
    unit: str
    before: float
    after: float
    share: float

    def __str__(self) -> str:
        return f"{self.meaning} ({self.name}), {from_to(self.before, self.after, self.unit)}"


def causes(loop: Loop, before: Mapping[str, float]) -> tuple[Cause, ...]:
    """The changed quantities of an unstable loop that made it so, alike in their effect, the largest share first.

    `before` are the values of its parts by name when it was stable. Nothing where it was not, or where no single one
    brings back half of the margin that was lost.
    """
    factors = {
        part.name: before[part.name] / part.value
        for part in loop.parts
        if part.value and part.name in before and abs(before[part.name] - part.value) > _SAME * abs(part.value)
    }
    whole, now = _margin(loop, factors), _margin(loop, {})
    if not factors or whole <= 0 or now > 0:
        return ()
    found = [
        Cause(
            part.name,
            part.kind,
            part.meaning,
            part.unit,
            before[part.name],
            part.value,
            (_margin(loop, {part.name: factors[part.name]}) - now) / (whole - now),
        )
        for part in loop.parts
        if part.name in factors
    ]
    most = max(one.share for one in found)
    if most < LEAST:
        return ()
    return tuple(sorted((one for one in found if one.share >= ALIKE * most), key=lambda one: -one.share))


def _margin(loop: Loop, factors: Mapping[str, float]) -> float:
    found = gain_margin(loop, factors)
    return LARGEST if found is None else found
