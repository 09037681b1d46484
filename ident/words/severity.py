"""How serious a finding is, as a reader reads it; `fault` and `doubt` are the names that files and JSON keep."""

from __future__ import annotations

from ident.words.number import count

LEVELS = {"fault": "error", "doubt": "warning", "note": "note"}
"""The levels of a compiler, the worst first: correct it, check it, know it."""


def level(severity: str) -> str:
    """The level of a finding; what has none stays as it is."""
    return LEVELS.get(severity, severity)


def levels(severities: list[str], all_of: bool = False) -> str:
    """ "1 error, 2 warnings", the worst first; with `all_of` also those that there are none of."""
    counts = {name: severities.count(name) for name in LEVELS}
    return ", ".join(count(number, LEVELS[name]) for name, number in counts.items() if number or all_of)
