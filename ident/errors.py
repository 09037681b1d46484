"""What the library raises for a user to read; anything else that escapes is a defect of the program."""

from __future__ import annotations

from typing import Any


class Unusable(ValueError):
    """Input that cannot be used: what is wrong, where, and the remedy, each a short phrase without a final stop.

    `code` is a stable slug (``missing-unit``) by which programs tell the cases apart.
    """

    def __init__(self, code: str, what: str, where: str, remedy: str) -> None:
        super().__init__(f"{where}: {what}; {remedy}")
        self.code, self.what, self.where, self.remedy = code, what, where, remedy

    def within(self, file: str) -> Unusable:
        """The same, whose place begins with the name of the file that it is in."""
        where = self.where if self.where.startswith(file) else f"{file}, {self.where}"
        return Unusable(self.code, self.what, where, self.remedy)

    def __reduce__(self) -> tuple[Any, ...]:
        """As it passes from one process to another."""
        return type(self), (self.code, self.what, self.where, self.remedy)


class Cancelled(Exception):
    """Raised by a caller's progress report to stop long work; nothing is stored."""


class TimeIsUp(Exception):
    """Raised by the course of a diagnosis when its time is over, or by its caller's report; what was found is told."""
