"""The loop that is wanted: a target Gd(s) for the open loop, of the paper or of a file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.hybrid.rational import Rational
from ident.readers.strict_yaml import read_yaml
from ident.readers.typed_fields import Fields
from ident.units.quantity import parameter_value, shown

KEYS = ("name", "numerator", "denominator", "roll_off")
_LARGEST = 100_000  # bytes of a file
_MOST = 20  # coefficients


@dataclass(frozen=True)
class Target:
    """Gd(s) = numerator / denominator, coefficients in falling powers of s (rad/s), and the roll-off.

    `roll_off` (rad/s) is the pole of W = Gd/G that makes it proper, as often as G falls faster than Gd. Raises
    Unusable where the target does not fall at high frequency, or is unstable.
    """

    numerator: tuple[float, ...]
    denominator: tuple[float, ...]
    roll_off: float = 2000.0
    name: str = "own target"

    def __post_init__(self) -> None:
        for what in ("numerator", "denominator"):
            values = getattr(self, what)
            if not 0 < len(values) <= _MOST or not np.isfinite(values).all() or not values[0]:
                raise Unusable(
                    "bad-target",
                    "not 1 to 20 numbers of which the first is not 0",
                    f"target {what}",
                    "give the coefficients in falling powers of s",
                )
        if len(self.numerator) >= len(self.denominator):
            raise Unusable(
                "bad-target",
                "it does not fall at high frequency",
                "target",
                "give a denominator of higher degree than the numerator",
            )
        if np.roots(self.denominator).real.max(initial=-1.0) >= 0:
            raise Unusable(
                "bad-target",
                "a pole is not in the left half-plane",
                "target denominator",
                "put an integrator at a small negative number",
            )
        if not np.isfinite(self.roll_off) or self.roll_off <= 0:
            raise Unusable("bad-target", f"{self.roll_off:g} rad/s", "target roll_off", "give a positive frequency")

    @property
    def rational(self) -> Rational:
        """Gd(s)."""
        return Rational.of_polynomials(np.array(self.numerator), np.array(self.denominator))

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        found = {"numerator": list(self.numerator), "denominator": list(self.denominator)}
        return {"name": self.name, **found, "roll_off": self.roll_off}


QIAN2014_TARGET = Target(numerator=(1.2e6,), denominator=(0.008, 20.0, 65.0, 1200.0), name="Qian et al. 2014, eq. (19)")
"""Eq. (19): 1000 at standstill, from 7.7 rad/s on −40 dB a decade, one at 39 Hz."""


def read_target(text: bytes, where: str) -> Target:
    """A target from the text of a file, YAML or JSON.

        numerator: [1.2e6]
        denominator: [0.008, 20, 65, 1200]
        roll_off: 2000 rad/s                      (optional)

    Raises Unusable where it is no target.
    """
    if len(text) > _LARGEST:
        raise Unusable("bad-target", "it is too long to be a target", where, "give numerator and denominator")
    return target_of(read_yaml(text, where), where)


def target_of(data: Any, where: str = "target") -> Target:
    """A target from a description as :func:`read_target` reads it. Raises Unusable."""
    fields = Fields(data, where, KEYS)
    numerator, denominator = _numbers(fields, "numerator"), _numbers(fields, "denominator")
    roll_off = fields.quantity("roll_off", "angular velocity")
    name = fields.text("name") or "own target"
    return Target(numerator, denominator, QIAN2014_TARGET.roll_off if roll_off is None else roll_off, name)


def _numbers(fields: Fields, key: str) -> tuple[float, ...]:
    given = fields.need(key, "give its coefficients in falling powers of s")
    if not isinstance(given, list):
        raise Unusable("bad-target", f"{shown(given)!r} is not a list of numbers", fields.place(key), "write [1, 2, 3]")
    return tuple(parameter_value(one, "1", fields.place(key)) for one in given)
