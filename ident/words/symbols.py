"""How a parameter is written."""

from __future__ import annotations

from ident.words.engineering import printed_unit


def symbol(name: str, of: str) -> str:
    """Its symbol, with the divisor of a ratio such as ``Z0/A^2``: Z₀/A²; its name where it has none."""
    _, slash, divisor = name.partition("/")
    return f"{of or name}/{printed_unit(divisor)}" if slash and of else of or name
