"""A sentence as one message: a key, and named values. :mod:`ident.words.messages` has its text.

The library gives both; only here they become words, so that texts can be changed or translated without it. A value is
printed by the kind that the text names for it, ``{before:error}``, else as Python formats it, ``{hertz:.3g}``.
"""

from __future__ import annotations

import string
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ident.words.engineering import quantity
from ident.words.error import error_said, unstable_on
from ident.words.messages import MESSAGES
from ident.words.number import count
from ident.words.percent import percent, probability_said
from ident.words.plus_minus import plus_minus
from ident.words.run_name import run_name
from ident.words.sentence import all_of, first_of, one_of
from ident.words.titles import data, title


@dataclass(frozen=True)
class Message:
    """What is said: the key of a text, and the values that it names; a value may be a message, or several.

    A `text` that is stated stands where it is said; that of other keys stands in :mod:`ident.words.messages`.
    """

    key: str
    values: Mapping[str, Any]
    text: str = ""

    def __str__(self) -> str:
        """Its text, with the values in words."""
        return str(_WORDS.vformat(self.text or MESSAGES[self.key], (), self.values))

    def record(self) -> dict[str, Any]:
        """Its key and its values, messages within it likewise: plain data, as JSON has it."""
        return {"key": self.key, "values": {name: _plain(value) for name, value in self.values.items()}}


def message(key: str, **values: Any) -> Message:
    """A message by its key and values."""
    return Message(key, values)


def said(messages: Sequence[Message]) -> str:
    """Some sentences, one after the other."""
    return " ".join(map(str, messages))


def _plain(value: Any) -> Any:
    if isinstance(value, Message):
        return value.record()
    return [_plain(one) for one in value] if isinstance(value, list | tuple) else value


def _strings(values: Sequence[Any]) -> list[str]:
    return [str(value) for value in values]


KINDS: Mapping[str, Callable[[Any], str]] = {
    "error": error_said,
    "percent": percent,
    "share": lambda part: f"{100 * part:.0f} %",
    "share_of": lambda ratio: percent(ratio) if percent(ratio).endswith("times") else f"{percent(ratio)} of",
    "probability": probability_said,
    "unstable": unstable_on,
    "estimate": lambda one: plus_minus(*one),
    "run": run_name,
    "first": first_of,
    "samples": lambda number: count(number, "sample"),
    "effects": lambda number: count(number, "effect"),
    "runs": lambda number: count(number, "run"),
    "sets": lambda number: count(number, "set"),
    "quantity": lambda one: quantity(*one),
    "units": lambda pairs: ", or ".join(" and ".join(pair) for pair in pairs),
    "data": data,
    "title": title,
    "degrees": lambda angle: "none" if angle is None else f"{angle:.3g}°",
    "titles": lambda names: all_of(list(map(title, names))),
    "all": lambda values: all_of(_strings(values)),
    "or": lambda values: one_of(_strings(values)),
    "listed": lambda values: ", ".join(_strings(values)),
    "words": lambda values: " ".join(_strings(values)),
    "terms": lambda values: "; ".join(_strings(values)),
    "them": lambda values: "it" if len(values) == 1 else "them",
}
"""How a value of a kind is put into words; the last says what stands for one or for several."""


class _Words(string.Formatter):
    """Values by kind; a list for which the text names none has all of its items."""

    def format_field(self, value: Any, format_spec: str) -> str:
        """The value in words."""
        kind = "all" if isinstance(value, list | tuple) and not format_spec else format_spec
        return KINDS[kind](value) if kind in KINDS else format(value, format_spec)


_WORDS = _Words()
