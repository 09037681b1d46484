"""What a check says."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from ident.words.message import Message, message
from ident.words.result_tables import Listing, TabularResult
from ident.words.severity import level

Severity = Literal["note", "doubt", "fault"]


@dataclass(frozen=True)
class Finding:
    """One thing that a person should know before a fit: about one run, or about the matrix where `run` is None.

    A note says what follows from the data as they are, a doubt that something is probably wrong, a fault that it is.
    `code` is a stable slug; `text` says what, with its numbers, where, and the remedy. `key` and `values` are the
    message that the text puts into words: plain data, for a program, or for words of another language.
    """

    run: str | None
    severity: Severity
    code: str
    text: str
    key: str = ""
    values: Mapping[str, Any] = field(default_factory=dict, hash=False)

    @classmethod
    def of(cls, run: str | None, severity: Severity, code: str, message: Message) -> Finding:
        """A finding that says this message."""
        return cls(run, severity, code, str(message), message.key, message.record()["values"])


class Findings(tuple[Finding, ...], TabularResult):
    """All that a check says, faults first."""

    def listings(self) -> Iterable[Listing | str]:
        """A row a finding."""
        if not self:
            yield str(message("check.none"))
            return
        rows = [(level(one.severity), one.run or "all", one.text) for one in self]
        yield Listing("", ("level", "run", "finding"), rows)

    def records(self) -> list[dict[str, Any]]:
        """A record a finding, for a data frame."""
        return [asdict(one) for one in self]
