"""A command that was held between its samples and is read as straight lines: it looks late by half a sample interval.

A converter holds u_k from t_k to t_k + T. The straight lines through the same samples lead that by T/2, so that a
machine without any delay answers late by T/2 to them (Franklin, Powell and Workman 1998, section 3.2).
"""

from __future__ import annotations

from collections.abc import Iterator

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.effects.command_delay import COMMAND_DELAY
from ident.words.message import message

_DELAY = COMMAND_DELAY.added[0].in_equations


def held_command_sentence(fitted: FittedModel) -> Iterator[str]:
    """The sentence that a command may have been held, where the model has the delay of one that is read as lines."""
    runs = fitted.fitness.runs
    if _DELAY not in fitted.values or any(run.hold != "linear" for run in runs):
        return
    delay, intervals = fitted.values[_DELAY], {1.0 / run.sample_rate for run in runs}
    if all(abs(delay / interval - 0.5) < CRITERIA.conclusion.half_sample for interval in intervals):
        yield str(message("held", delay=(delay, runs[0].time_unit)))
