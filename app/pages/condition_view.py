"""The conditions that a form offers."""

from __future__ import annotations

from ident.rig.conditions import CONDITIONS


def conditions() -> tuple[tuple[str, str], ...]:
    """Name and title of each."""
    return tuple((name, one.title) for name, one in CONDITIONS.items())
