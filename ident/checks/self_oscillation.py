"""An oscillation that a machine or its loop makes by itself, grown to a limit cycle or growing.

It is looked for while every input rests, where few periods show it, and then in what the command does not explain.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ident.checks.finding import Finding
from ident.checks.oscillation_at_rest import AtRest, oscillation_at_rest
from ident.checks.unexplained_oscillation import Unexplained, unexplained_oscillation
from ident.run import Run
from ident.words.message import Message, message


@dataclass(frozen=True)
class SelfOscillation:
    """An oscillation of a run that its inputs do not make: `frequency` in Hz (or 1/sample), `growth` σ in 1/s.

    σ is 0 where it has settled. `evidence` is what the run shows of it, `cause` what may make it, with the remedy.
    `of_loop`: no source outside the loop can be meant.
    """

    run: str
    frequency: float
    growth: float
    evidence: Message
    cause: Message
    of_loop: bool

    def to_json(self) -> dict[str, str | float]:
        """In the contract's words."""
        return {
            "run": self.run, "frequency": self.frequency, "growth": self.growth, "cause": str(self.cause),
            "evidence": str(self.evidence),
        }  # fmt: skip


def self_oscillating(run: Run) -> Iterator[Finding]:
    """An error where the loop oscillates by itself; a doubt where a source that is not recorded may drive it."""
    found = self_oscillation(run)
    if found is not None:
        text = message("check.self_oscillation", evidence=found.evidence, cause=found.cause)
        yield Finding.of(run.id, "fault" if found.of_loop else "doubt", "self-oscillation", text)


def self_oscillation(run: Run) -> SelfOscillation | None:
    """The oscillation of a run's output that its inputs do not make; None where there is none."""
    if at_rest := oscillation_at_rest(run):
        return _at_rest(run, at_rest)
    unexplained = unexplained_oscillation(run)
    return None if unexplained is None else _unexplained(run, unexplained)


def _at_rest(run: Run, found: AtRest) -> SelfOscillation:
    seconds, closed = run.time_unit == "s", run.gain is not None or bool(run.closed_loop)
    evidence = message(
        "oscillation.at_rest", run=run.id, output=run.output, start=found.start, end=found.end, unit=run.time_unit,
        frequency=(found.frequency, "Hz" if seconds else "1/sample"),
        growth=(found.growth, "1/s" if seconds else "1/sample"),
    )  # fmt: skip
    cause = message("oscillation.loop" if closed else "oscillation.open")
    return SelfOscillation(run.id, found.frequency, found.growth, evidence, cause, closed)


def _unexplained(run: Run, found: Unexplained) -> SelfOscillation:
    frequency, amplitude = (found.frequency, "Hz"), (found.amplitude, run.units[run.output])
    if found.growth:
        evidence = message(
            "oscillation.growing", run=run.id, frequency=frequency, time=(math.log(2) / found.growth, "s")
        )
    else:
        evidence = message("oscillation.unexplained", run=run.id, frequency=frequency, amplitude=amplitude)
    cause = message("oscillation.unstable" if found.growth else "oscillation.limit_cycle")
    return SelfOscillation(run.id, found.frequency, found.growth, evidence, cause, True)
