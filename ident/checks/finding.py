"""What a check says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Severity = Literal["note", "doubt", "fault"]


@dataclass(frozen=True)
class Finding:
    """One thing that a person should know before a fit: about one run, or about the matrix where `run` is None.

    A note says what follows from the data as they are, a doubt that something is probably wrong, a fault that it is.
    `code` is a stable slug; `text` says what, with its numbers, where, and the remedy.
    """

    run: str | None
    severity: Severity
    code: str
    text: str
