"""The bulk modulus of the oil, which a compressibility is worth once a volume is stated.

Qian et al. (2014), eq. (18):  βe = Vt / (4 Ka),  with the oil volume Vt (m³) and Ka in m³/Pa.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from ident.fit.result import Combination, Estimate, FitResult
from ident.matrix import Actuator
from ident.words.message import message, said
from ident.words.plus_minus import plus_minus_si
from ident.words.sentence import sentence

COMPRESSIBILITY = "m^3/Pa"
"""The unit that tells the parameter Vt/(4 βe) from all others."""


@dataclass(frozen=True)
class OilVolume:
    """Vt in m³, and what it stands on, in words."""

    value: float
    stands_on: str


@dataclass(frozen=True)
class BulkModulus:
    """βe = Vt/(4 Ka) in Pa with its standard error (None where that of Ka is not known), and the volume behind it.

    The volume counts as exact: an error of it is an error of βe of the same share.
    """

    value: float
    std_error: float | None
    volume: float
    stands_on: str
    compressibility: str = "Ka"

    def __str__(self) -> str:
        value = plus_minus_si(self.value, self.std_error, "Pa", digits=4)
        return f"bulk modulus {value} = V/(4 {self.compressibility}) with V = {self.volume:.4g} m^3, {self.stands_on}"

    @property
    def combination(self) -> Combination | None:
        """As what a fit determines; None without a standard error."""
        if self.std_error is None:
            return None
        return Combination(f"V / (4*{self.compressibility})", self.value, "Pa", self.std_error)

    @property
    def note(self) -> str:
        """What a reader has to know of it."""
        unknown = [] if self.std_error is not None else [message("bulk.std_error", name=self.compressibility)]
        return sentence(said([message("bulk", modulus=self), *unknown]))


def oil_volume(actuator: Actuator) -> OilVolume | None:
    """The volume that is stated, else area × stroke; None where neither is stated, for nothing is assumed.

    The volume printed in eq. (18), 6e-4 m³, is eight times area × stroke of that actuator.
    """
    if actuator.volume is not None:
        return OilVolume(actuator.volume, "as stated")
    if actuator.piston_area is None or actuator.stroke is None:
        return None
    return OilVolume(actuator.piston_area * actuator.stroke, "piston area × stroke, without the oil in ports and lines")


def bulk_modulus(parameters: Mapping[str, Estimate], actuator: Actuator) -> BulkModulus | None:
    """βe of fitted parameters (Qian et al. 2014, eq. 18); None without a volume or without a compressibility in m³/Pa.

    Without a piston area only Ka/A² is known, in another unit: a volume is then worth nothing.
    """
    volume = oil_volume(actuator)
    name = next((name for name, entry in parameters.items() if entry.unit == COMPRESSIBILITY), None)
    if volume is None or name is None or actuator.piston_area is None or not parameters[name].value > 0:
        return None
    Ka, error = parameters[name].value, parameters[name].std_error
    value = volume.value / (4 * Ka)
    return BulkModulus(value, None if error is None else value * error / Ka, volume.value, volume.stands_on, name)


def with_bulk_modulus(fit: FitResult) -> FitResult:
    """A fit whose oil volume is stated, with βe among what is determined and a note of the volume it stands on."""
    found = None if fit.actuator is None else bulk_modulus(fit.parameters, fit.actuator)
    if found is None:
        return fit
    determined = fit.determined if found.combination is None else (*fit.determined, found.combination)
    return replace(fit, determined=determined, notes=(*fit.notes, found.note))
