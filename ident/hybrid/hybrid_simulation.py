"""A real-time hybrid simulation: what comes out when an identified machine moves the physical part of a structure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller import Controller, SampledController, name_of, no_controller
from ident.hybrid.hybrid_loop import EarlierCase, judge_hybrid
from ident.hybrid.machine import Machine, machine
from ident.hybrid.rig_assembly import rig_of, run
from ident.hybrid.rig_limits import leaving
from ident.hybrid.scores import Scores, scores
from ident.hybrid.shaking_table import Acceleration, acceleration
from ident.hybrid.specimen_effects import of_specimen, reference_of
from ident.hybrid.stability import critical_delay, spectral_radius
from ident.hybrid.substructure import driven_by
from ident.parallel import one_thread
from ident.plain import written
from ident.progress import Report, silent
from ident.stability.judgement import STABLE, UNSTABLE, Judgement
from ident.words.engineering import quantity
from ident.words.message import message
from ident.words.percent import percent
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]
RUNAWAY = 50.0
"""Times the largest displacement of the reference: beyond it a hybrid simulation has run away."""
HELD = "the reference holds, of the specimen,"


@dataclass(frozen=True, eq=False, kw_only=True)
class HybridResult(TabularResult):
    """What a hybrid simulation gave, SI; the records are (n,) at `sample_rate` (Hz).

    `measured` is what the displacement transducer read, `numerical` what the substructure asked for, `reference` what
    the whole structure does, `force` what the load cell read, `command` what the controller gave. `scores` are None
    where it ran away, at `ended` s. `radius` is the largest magnitude of a pole of the whole sampled loop, None where
    the loop is not linear. `seconds` is how long the simulation took, `beyond` says what leaves the limits of the rig,
    `stability` of an unstable loop with poles what would make it stable.
    """

    case: Case
    controller: str
    effects: Mapping[str, float]
    stable: bool
    scores: Scores | None
    command_rms: float | None
    critical_delay: float | None
    radius: float | None
    ended: float | None
    seconds: float
    ground: Array
    numerical: Array
    measured: Array
    reference: Array
    command: Array
    force: Array
    notes: tuple[str, ...] = ()
    beyond: tuple[str, ...] = ()
    stability: Judgement | None = None
    acceleration: Acceleration | None = None

    @property
    def sample_rate(self) -> float:
        """Samples a second."""
        return self.case.sample_rate

    def listings(self) -> Iterator[Listing | str]:
        """What is unstable or leaves the limits of the rig, the scores, the verdict, the notes."""
        yield from self.stability.text if self.stability else ()
        yield from self.beyond
        rows: list[tuple[str, str, str]] = []
        if (of := self.scores) is not None:
            rows = [
                ("delay", "measured behind numerical", quantity(of.delay, "s")),
                ("tracking_rms", "measured against numerical", percent(of.tracking_rms)),
                ("tracking_peak", "measured against numerical", percent(of.tracking_peak)),
                ("reference_rms", "measured against reference", percent(of.reference_rms)),
                ("reference_peak", "measured against reference", percent(of.reference_peak)),
                ("numerical_rms", "numerical against reference", percent(of.numerical_rms)),
                ("command_rms", "standard deviation of the command", quantity(self.command_rms or 0.0, "m")),
            ]
        if (shaken := self.acceleration) is not None:
            within = f"{shaken.lowest:g} to {shaken.highest:g} Hz"
            worst = f"{shaken.worst:+.2f} dB at {quantity(shaken.worst_at, 'Hz')}"
            rows.append(("acceleration_worst", f"spectrum against the record, {within}", worst))
            rows.append(("acceleration_rms", f"acceleration against the record, {within}", percent(shaken.rms)))
        critical = "none" if self.critical_delay is None else quantity(self.critical_delay, "s")
        rows.append(("critical_delay", "of an otherwise perfect machine", critical))
        yield Listing("", (f"case {self.case.name}", "displacement", "value"), rows, ("value",))
        said = message("rig.stable" if self.stable else "rig.unstable")
        if self.ended is not None:
            said = message("rig.ran_away", after=(self.ended, "s"))
        yield f"{said}; controller {self.controller}; {self.case.ground.name}; {self.seconds:.2f} s of computing"
        for note in self.notes:
            yield f"note: {note}"

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data: the verdict and the scores, not the records. SI units, scores as fractions."""
        names = Scores.__dataclass_fields__
        return {
            "case": self.case.name,
            "ground": self.case.ground.name,
            "controller": self.controller,
            "effects": dict(self.effects),
            "state": STABLE if self.stable else UNSTABLE,
            "stability": self.stability.to_json() if self.stability else None,
            "stable": self.stable,
            "scores": asdict(self.scores) if self.scores else dict.fromkeys(names),
            "command_rms": self.command_rms,
            "critical_delay": self.critical_delay,
            "ended": self.ended,
            "largest_pole": self.radius,
            "sample_rate": self.sample_rate,
            "delay": self.case.delay,
            "samples": len(self.ground),
            "units": {
                "scores": "1, delay s",
                "command_rms": "m",
                "critical_delay": "s",
                "ended": "s",
                "sample_rate": "Hz",
                "delay": "samples",
                "seconds": "s",
            },
            "notes": [*self.beyond, *self.notes],
            "seconds": self.seconds,
            "acceleration": None if self.acceleration is None else written(self.acceleration),
        }


