"""A phrase of an error as a sentence."""

from __future__ import annotations

_ENDS = (".", "?", "!")


def sentence(phrase: str) -> str:
    """The phrase with a capital letter and a full stop, which a question does without: ``Did you mean mm?``."""
    return f"{phrase[:1].upper()}{phrase[1:]}{'' if not phrase or phrase.endswith(_ENDS) else '.'}"
