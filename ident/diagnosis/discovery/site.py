"""What a term can be made of at the places of a chain: signals with their units, samples, conditions, channels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.diagnosis.discovery.term import Shape, Signals, multiplied
from ident.units.grammar import Powers, powers_of


@dataclass(frozen=True)
class Site:
    """The places of a chain where a term may be missing: `places` maps a signal that is added to to its place.

    `signals` are by it those that terms there may be of, `typical` all their samples, `units` as the chain has them;
    `band` is the end of the command's, rad/s, `seconds` the length of the shortest run, `varied` the conditions that
    differ, `recorded` the channels beside the machine.
    """

    places: Mapping[str, str]
    signals: Mapping[str, Sequence[str]]
    typical: Signals
    units: Mapping[str, str]
    band: float
    seconds: float
    varied: Sequence[str] = ()
    recorded: Sequence[str] = ()

    def slow(self, share: float) -> Shape:
        """A speed that is slow: below it is the machine in that share of the samples."""
        return Shape("vs", float(np.quantile(np.abs(self.typical["v"]), share)), self.units["v"])

    def unit(self, *of: tuple[str, int]) -> Powers:
        """That of a product of powers of signals."""
        found: Powers = {}
        for name, power in of:
            found = multiplied(found, powers_of(self.units[name]) or {}, power)
        return found