def simulate_hybrid(
    fit: FitResult,
    case: Case,
    controller: Controller | None = None,
    effects: Mapping[str, float] | None = None,
    report: Report = silent,
    before: EarlierCase | None = None,
) -> HybridResult:
    """Simulate a case on the identified machine of a fit, at rest in the beginning.

    Without a `controller` the command is what is wanted. `effects` are further effects of the machine: values by name,
    SI. Its motion is held against the limits of the rig that the case or the fit states. `before` is the case when its
    loop was stable, by which the cause of an unstable one is found. Raises Unusable where fit and case do not go
    together, or the controller has another sample rate than the case; what `report` raises to cancel passes through.
    """
    of, acting = machine(fit, case, effects), controller or no_controller(case.sample_rate)
    found = simulate_machine(of, case, acting, effects, report)
    if isinstance(acting, SampledController) and not of.nonlinear and not found.stable:
        found = replace(found, stability=judge_hybrid(of, case, acting, before))
    if found.ended is not None:  # it ran away, which says more
        return found
    return replace(found, beyond=leaving(fit, case, found.measured, found.command, found.force))


@one_thread()  # small matrices, for which more threads wait longer than they work
def simulate_machine(
    of: Machine,
    case: Case,
    controller: Controller | None = None,
    effects: Mapping[str, float] | None = None,
    report: Report = silent,
) -> HybridResult:
    """As :func:`simulate_hybrid`, of a machine that is at hand."""
    begun = perf_counter()
    acting = controller or no_controller(case.sample_rate)
    ground = case.ground.samples(case.sample_rate)
    wanted = reference_of(of, case, ground)
    _kept, rig = rig_of((of,), (case,), (acting,), driven_by(case, ground), RUNAWAY * np.abs(wanted).max(keepdims=True))
    run(rig, (acting,), report)
    ended = int(rig.ended[0])
    kept = ended >= len(ground)
    radius = None
    if isinstance(acting, SampledController) and not of.nonlinear:
        radius = spectral_radius(of, case, acting)
    d, y, u = rig.d[:, 0], rig.y[:, 0], rig.held[case.delay :, 0]
    return HybridResult(
        case=case,
        controller=name_of(acting),
        effects=dict(effects or {}),
        stable=kept and (radius is None or radius < 1.0),
        scores=scores(y, d, wanted, case.sample_rate) if kept else None,
        command_rms=float(np.std(u)) if kept else None,
        critical_delay=critical_delay(case),
        radius=radius,
        ended=None if kept else ended / case.sample_rate,
        seconds=perf_counter() - begun,
        ground=ground,
        numerical=d,
        measured=y,
        reference=wanted,
        command=u,
        force=rig.f[:, 0],
        notes=notes_of(of) if case.table is None else notes_of(of)[: bool(of.nonlinear)],
        acceleration=acceleration(case, y, ground) if kept and case.table is not None else None,
    )


def notes_of(of: Machine) -> tuple[str, ...]:
    """What is to be known of a simulation of a machine."""
    found = []
    if of.nonlinear:
        names = ", ".join(of.nonlinear)
        found.append(f"stable is said of this record alone: poles judge no loop with {names}")
    held = of_specimen(of)
    if held:
        found.append(f"{HELD} {', '.join(effect.name for effect in held)}")
    if left := [effect.name for effect in of.chain.effects if effect.of_specimen and effect not in held]:
        found.append(f"the reference is the structure without {', '.join(left)}")
    return tuple(found)
