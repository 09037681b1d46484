"""Which candidates are refitted, and which of their refits stands for the rest."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import pytest

from ident.diagnosis.discovery.search import RefittedTerm, _chosen
from ident.diagnosis.discovery.term import Shape, Term
from ident.diagnosis.discovery.term_candidate import TermCandidate


@pytest.mark.parametrize(
    ("text", "at", "spread", "same"),
    [
        ("max(w - h, 0)", 1.05, 8.0, True),
        ("max(w - h, 0)", 1.2, 8.0, False),
        ("min(w + h, 0)", 1.0, 8.0, False),
        ("sin(h * t)", 1.05, 1.1, False),
    ],
)
def test_what_was_refitted_from_about_there_is_not_refitted_again(text, at, spread, same):
    """The same equation with its threshold beside where it began; the next frequency of a wave is another."""

    def beginning(text: str, value: float) -> TermCandidate:
        shape = Shape("h", value, "1", spread=spread)
        return TermCandidate((Term("spool", "w", text, "kind", ("w",), {}, (shape,)),), (1.0,), 1.0, 0.5)

    first = "sin(h * t)" if text.startswith("sin") else "max(w - h, 0)"
    assert beginning(text, at).begins_as(beginning(first, 1.0)) == same


@pytest.mark.parametrize(("before", "plainest"), [(0.0300, 0), (0.0276, 1)])
def test_what_is_simpler_and_gains_next_to_nothing_does_not_stand_for_what_gains(before, plainest):
    """Within two per cent the simplest is taken: beside a large gain that is little, beside a small one all of it."""

    def leaving(error: float, simplicity: int = 0) -> RefittedTerm:
        refit = SimpleNamespace(held_out=SimpleNamespace(error=error))
        return cast(RefittedTerm, (SimpleNamespace(simplicity=simplicity), refit, None))

    tried = [leaving(0.0275, 0), leaving(0.0272, 1), leaving(0.0271, 2)]
    assert _chosen(leaving(before)[1], tried, ()) is tried[plainest]
