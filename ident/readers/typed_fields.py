"""One mapping of the description: typed fields, and an error for every key that nobody asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ident.errors import Unusable
from ident.units.quantity import parameter_value, quantity, shown
from ident.words.nearest import did_you_mean

LONGEST_TEXT = 500


class Fields:
    """The keys of a mapping, `known` being the ones it may have, and `around` those of the mapping that it stands in.

    Raises Unusable: ``not-a-mapping``, ``unknown-key``.
    """

    def __init__(self, data: Any, where: str, known: Sequence[str], around: Sequence[str] = ()) -> None:
        if not isinstance(data, Mapping):
            raise Unusable("not-a-mapping", f"{shown(data)!r} is not a list of key: value", where, "write {key: value}")
        self.data, self.where = data, where
        for key in data:
            if key not in known:
                _check_comma(data, key, where)
                outer = where.rpartition(" ")[2]
                remedy = f"take it out of {outer}: it stands beside {outer}" if key in around else ""
                remedy = remedy or did_you_mean(str(key), known)
                raise Unusable("unknown-key", f"unknown key {shown(key)!r}", where, remedy)

    def __contains__(self, key: str) -> bool:
        return self.data.get(key) is not None

    def place(self, key: str) -> str:
        """The field's name in messages."""
        return f"{self.where} {key}"

    def need(self, key: str, remedy: str) -> Any:
        """A value that must be there. Raises Unusable: ``missing-field``."""
        if key not in self:
            raise Unusable("missing-field", f"{key!r} is missing", self.where, remedy)
        return self.data[key]

    def text(self, key: str, default: str = "") -> str:
        """A line of text. Raises Unusable: ``not-text``."""
        value = self.data.get(key)
        if value is None:
            return default
        line = " ".join(str(value).split())
        if not isinstance(value, str | int) or len(line) > LONGEST_TEXT or not line.isprintable():
            raise Unusable("not-text", f"{shown(value)!r} is not a line of text", self.place(key), "write a short text")
        return line

    def names(self, key: str) -> tuple[str, ...]:
        """A list of different lines of text. Raises Unusable: ``not-text``."""
        value = self.data[key]
        found = tuple(Fields({key: one}, self.where, (key,)).text(key) for one in value)
        if not found or len(set(found)) < len(found) or not all(found):
            raise Unusable("not-text", f"{shown(value)!r} is not a list of names", self.place(key), "name each once")
        return found

    def choice(self, key: str, allowed: Sequence[str], default: str) -> str:
        """One of the allowed words. Raises Unusable: ``unknown-KEY``."""
        value = self.text(key, default)
        if value not in allowed:
            remedy = did_you_mean(value, allowed)
            raise Unusable(f"unknown-{key}", f"{shown(value)!r} is not a {key}", self.place(key), remedy)
        return value

    def whole(self, key: str, default: int = 0) -> int:
        """A whole number, 0 or more. Raises Unusable: ``not-a-number``."""
        value = self.data.get(key, default)
        if not isinstance(value, int) or value < 0:
            raise Unusable(
                "not-a-number", f"{shown(value)!r} is not 0 or a whole number above", self.place(key), "write 6"
            )
        return value

    def truth(self, key: str) -> bool:
        """True or false. Raises Unusable: ``not-a-truth``."""
        value = str(self.data.get(key, "false")).lower()
        if value not in ("true", "false", "yes", "no"):
            raise Unusable("not-a-truth", f"{shown(value)!r} is neither true nor false", self.place(key), "write true")
        return value in ("true", "yes")

    def quantity(self, key: str, dimension: str) -> float | None:
        """A number with its unit, in SI; None where it is not given."""
        return quantity(self.data[key], dimension, self.place(key)) if key in self else None

    def number(self, key: str, unit: str = "1") -> float | None:
        """A number that may carry a unit and without one is in `unit`; None where it is not given."""
        return parameter_value(self.data[key], unit, self.place(key)) if key in self else None

    def positive(self, key: str, dimension: str) -> float | None:
        """As :meth:`quantity`, above 0. Raises Unusable: ``not-positive``."""
        value = self.quantity(key, dimension)
        if value is not None and value <= 0:
            raise Unusable("not-positive", f"{shown(self.data[key])} is not above 0", self.place(key), "correct it")
        return value

    def not_negative(self, key: str, dimension: str) -> float | None:
        """As :meth:`quantity`, 0 or above. Raises Unusable: ``negative-KEY``."""
        value = self.quantity(key, dimension)
        if value is not None and value < 0:
            remedy = "give 0 or a positive value"
            raise Unusable(f"negative-{key}", f"{shown(self.data[key])} is negative", self.place(key), remedy)
        return value

    def pair(self, key: str) -> tuple[Any, Any] | None:
        """A list of two. Raises Unusable: ``not-a-pair``."""
        value = self.data.get(key)
        if value is None:
            return None
        if not isinstance(value, list) or len(value) != 2:
            raise Unusable("not-a-pair", f"{shown(value)!r} is not a list of two", self.place(key), _PAIR)
        return value[0], value[1]


_PAIR = "write [first, end], with decimal points: a comma separates the two"


def _check_comma(data: Mapping[Any, Any], key: Any, where: str) -> None:
    """Refuse ``{mass: 0,87 kg}``, which YAML reads as a mass of 0 and a key ``87 kg``. Raises ``decimal-comma``."""
    before = dict(zip(list(data)[1:], data.items(), strict=False)).get(key)
    text = str(key).strip()
    if before is None or data[key] is not None or not text[:1].isdigit() or not str(before[1]).lstrip("+-").isdigit():
        return
    what = f"the comma in '{before[0]}: {before[1]},{shown(text)}' separates two entries of the mapping"
    raise Unusable("decimal-comma", what, where, f"write {before[0]}: {before[1]}.{shown(text)}, with a decimal point")
