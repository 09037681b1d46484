"""The places of a chain, and the signals that terms there may read: units, samples, conditions, channels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.diagnosis.discovery.term import Shape, Signals, multiplied
from ident.units.grammar import Powers, powers_of


@dataclass(frozen=True)
class Site:
    """The places of a chain where a term may be missing: `places` has the place of each signal that a term may add to.

    `signals` has for each such signal the signals that its terms may read, `typical` all samples, `units` the chain's
    units; `band` is the end of the command's band in rad/s, `seconds` the length of the shortest run, `varied` the
    conditions that differ, `recorded` the auxiliary channels.
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
        """A slow speed: the machine is below it in that share of the samples."""
        return Shape("vs", float(np.quantile(np.abs(self.typical["v"]), share)), self.units["v"])

    def unit(self, *of: tuple[str, int]) -> Powers:
        """The unit of a product of powers of signals."""
        found: Powers = {}
        for name, power in of:
            found = multiplied(found, powers_of(self.units[name]) or {}, power)
        return found
