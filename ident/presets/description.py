"""What a machine that is put together from stages is described by: a choice at each place, in data and in one line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ident.errors import Unusable
from ident.words.nearest import did_you_mean

PREFIX = "machine:"
CHOICES: Mapping[str, tuple[str, ...]] = {
    "controller": ("none", "p", "pi", "pid", "cascade"),
    "of": ("displacement", "velocity", "force"),
    "valve": ("none", "first", "second"),
    "spool": ("rigid",),
    "flow": ("none", "linear", "square_root", "to_speed"),
    "pressure": ("none", "compressible"),
    "load": (
        "none",
        "mass_spring_damper",
        "two_masses",
        "two_masses_at_load",
        "prescribed_motion",
        "measured_force",
    ),
}
"""What a place may be; the first is what it is where nothing is said."""
SHOWN = ("displacement", "velocity", "acceleration", "force", "load_pressure")
GAINS = {"P": "Kp", "I": "KI", "D": "KD"}
"""What a gain is called in the equations."""
_KEYS = (*CHOICES, "sensor", "gains")


@dataclass(frozen=True)
class Description:
    """What stands at each place, what is recorded, and the gains that are known."""

    places: Mapping[str, str]
    sensor: tuple[str, ...]
    gains: Mapping[str, float]

    def __getitem__(self, place: str) -> str:
        return self.places.get(place, CHOICES[place][0])

    @property
    def name(self) -> str:
        """The description in one line, which :func:`machine` reads."""
        said = [f"{place}={self[place]}" for place in CHOICES if self[place] != CHOICES[place][0]]
        said += [f"sensor={'+'.join(self.sensor)}"]
        if self.gains:
            said += ["gains=" + "+".join(f"{name}:{value!r}" for name, value in self.gains.items())]
        return PREFIX + ",".join(said)

    @property
    def closed(self) -> bool:
        """Whether a controller compares."""
        return self["controller"] != "none"

    @property
    def compares(self) -> str:
        """The channel that its controller compares with the command; "" in open loop."""
        return self["of"] if self.closed else ""

    @property
    def hydraulic(self) -> bool:
        """Whether oil is between the drive signal and the load."""
        return self["pressure"] == "compressible"


def described(data: Any, where: str = "machine") -> Description:
    """A description from plain data. Raises Unusable with the entry at fault."""
    if not isinstance(data, Mapping):
        raise _bad(f"{data!r} is not a list of place: choice", where, "write {valve: first, flow: linear, …}")
    if strange := [key for key in data if key not in _KEYS]:
        raise _bad(f"unknown key {strange[0]!r}", where, did_you_mean(str(strange[0]), _KEYS))
    places = {}
    for place, choices in CHOICES.items():
        chosen = str(data.get(place) or choices[0])
        if chosen not in choices:
            raise _bad(f"{chosen!r} is none of its kinds", f"{where} {place}", did_you_mean(chosen, choices))
        places[place] = chosen
    if places["controller"] == "none":
        places["of"] = CHOICES["of"][0]  # nothing is compared
    shown = data.get("sensor") or ()
    if not isinstance(shown, str | list | tuple):
        raise _bad(f"{shown!r} is not a list of channels", f"{where} sensor", f"choose from {', '.join(SHOWN)}")
    sensor = tuple(dict.fromkeys([shown] if isinstance(shown, str) else map(str, shown)))
    if strange := [name for name in sensor if name not in SHOWN]:
        raise _bad(f"{strange[0]!r} is not a channel of a machine", f"{where} sensor", did_you_mean(strange[0], SHOWN))
    return Description(places, sensor or (_usual(places),), _gains(data.get("gains") or {}, places, f"{where} gains"))


def _usual(places: Mapping[str, str]) -> str:
    """What is recorded where nobody says it: what the loop compares, else where the load is, else its force."""
    if places["controller"] != "none":
        return places["of"]
    moved = places["load"] not in ("none", "prescribed_motion") or places["flow"] == "to_speed"
    return "displacement" if moved else "force"


def _gains(data: Any, places: Mapping[str, str], where: str) -> dict[str, float]:
    has = {"none": "", "p": "P", "cascade": "P", "pi": "PI", "pid": "PID"}[places["controller"]]
    if not isinstance(data, Mapping):
        raise _bad(f"{data!r} is not a list of gain: value", where, "write {P: 2, I: 10}")
    found = {}
    for name, value in data.items():
        if name not in has:
            raise _bad(
                f"a controller {places['controller']!r} has no gain {name!r}",
                where,
                f"give {', '.join(has)}" if has else "leave it out",
            )
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < float("inf"):
            raise _bad(f"{name} = {value!r}", where, "give a positive number, in the unit of the dial")
        found[str(name)] = float(value)
    return {gain: found[gain] for gain in GAINS if gain in found}


def is_machine(model: str) -> bool:
    """Whether the name of a model is a description."""
    return model.startswith(PREFIX)


def description(model: str) -> dict[str, Any]:
    """The description that a machine's name is, as plain data; nothing for another model."""
    data: dict[str, Any] = {}
    if not is_machine(model):
        return data
    for entry in model.removeprefix(PREFIX).split(","):
        place, _, said = entry.partition("=")
        data[place] = said
    if "sensor" in data:
        data["sensor"] = data["sensor"].split("+")
    if "gains" in data:
        pairs = (entry.partition(":") for entry in data["gains"].split("+"))
        data["gains"] = {gain: _number(value) for gain, _, value in pairs}
    return data


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _bad(what: str, where: str, remedy: str) -> Unusable:
    return Unusable("bad-machine", what, where, remedy)
