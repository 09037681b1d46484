"""What a record's units make of a model's: an angle for a length, samples for seconds, nothing where none is known."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ident.run import KINEMATIC, Run
from ident.units.grammar import Powers, powers_of

_ANGLES: Mapping[str, Powers] = {"m": {"rad": 1.0}, "N": {"N": 1.0, "m": 1.0}, "kg": {"kg": 1.0, "m": 2.0}}
_UNKNOWN_TORQUE: Mapping[str, Powers] = {**_ANGLES, "N": {}, "kg": {"s": 2.0, "rad": -1.0}}
_TURNING = ("rad", "rad/s", "N*m")
_ORDER = ("kg", "N", "Pa", "V", "A")  # the names that stand first in a unit
SAMPLE = "sample"


@dataclass(frozen=True)
class RecordUnits:
    """How the units of a chain, in m, N, kg and s, are shown of some runs.

    `turning`: a motion was recorded as an angle. `unknown` has what takes the place of a unit that the records do not
    have, as powers: of records in counts a metre is nothing, {}, or of a speed in counts a second; of a stress, the
    force for each area, a newton is a pascal. `clock` is "sample"
    where the sample period is unknown. `pressed`: forces are known as pressures alone, and N is shown as Pa. `output`
    and `command` are the units of these channels.
    """

    turning: bool = False
    unknown: Mapping[str, Powers] = field(default_factory=dict)
    clock: str = "s"
    pressed: bool = False
    output: str = "m"
    command: str = "m"

    @classmethod
    def of(cls, runs: Iterable[Run], driven_by: str = "", as_way: bool = False) -> RecordUnits:
        """Those of a matrix, by what is stated of its channels; of what is `driven_by` a force the command is one.

        `as_way`: the model reproduces whatever is recorded, such as a temperature, as it does a way: a metre is then
        the unit of the output.
        """
        listed = tuple(runs)
        units = {name: unit for run in listed for name, unit in run.units.items() if name in run.channels}
        moving = [units[name] for name in KINEMATIC if name in units]
        unknown: dict[str, Powers] = {}
        if moving and set(moving) == {"1"}:
            unknown["m"] = {} if "displacement" in units else {"s": 1.0} if "velocity" in units else {"s": 2.0}
        known = ("force", "drive_force", *(("command",) if driven_by == "drive_force" else ()))
        forces = {units[name] for name in known if name in units}
        if forces in ({"1"}, {"Pa"}):
            unknown["N"] = {} if forces == {"1"} else {"Pa": 1.0}
        if {unit for name, unit in units.items() if "pressure" in name} == {"1"}:
            unknown["Pa"] = {}
        clock = SAMPLE if listed and all(run.time_unit == SAMPLE for run in listed) else "s"
        outputs = {run.units.get(run.output, "m") for run in listed}
        if as_way and len(outputs) == 1:
            (output,) = outputs
            way = {} if output == "1" else dict(powers_of(output) or {})
            return cls(unknown={"m": way}, clock=clock, output=output, command=units.get("command", "m"))
        return cls(
            any(run.units.get(run.output) in _TURNING for run in listed),
            unknown,
            clock,
            output=outputs.pop() if len(outputs) == 1 else "m",
            command=units.get("command", "m"),
        )

    def shown(self, unit: str, drive: str | None = None) -> str:
        """A unit of the chain as it is shown; with a `drive` a metre is one of the drive signal, in that unit."""
        if self.pressed:
            unit = written(_without(powers_of(unit) or {}, {"N": {"Pa": 1.0}}))
        powers = powers_of(unit) or {}
        turning = self.turning and (self.pressed or not _is_of_oil(powers))
        names = dict(_UNKNOWN_TORQUE if "N" in self.unknown else _ANGLES) if turning else {}
        if drive is not None:
            names["m"] = powers_of(drive) or {}
        if names.keys() & powers.keys():
            unit = written(_replaced(powers, names))
        unknown = self.unknown if drive is None else {name: of for name, of in self.unknown.items() if name != "m"}
        if self.pressed:
            unit = written(_without(powers_of(unit) or {}, {}))  # Pa/Pa is 1
        of_unit = powers_of(unit) or {}
        if of_unit.keys() & {*unknown, "kg"} and unknown:
            unit = written(_without(of_unit, unknown))
        return unit if self.clock == "s" else re.sub(r"\bs\b", self.clock, unit)

    @property
    def gain(self) -> str:
        """The unit of a static gain from command to output."""
        over = dict(powers_of(self.output) or {})
        for name, power in (powers_of(self.command) or {}).items():
            over[name] = over.get(name, 0.0) - power
        return written({name: power for name, power in over.items() if power})


def _is_of_oil(powers: Powers) -> bool:
    """Whether a unit is one of a pressure, an area or a volume, or of one over a flow: these stay where a machine
    turns, and with them what they are multiplied by."""
    over_a_flow = powers.get("m", 0.0) <= -3.0 and "N" not in powers
    return "Pa" in powers or powers.get("m", 0.0) >= 2.0 or over_a_flow


def _replaced(powers: Powers, names: Mapping[str, Powers]) -> Powers:
    """A unit with others in the places of some."""
    found: Powers = {}
    for name, power in powers.items():
        for other, of in names.get(name, {name: 1.0}).items():
            found[other] = found.get(other, 0.0) + power * of
    return {name: power for name, power in found.items() if power}


def _without(powers: Powers, unknown: Mapping[str, Powers]) -> Powers:
    """A unit with what takes the place of the unknown ones; a mass is a force over an acceleration, N·s²/m."""
    if "kg" in powers:
        mass = powers["kg"]
        powers = {name: power for name, power in powers.items() if name != "kg"}
        for name, power in (("N", 1.0), ("s", 2.0), ("m", -1.0)):
            powers[name] = powers.get(name, 0.0) + mass * power
    return _replaced(powers, unknown)


def written(powers: Powers) -> str:
    """The powers of each name as a unit: {N: 1, s: 1, m: −1} → "N*s/m", {} → "1"."""
    names = sorted(powers, key=lambda name: (name not in _ORDER, _ORDER.index(name) if name in _ORDER else 0, name))
    above = [_power(name, powers[name]) for name in names if powers[name] > 0]
    below = [_power(name, -powers[name]) for name in names if powers[name] < 0]
    over = "" if not below else f"/{below[0]}" if len(below) == 1 else f"/({'*'.join(below)})"
    return ("*".join(above) or "1") + over


def _power(name: str, power: float) -> str:
    return name if power == 1 else f"{name}^{power:g}"
