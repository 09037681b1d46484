"""How documents write the numbers that stand in code: in words, in per cent, as parts, as powers of ten."""

from __future__ import annotations

import math

WORDS = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"]
PARTS = {0.5: "half", 0.1: "a tenth", 0.2: "a fifth", 0.9: "nine tenths", 0.05: "a twentieth", 0.02: "two hundredths"}


def word(number: float) -> str:
    """A small whole number in words."""
    return WORDS[int(number)] if number == int(number) else str(number)


def per_cent(share: float) -> str:
    """1 for 0.01."""
    return f"{100 * share:.6g}"


def beyond(factor: float) -> str:
    """2 for 1.02: by how many per cent a factor is beyond one."""
    return f"{100 * (factor - 1):.6g}"


def plain(number: float) -> str:
    """1.03 for 1.03, 2 for 2.0."""
    return f"{number:.6g}"


def power(number: float) -> str:
    """1e-6 for 1e-06, 1e-12 for 1e-12."""
    return f"{number:.0e}".replace("e-0", "e-")


def within(deviations: float) -> float:
    """The share of a normal distribution within so many standard deviations, to three digits."""
    return round(math.erf(deviations / math.sqrt(2)), 3)


Tie = tuple[str, str, tuple[object, ...]]
"""Document, phrase, numbers."""
