"""A real-time hybrid simulation: what comes out when an identified machine moves the physical part of a structure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from time import perf_counter
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller import SampledController
from ident.hybrid.hybrid_loop import EarlierCase, judge_hybrid
from ident.hybrid.loop import LANES, Rig, advance_under, close, read
from ident.hybrid.machine import DISPLACEMENT, FORCE, Machine, machine
from ident.hybrid.rig_limits import leaving
from ident.hybrid.scores import Scores, scores
from ident.hybrid.stability import critical_delay, spectral_radius
from ident.hybrid.substructure import numerical, reference
from ident.progress import Progress, Report, silent
from ident.simulation.stepper import Stepper, stepper
from ident.stability.judgement import STABLE, UNSTABLE, Judgement
from ident.words.engineering import quantity
from ident.words.message import message
from ident.words.percent import percent
from ident.words.shown import Listing, Shown

Array = NDArray[np.float64]
RUNAWAY = 50.0
"""Times the largest displacement of the reference: beyond it a hybrid simulation has run away."""
_CHUNK = 8192  # samples between two reports
_STAGE = "hybrid simulation"


class Compensator(Protocol):
    """A controller that is no sampled linear one: what is wanted and what was measured in, the command out, all m."""

    def step(self, d: float, y: float) -> float:
        """The command u(k) that answers d(k) and y(k), called once a sample, in their order."""
        ...


Controller = SampledController | Compensator


def no_controller(sample_rate: float) -> SampledController:
    """u = d: the machine is told what is wanted."""
    return SampledController(
        np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([[1.0, 0.0]]), sample_rate, "none"
    )


def name_of(controller: Controller) -> str:
    """What a controller is called: by its own name, else by what it is."""
    return getattr(controller, "name", "") or type(controller).__name__.lower()


@dataclass(frozen=True, eq=False, kw_only=True)
class HybridResult(Shown):
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
            "units": {"scores": "1, delay s", "command_rms": "m", "critical_delay": "s", "ended": "s",
                      "sample_rate": "Hz", "delay": "samples", "seconds": "s"},
            "notes": [*self.beyond, *self.notes],
            "seconds": self.seconds,
        }  # fmt: skip


def simulate_hybrid(
    fit: FitResult, case: Case, controller: Controller | None = None, effects: Mapping[str, float] | None = None,
    report: Report = silent, before: EarlierCase | None = None,
) -> HybridResult:  # fmt: skip
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


def simulate_machine(
    of: Machine, case: Case, controller: Controller | None = None, effects: Mapping[str, float] | None = None,
    report: Report = silent,
) -> HybridResult:  # fmt: skip
    """As :func:`simulate_hybrid`, of a machine that is at hand."""
    begun = perf_counter()
    acting = controller or no_controller(case.sample_rate)
    ground = case.ground.samples(case.sample_rate)
    wanted = reference(case, ground)
    _kept, rig = rig_of((of,), (case,), acting, ground, RUNAWAY * float(np.abs(wanted).max()))
    run(rig, acting, report)
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
        notes=_notes(of),
    )


def _notes(of: Machine) -> tuple[str, ...]:
    found = []
    if of.nonlinear:
        names = ", ".join(of.nonlinear)
        found.append(f"stable is what this record showed: {names} cannot be judged by poles")
    if any(effect.of_specimen for effect in of.chain.effects):
        found.append("the reference is the structure as stated, without the effects of the specimen")
    return tuple(found)


def run(rig: Rig, acting: Controller, report: Report = silent) -> None:
    """Take a rig through its whole record, or until everything in it has run away."""
    n = len(rig.ground)
    for first in range(0, n, _CHUNK):
        report(Progress(_STAGE, first, n))
        last = min(first + _CHUNK, n)
        if isinstance(acting, SampledController):
            if not advance_under(first, last, rig):
                break
        elif not _under(first, last, rig, acting):
            break
    report(Progress(_STAGE, n, n))


def _under(first: int, last: int, rig: Rig, acting: Compensator) -> bool:
    """Samples under a controller that is asked sample by sample; whether the system is still there."""
    step = acting.step
    for k in range(first, last):
        d, y = read(k, rig)
        if rig.ended[0] <= k:
            return False
        close(k, 0, step(d, y), rig)
    return True


def rig_of(
    machines: tuple[Machine, ...], cases: tuple[Case, ...], acting: Controller, ground: Array, limit: float
) -> tuple[Stepper, Rig]:
    """The rig of up to sixteen machines, each in its case, side by side, at rest.

    The machines share their equations, and the cases all but their physical part. The stepper keeps the machine code
    that the rig calls.
    """
    n, count, case, of = len(ground), len(cases), cases[0], machines[0]
    known = [one.at(its) for one, its in zip(machines, cases, strict=True)]
    values = {name: np.array([entry[name] for entry in known]) for name in of.chain.symbols}
    steps = max(one.steps(its) for one, its in zip(machines, cases, strict=True))
    built = stepper(of.chain, values, case.sample_rate, steps, (DISPLACEMENT, FORCE))
    parts = [numerical(one) for one in cases]
    linear = acting if isinstance(acting, SampledController) else no_controller(case.sample_rate)
    rng = np.random.default_rng(case.noise.seed)
    noise = rng.standard_normal((n, 2)) * [case.noise.displacement, case.noise.force]
    return built, Rig(
        code=built.code, buffer=built.buffer, command=built.command, displacement=built.shown[0], force=built.shown[1],
        steps=built.steps, whole=built.whole, broken=built.share > 0, lanes=built.lanes,
        window=np.zeros(LANES * built.steps), places=np.zeros(LANES, dtype=np.int64), spare=np.zeros(LANES),
        delay=case.delay, held=np.zeros((n + case.delay, count)),
        phi=np.array([part.phi for part in parts]),
        drives=np.array([[part.force0, part.force1, part.ground0, part.ground1] for part in parts]),
        place=case.place, z=np.zeros((count, 2 * case.storeys)), before=np.zeros(count),
        A=linear.A, B=linear.B, C=linear.C, D=linear.D, x=np.zeros((count, linear.order)),
        ground=ground, noise=noise,
        quantum=np.array([case.noise.displacement_step, case.noise.force_step]),
        d=np.zeros((n, count)), y=np.zeros((n, count)), f=np.zeros((n, count)),
        limit=np.full(count, limit), ended=np.full(count, n, dtype=np.int64),
        scratch=np.zeros(max(2 * case.storeys, linear.order)),
    )  # fmt: skip
