"""A real-time hybrid simulation with several actuators on one structure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.controller import Controller, SampledController, name_of, no_controller
from ident.hybrid.coupled_case import CoupledCase
from ident.hybrid.coupled_loop import CoupledLoop, EarlierParts, judge_coupled
from ident.hybrid.coupled_stability import DelayMap, coupled_critical_delay, coupled_poles, delay_map, with_poles
from ident.hybrid.hybrid_simulation import HELD, RUNAWAY, HybridResult, notes_of
from ident.hybrid.machine import Machine, machine
from ident.hybrid.rig_assembly import rig_of, run
from ident.hybrid.rig_limits import leaving
from ident.hybrid.scores import Scores, scores
from ident.hybrid.specimen_effects import of_specimen
from ident.hybrid.substructure import reference
from ident.parallel import one_thread
from ident.progress import Report, silent
from ident.words.engineering import quantity
from ident.words.message import message
from ident.words.percent import percent
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class CoupledResult(TabularResult):
    """What a hybrid simulation with several actuators gave: of each part, by its name, what one actuator gives.

    `stable`, `ended` (s), `radius`, `critical_delay` (s) and `stability` are those of the whole loop, and stand with
    each part, too. `delay_map` is there where it was asked for.
    """

    case: CoupledCase
    parts: Mapping[str, HybridResult]
    seconds: float
    delay_map: DelayMap | None = None

    @property
    def first(self) -> HybridResult:
        """The first part, which has what holds for all."""
        return next(iter(self.parts.values()))

    @property
    def stable(self) -> bool:
        """Whether the whole loop is."""
        return self.first.stable

    @property
    def scores(self) -> Scores | None:
        """The largest of each score over the parts, of a delay the one of largest size; None where it ran away."""
        found = [one.scores for one in self.parts.values() if one.scores is not None]
        if not found:
            return None
        names = Scores.__dataclass_fields__
        largest: dict[str, Any] = {name: max((getattr(one, name) for one in found), key=abs) for name in names}
        return Scores(**largest)

    def listings(self) -> Iterator[Listing | str]:
        """What is unstable or leaves the limits of a rig, the scores of each part, the verdict, the notes."""
        first = self.first
        yield from first.stability.text if first.stability else ()
        for name, one in self.parts.items():
            yield from (f"{name}: {said}" for said in one.beyond)
        yield Listing("", (f"case {self.case.name}", *self.parts), self._rows(), tuple(self.parts))
        critical = "none" if first.critical_delay is None else quantity(first.critical_delay, "s")
        yield f"critical delay of all parts, otherwise perfect: {critical}"
        said = message("rig.stable" if self.stable else "rig.unstable")
        if first.ended is not None:
            said = message("rig.ran_away", after=(first.ended, "s"))
        names = ", ".join(f"{name} {one.controller}" for name, one in self.parts.items())
        yield f"{said}; controllers {names}; {self.case.ground.name}; {self.seconds:.2f} s of computing"
        for note in first.notes:
            yield f"note: {note}"
        if self.delay_map is not None:
            yield from self.delay_map.listings()

    def _rows(self) -> Iterator[tuple[str, ...]]:
        """A row a score, a column a part."""
        if self.first.scores is None:
            return
        for name in Scores.__dataclass_fields__:
            values = [getattr(one.scores, name) for one in self.parts.values()]
            yield name, *(quantity(value, "s") if name == "delay" else percent(value) for value in values)
        yield "command_rms", *(quantity(one.command_rms or 0.0, "m") for one in self.parts.values())

    def with_notes(self, notes: Sequence[Sequence[str]]) -> CoupledResult:
        """The same with notes of each part before its own; one that only some have names these."""
        of: dict[str, list[str]] = {}
        for name, said in zip(self.parts, notes, strict=True):
            for one in said:
                of.setdefault(one, []).append(name)
        further = [one if len(names) == len(self.parts) else f"{', '.join(names)}: {one}" for one, names in of.items()]
        parts = {name: replace(one, notes=(*further, *one.notes)) for name, one in self.parts.items()}
        return replace(self, parts=parts)

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data: what one actuator gives, of the worst of the parts, and `parts` with each of them."""
        data, worst = self.first.to_json(), self.scores
        commands = [one.command_rms for one in self.parts.values() if one.command_rms is not None]
        notes = [f"{name}: {said}" for name, one in self.parts.items() for said in one.beyond]
        return data | {
            "case": self.case.name,
            "controller": ", ".join(dict.fromkeys(one.controller for one in self.parts.values())),
            "scores": data["scores"] if worst is None else vars(worst),
            "command_rms": max(commands, default=None),
            "delay": max(case.delay for case in self.case.cases),
            "notes": [*notes, *self.first.notes],
            "seconds": self.seconds,
            "parts": [{"name": name, **one.to_json()} for name, one in self.parts.items()],
            "delay_map": None if self.delay_map is None else self.delay_map.to_json(),
        }


