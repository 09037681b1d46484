"""An oscillation that a machine or its loop makes by itself, grown to a limit cycle or growing, in words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ident.checks.finding import Finding
from ident.checks.sustained_oscillation import sustained_oscillation
from ident.run import Run
from ident.words.message import Message, message


@dataclass(frozen=True)
class SelfOscillation:
    """An oscillation of a run that its inputs do not make: `frequency` in Hz (or 1/sample), `growth` σ in 1/s.

    σ is 0 where the oscillation is steady. `evidence` is what the run shows of it, `cause` what may make it, with the
    remedy.
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
            "run": self.run,
            "frequency": self.frequency,
            "growth": self.growth,
            "cause": str(self.cause),
            "evidence": str(self.evidence),
        }


def self_oscillating(run: Run) -> Iterator[Finding]:
    """An error where the loop oscillates by itself; a doubt where a source that is not recorded may drive it."""
    found = self_oscillation(run)
    if found is not None:
        text = message("check.self_oscillation", evidence=found.evidence, cause=found.cause)
        yield Finding.of(run.id, "fault" if found.of_loop else "doubt", "self-oscillation", text)


def self_oscillation(run: Run) -> SelfOscillation | None:
    """The oscillation of a run's output that its inputs do not make; None where there is none."""
    found = sustained_oscillation(run)
    if found is None:
        return None
    seconds, growth = run.time_unit == "s", found.growth * run.sample_rate
    said = {
        "run": run.id,
        "output": run.output,
        "frequency": (frequency := found.frequency * run.sample_rate, "Hz" if seconds else "1/sample"),
    }
    if growth:
        evidence = message("oscillation.growing", **said, time=(math.log(2) / growth, run.time_unit))
    else:
        evidence = message("oscillation.steady", **said, amplitude=(found.amplitude, run.units.get(run.output, "1")))
    cause = message("oscillation.loop" if _is_closed(run) else "oscillation.open")
    return SelfOscillation(run.id, frequency, growth, evidence, cause, _is_closed(run))


def _is_closed(run: Run) -> bool:
    """Whether a loop is closed: it is stated, or the command is what the output should be."""
    unit = run.units.get("command", "1")
    return run.gain is not None or bool(run.closed_loop) or (unit != "1" and unit == run.units.get(run.output))
