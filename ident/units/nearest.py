"""The unit that somebody may have meant who wrote one that is not known."""

from __future__ import annotations

from difflib import SequenceMatcher

from ident.units.names import BASE, DERIVED

WRITTEN = {
    "m": ("mm", "cm", "m", "µm", "in", "inch", "ft", "mil"), "m^2": ("mm^2", "cm^2", "m^2", "in^2"),
    "m^3": ("mm^3", "cm^3", "m^3", "l", "ml", "cc"), "kg": ("kg", "g", "t", "lb"), "s": ("s", "ms", "µs", "min", "h"),
    "1/s": ("Hz", "kHz", "1/s"), "m/s": ("mm/s", "cm/s", "m/s", "in/s", "m/min"),
    "rad/s": ("rpm", "rad/s", "deg/s", "rev/s"), "m/s^2": ("m/s^2", "mm/s^2", "g"),
    "N": ("N", "kN", "MN", "lbf", "kip", "kgf"), "Pa": ("bar", "mbar", "MPa", "kPa", "Pa", "GPa", "psi", "ksi"),
    "N/m": ("N/m", "N/mm", "kN/m", "kN/mm", "MN/m"), "N*s/m": ("N*s/m", "N*s/mm", "kN*s/m"),
    "A": ("A", "mA"), "V": ("V", "mV"), "K": ("degC", "K", "degF"), "m^3/s": ("l/min", "m^3/s", "cm^3/s", "gpm"),
    "1": ("%", "1"), "rad": ("deg", "rad", "rev"), "N*m": ("N*m", "Nm", "kNm", "N*mm"),
}  # fmt: skip
"""What benches write, by the SI unit of the kind: the nearest is looked for among these first."""
NEAR = 0.6
"""Likeness (difflib's ratio) from which a unit is suggested: cm2 and cm^2 have 0.86, mss and ms 0.8, mm and bar 0."""


def nearest(unit: str, target: str = "") -> str:
    """The known unit most like the one that was written, of the kind of `target` where one of these is; or nothing."""
    of_kind = WRITTEN.get(target, ())
    return (
        _most_like(unit, of_kind)
        or _most_like(unit, sorted({one for units in WRITTEN.values() for one in units}))
        or _most_like(unit, names())
    )


def _most_like(unit: str, known: tuple[str, ...] | list[str]) -> str:
    """The first of those most like it, capital and small letters being alike but for half a point."""
    likeness = {one: max(_ratio(unit, one), 0.99 * _ratio(unit.lower(), one.lower())) for one in known if len(one) > 1}
    best = max(likeness, key=lambda one: likeness[one], default="")
    return best if best and likeness[best] >= NEAR else ""


def _ratio(first: str, second: str) -> float:
    """Twice the letters in common over all letters; 0 where the lengths alone keep it below :data:`NEAR`.

    So a text of any length, which a file may state for a unit, is answered at once.
    """
    if 2 * min(len(first), len(second)) < NEAR * (len(first) + len(second)):
        return 0.0
    return SequenceMatcher(None, first, second, autojunk=False).ratio()


def names() -> list[str]:
    """Every unit name that is defined, without prefixes."""
    lines = [line.partition(";")[0] for line in (BASE + DERIVED).strip().splitlines() if line]
    parts = [line.split("=") for line in lines]
    return sorted({part[0].strip() for part in parts} | {name.strip() for part in parts for name in part[2:]})
