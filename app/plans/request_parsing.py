"""What a plan is asked for, from the request: the library's arguments, checked before a job is queued."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ident.design.spread import USUAL, Spread
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.planning.bench_program import KONONYKHIN
from ident.planning.plan import Plan, asked_program, plan
from ident.planning.programs import QIAN, Settings
from ident.progress import Report
from ident.readers.rig import rig_of
from ident.rig.limits import RigLimits
from ident.units.quantity import parameter_value, shown
from ident.words.nearest import did_you_mean
from schemas.plan import PlanRequest

NAMED = (QIAN, KONONYKHIN)
_LONGEST = 5e7  # samples of all runs together: the archive of their commands is of about a gigabyte before it is packed


@dataclass(frozen=True)
class AskedPlan:
    """The arguments of :func:`ident.planning.plan.plan` but for the fit."""

    program: str | dict[str, Any]
    rig: RigLimits | None
    settings: Settings
    spread: Spread
    least: float

    def check(self) -> str:
        """The name of the program. Raises Unusable where it is none, or too long."""
        found = asked_program(self.program, self.settings)
        if found is None:
            return KONONYKHIN
        samples = sum(run.signal.samples for run in found.runs)
        if samples > _LONGEST:
            raise Unusable("too-large", f"{samples} samples of commands", "program", "ask for fewer or shorter runs")
        return found.name

    def made(self, fit: FitResult | None, report: Report) -> Plan:
        """The plan, with the fit that predicts the peaks. Raises Unusable."""
        of = self.settings
        return plan(self.program, fit, self.rig, of.seconds, of.ramp, of.seed, self.spread, self.least, report)


def asked_plan(request: PlanRequest) -> AskedPlan:
    """What a request asks for. Raises Unusable with the field at fault."""
    settings = Settings(_seconds(request.seconds, "seconds"), _seconds(request.ramp, "ramp"), request.seed)
    rig = rig_of(request.rig) if request.rig else None
    return AskedPlan(_program(request), rig, settings, _spread(request), request.least)


def _program(request: PlanRequest) -> str | dict[str, Any]:
    """The name of a program, or one of the asker's own: never the path of a file. Raises Unusable."""
    if isinstance(request.program, str) and request.program not in NAMED:
        raise Unusable(
            "no-such-program",
            f"no program {shown(request.program)!r}",
            "program",
            did_you_mean(request.program, NAMED, f"give {' or '.join(NAMED)}, or an object"),
        )
    return request.program


def _seconds(given: float | str | None, name: str) -> float | None:
    return None if given is None else parameter_value(given, "time", name)


def _spread(request: PlanRequest) -> Spread:
    usual = USUAL if request.spread is None else parameter_value(request.spread, "1", "spread")
    stated = {name: parameter_value(share, "1", f"spreads {name}") for name, share in request.spreads.items()}
    return Spread(usual, stated)