def simulate_coupled(
    fits: Sequence[FitResult],
    case: CoupledCase,
    controllers: Sequence[Controller],
    effects: Mapping[str, float] | None = None,
    report: Report = silent,
    before: EarlierParts | None = None,
) -> CoupledResult:
    """Simulate a case of several actuators, each the machine of its fit under its controller, at rest in the beginning.

    `effects` are further effects of every machine: values by name, SI. Each motion is held against the limits of its
    part. `before` is the case when its loop was stable, by which the cause of an unstable one is found. Raises Unusable
    as :func:`ident.hybrid.hybrid_simulation.simulate_hybrid`.
    """
    machines = machines_of(fits, case, effects)
    found = simulate_machines(machines, case, controllers, effects, report, before)
    if found.first.ended is not None:
        return found
    parts = {
        name: replace(one, beyond=leaving(fit, one.case, one.measured, one.command, one.force))
        for fit, (name, one) in zip(fits, found.parts.items(), strict=True)
    }
    return replace(found, parts=parts)


def simulate_compared(
    fits: Sequence[FitResult],
    case: CoupledCase,
    controllers: Sequence[Controller],
    effects: Mapping[str, float] | None = None,
    *,
    without: bool,
    mapped: bool,
    report: Report = silent,
    before: EarlierParts | None = None,
) -> tuple[CoupledResult, CoupledResult | None]:
    """The simulation, `mapped` with its map over delays; and the same `without` controllers, None if not wanted.

    Raises Unusable before anything is simulated, also where there can be no map.
    """
    machines = machines_of(fits, case, effects)
    if mapped:
        with_poles(machines, controllers)
    found = simulate_coupled(fits, case, controllers, effects, report, before)
    nothing = [no_controller(case.sample_rate)] * len(fits)
    alone = simulate_coupled(fits, case, nothing, effects, report) if without else None
    if mapped:
        found = replace(found, delay_map=delay_map(machines, case, controllers, report=report))
    return found, alone


def machines_of(
    fits: Sequence[FitResult], case: CoupledCase, effects: Mapping[str, float] | None = None
) -> tuple[Machine, ...]:
    """The machine of each part. Raises Unusable where the specimen's inertia has no place in one."""
    found = tuple(machine(fit, part.case, effects) for fit, part in zip(fits, case.parts, strict=True))
    for one, part, coupling in zip(found, case.parts, case.coupling[0], strict=True):
        if coupling.any() and not one.has_inertia:
            raise Unusable(
                "no-inertia",
                f"part {part.name}: its model has no force that would move a mass",
                "specimen mass",
                "leave the mass to the numerical part",
            )
    return found


@one_thread()  # small matrices, for which more threads wait longer than they work
def simulate_machines(
    machines: Sequence[Machine],
    case: CoupledCase,
    controllers: Sequence[Controller],
    effects: Mapping[str, float] | None = None,
    report: Report = silent,
    before: EarlierParts | None = None,
) -> CoupledResult:
    """As :func:`simulate_coupled`, of machines that are at hand."""
    begun = perf_counter()
    ground = case.ground.samples(case.sample_rate)
    wanted = [reference(one, ground) for one in case.cases]
    limits = np.array([RUNAWAY * float(np.abs(one).max()) for one in wanted])
    largest = np.full(len(limits), limits.max())  # a part that hardly moves in the whole may move in the loop
    _kept, rig = rig_of(machines, (case,), controllers, ground, largest)
    run(rig, controllers, report)
    whole = _whole(machines, case, controllers, int(rig.ended[0]), len(ground), before)
    kept = whole["ended"] is None
    parts = {
        part.name: HybridResult(
            case=part.case,
            controller=name_of(controllers[p]),
            effects=dict(effects or {}),
            scores=scores(rig.y[:, p], rig.d[:, p], wanted[p], case.sample_rate) if kept else None,
            command_rms=float(np.std(rig.held[part.case.delay : len(ground), p])) if kept else None,
            seconds=perf_counter() - begun,
            ground=ground,
            numerical=rig.d[:, p],
            measured=rig.y[:, p],
            reference=wanted[p],
            command=rig.held[part.case.delay : part.case.delay + len(ground), p],
            force=rig.f[:, p],
            notes=_notes(machines),
            **whole,
        )
        for p, part in enumerate(case.parts)
    }
    return CoupledResult(case=case, parts=parts, seconds=perf_counter() - begun)


def _whole(
    machines: Sequence[Machine],
    case: CoupledCase,
    controllers: Sequence[Controller],
    ended: int,
    samples: int,
    before: EarlierParts | None,
) -> dict[str, Any]:
    """What holds for the whole loop: whether it is stable, by its poles where it has them."""
    kept, radius, judged = ended >= samples, None, None
    sampled = [one for one in controllers if isinstance(one, SampledController)]
    if len(sampled) == len(controllers) and not any(one.nonlinear for one in machines):
        radius = float(np.abs(coupled_poles(machines, case, sampled)).max())
        judged = (
            None
            if radius < 1.0
            else judge_coupled(
                CoupledLoop(machines, case, sampled),
                None if before is None else CoupledLoop(machines_of(before.fits, before.case), before.case, sampled),
            )
        )
    return {
        "stable": kept and (radius is None or radius < 1.0),
        "radius": radius,
        "stability": judged,
        "critical_delay": coupled_critical_delay(case),
        "ended": None if kept else ended / case.sample_rate,
    }


def _notes(machines: Sequence[Machine]) -> tuple[str, ...]:
    held = [effect.name for one in machines for effect in of_specimen(one)]
    of_each = (note for one in machines for note in notes_of(one) if not note.startswith(HELD))
    linear = [f"the reference is the structure without {', '.join(dict.fromkeys(held))}"] if held else []
    return tuple(dict.fromkeys([*of_each, *linear]))
