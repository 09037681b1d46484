"""What a reader of a result is told of its preprocessing, beyond what stands in the notes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ident.matrix import StepOutcome


def told(outcomes: Sequence[StepOutcome], notes: Sequence[str] = ()) -> Iterator[str]:
    """A sentence or more for each step that changed something or is switched off, where the notes do not have it."""
    noted = " ".join(notes)
    for outcome in outcomes:
        if outcome.told and outcome.told not in noted:
            yield outcome.told
