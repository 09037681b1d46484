"""What is said first of a fit that validation data contradict: it leaves more of a run than the run's own mean does."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ident.fit.result import RunError
from ident.run import KINEMATIC, Run
from ident.words.message import message

WORSE = 1.0
"""[share of the output] From this error on the mean of a run would be the better model of it. Why: eq. (17) is 1 there.

Test: tests/fit/test_contradicted.py::test_validation_data_that_contradict_a_fit_are_named_first"""
_FORCES = ("N", "N*m", "1")  # units of a command that may be a force


def contradicting(runs: Sequence[Run], errors: Sequence[RunError]) -> Iterator[str]:
    """A sentence with the likely causes where a validation run is farther from the model than from its own mean."""
    worse = [(run, one.error) for run, one in zip(runs, errors, strict=True) if one.error >= WORSE]
    if not worse:
        return
    run, error = max(worse, key=lambda one: one[1])
    causes = [message("cause.conditions")]
    if run.output in KINEMATIC and run.units.get("command") in _FORCES:
        causes.append(message("cause.held", channel=run.output))
    yield str(message("contradicted", run=run.id, error=error, causes=causes))
