"""What a column is called where its name leaves no doubt: the words of benches, and the channel that each means."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ident.drafts.raw import Column, bare

WORDS = {
    "command": ("command", "cmd", "reference", "ref", "setpoint", "set point", "demand", "desired", "drive command"),
    "displacement": ("displacement", "disp", "position", "pos", "lvdt", "stroke", "measured displacement"),
    "velocity": ("velocity", "vel", "speed", "rpm"),
    "force": ("force", "load", "load cell", "measured force"),
    "load_pressure": ("load pressure", "differential pressure", "dp", "pl"),
    "pressure_a": ("pressure a", "pa side", "p a"),
    "pressure_b": ("pressure b", "pb side", "p b"),
    "supply_pressure": ("supply pressure", "ps"),
    "spool": ("spool", "spool position", "spool displacement"),
    "current": ("current", "valve current"),
    "temperature": ("temperature", "temp", "oil temperature"),
}
"""Names of columns, in small letters, with the channel of matrix.yaml that they are."""
TIMES = ("time", "t", "x_value", "timestamp", "elapsed time", "time stamp", "zeit")
"""Names of a column of times."""
UNITS_BY_NAME = ("rpm",)
"""Names that are a unit: what is called so is measured in it."""


def said(name: str) -> str:
    """A column's name as it would be said: small letters, spaces, no unit, no group."""
    return " ".join(re.sub(r"[^0-9a-z_]+|_", " ", bare(name).lower()).split())


def channel_of(name: str) -> str:
    """The channel that a name means; nothing where it could be another thing."""
    return next((channel for channel, words in WORDS.items() if said(name) in words), "")


def is_time(name: str) -> bool:
    """Whether a column of this name holds the time."""
    return bare(name).lower().replace("-", " ") in TIMES


def suggested(columns: Sequence[Column]) -> dict[str, Column]:
    """The column of each channel that one column alone is called after."""
    found: dict[str, list[Column]] = {}
    for column in columns:
        if channel := channel_of(column.name):
            found.setdefault(channel, []).append(column)
    return {channel: candidates[0] for channel, candidates in found.items() if len(candidates) == 1}


def unit_of(column: Column) -> str:
    """The unit that the file states, or that the name is."""
    return column.unit or next((unit for unit in UNITS_BY_NAME if said(column.name) == unit), "")
