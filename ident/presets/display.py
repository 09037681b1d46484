"""How a model is shown: its figures, and the units of its parameters."""

from __future__ import annotations

from dataclasses import dataclass, field

from ident.parameter import Parameter
from ident.presets.model import Combined, Model
from ident.presets.record_units import RecordUnits, written
from ident.stages import OPENED_BY_COMMAND
from ident.units.grammar import powers_of


@dataclass(frozen=True)
class Display:
    """Figures, and what the units of a chain are called where the records have others."""

    figures: tuple[str, ...] = ()
    """Figures that it has; () is every figure of test runs."""
    shown: tuple[str, ...] = ()
    """The two parameters whose search is drawn."""
    of_drive: tuple[str, ...] = ()
    """Parameters in whose unit a metre is one of the drive signal."""
    drive_unit: str = "m"
    """Unit in which the drive signal is shown; the command's in open loop."""
    recorded: RecordUnits = field(default_factory=RecordUnits)
    """Units of the records."""

    def unit(self, model: Model, parameter: Parameter) -> str:
        """The unit of a parameter as it is shown: a metre of the drive signal is a unit of the command in open loop.

        Where an angle was recorded a length, a force and a mass are an angle, a torque, an inertia; of an unknown
        period a second is a sample, and what was recorded in counts has no metre.
        """
        of_effect = next((effect for effect in model.effects if effect.name == parameter.of), None)
        at_drive = of_effect.place in ("controller", "valve", "spool") if of_effect else parameter.name in self.of_drive
        if parameter.name in model.static_gains:
            return self.recorded.gain
        drive = self.drive_unit if at_drive and OPENED_BY_COMMAND in model.chain.stages else None
        return self.recorded.shown(parameter.unit, drive)

    def combined_unit(self, model: Model, combined: Combined) -> str:
        """The unit of a combination as it is shown, with that of the command where one of the drive's parameters is in
        it: Kt/c0 in 1/s of a motor that volts drive and that turns is in rad/(s*V)."""
        powers = dict(powers_of(self.recorded.shown(combined.unit)) or {})
        for parameter in model.parameters:
            if parameter.name in self.of_drive:
                exponent = combined.exponent(parameter.in_equations)
                for sign, unit in ((1.0, self.unit(model, parameter)), (-1.0, self.recorded.shown(parameter.unit))):
                    for name, power in (powers_of(unit) or {}).items():
                        powers[name] = powers.get(name, 0.0) + sign * exponent * power
        return written({name: power for name, power in powers.items() if power})
