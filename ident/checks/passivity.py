"""A specimen that would drive what moves it."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.preprocessing.force_sign import gives_work_back, work
from ident.run import Run


def turned_sign(run: Run) -> Iterator[Finding]:
    """Force times speed of a moved specimen, which takes work."""
    if gives_work_back(run):
        text = (
            f"in run {run.id} force times speed is {work(run):.2f} of their deviations in the mean: a specimen without "
            "a drive of its own would give work back, so that one of the two has the wrong sign; set invert: true on it"
        )
        yield Finding(run.id, "doubt", "turned-sign", text)
