"""A specimen that would drive what moves it."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.preprocessing.force_sign import gives_work_back, work
from ident.run import Run
from ident.words.run_name import run_name


def turned_sign(run: Run) -> Iterator[Finding]:
    """Force times speed of a moved specimen, which takes work."""
    if gives_work_back(run):
        text = (
            f"in {run_name(run.id)} the mean of force times speed is {work(run):.2f} of their deviations. A passive "
            "specimen cannot produce work, so one of the two has the wrong sign. Set invert: true on it"
        )
        yield Finding(run.id, "doubt", "turned-sign", text)
