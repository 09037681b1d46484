"""A specimen that would drive what moves it."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.preprocessing.force_sign import gives_work_back, work
from ident.run import Run
from ident.words.message import message


def turned_sign(run: Run) -> Iterator[Finding]:
    """Force times speed of a moved specimen, which takes work."""
    if gives_work_back(run):
        yield Finding.of(run.id, "doubt", "turned-sign", message("check.active", run=run.id, work=work(run)))
