"""A test plan: the runs of a program, each scaled to stay inside the limits of the rig, or refused.

The peaks of a run are predicted over the corners of what the parameters of the fitted model may be; without a model the
command alone is held against the limits. A run whose largest share of a limit is above 98 % is scaled to that; one that
would have to shrink below a tenth of what the program asks, or whose loop is unstable at a corner, is refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ident.design.predicted_peaks import Peaks, UncertainMachine, peaks_of_command, uncertain_machine
from ident.design.spread import Spread
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.plain import Misfit, read, written
from ident.planning.bench_program import KONONYKHIN, UncertainBench, bench_plans, uncertain_bench
from ident.planning.files import description, write_folder
from ident.planning.law import Law
from ident.planning.planned_run import PlannedRun, RefusedRun
from ident.planning.programs import QIAN, Settings, program_of, qian_program, read_program
from ident.planning.signal import AskedRun, Program
from ident.progress import Progress, Report, silent
from ident.rig.limits import RigLimits, Utilisation
from ident.run import Run
from ident.words.number import count, plain
from ident.words.percent import percent
from ident.words.result_tables import Listing, TabularResult
from ident.words.run_name import run_name
from ident.words.sentence import first_of

AIM = 0.98
"""Share of the tightest limit that a run takes at the worst corner: the rest is for what lies between the points."""
LEAST = 0.1
"""Share of the amplitude that a program asks below which a run is refused: its answer would drown in the noise."""
_TRIES = 8  # of a machine whose peaks do not grow in proportion
_STAGE = "plan"


@dataclass(frozen=True)
class Plan(TabularResult):
    """The runs of a program on a rig. `model` is that of the fit, "" where the commands alone were judged.

    `unjudged` are limits that are stated and that nothing predicts.
    """

    program: str
    model: str
    spread: str
    actuator: Actuator
    limits: RigLimits
    runs: tuple[PlannedRun, ...]
    refused: tuple[RefusedRun, ...] = ()
    unjudged: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def median_share(self) -> float | None:
        """The median over the runs of what each takes of its tightest limit."""
        shares = [run.share for run in self.runs if run.share is not None]
        return float(np.median(shares)) if shares else None

    def listings(self) -> Iterator[Listing | str]:
        """What cannot be first, then every run with its share of the tightest limit, then notes."""
        if self.refused:
            refused = [
                (one.id, one.why, "none" if one.factor is None else plain(one.factor, 3)) for one in self.refused
            ]
            yield Listing("refused", ("run", "why", "factor that would do"), refused, ("factor that would do",))
        rows = [
            (run.id, run.use, run.words, percent(run.scale), percent(run.share), run.limit or "–") for run in self.runs
        ]
        header = ("run", "use", "amplitude", "of what is asked", "share", "of the limit")
        yield Listing("", header, rows, ("of what is asked", "share"))
        yield from self.sentences()

    def sentences(self) -> Iterator[str]:
        """What a reader has to know of the plan."""
        if not self.limits:
            yield "No limit of the rig is stated: the amplitudes are those of the program."
        elif self.model:
            yield f"Peaks are predicted with the model {self.model} over {self.spread}."
        else:
            yield "No model is given: the limits are held against the commands alone, as if the machine followed them."
        if self.median_share is not None:
            yield f"In the median a run takes {percent(self.median_share)} of its tightest limit."
        scaled = [run.id for run in self.runs if run.scale < 1]
        if scaled:
            yield f"{count(len(scaled), 'run')} of {len(self.runs)} scaled to stay inside: {first_of(scaled)}."
        if self.unjudged:
            yield f"Not judged, for nothing predicts it: {', '.join(self.unjudged)}."
        yield from self.notes

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data, SI."""
        data: dict[str, Any] = written(self)
        return data

    @classmethod
    def from_json(cls, data: object) -> Plan:
        """The inverse of :meth:`to_json`. Raises Unusable."""
        try:
            return read(cls, data)
        except Misfit as error:
            raise Unusable("bad-plan", f"not the JSON of a plan: {error}", "plan", "make the plan again") from None

    def write(self, out: Path | str, formats: Iterable[str] = ("csv",), report: Report = silent) -> None:
        """The command files, plan.json and a matrix.yaml that the answers drop into: :mod:`ident.planning.files`.

        `out` must not exist or be empty; `formats` are among csv, mat, tdms. Raises Unusable.
        """
        measured = description(self.actuator, self.limits, self.runs)
        write_folder(Path(out), self.runs, self.to_json(), measured, tuple(formats), report)


def plan(
    program: str | Path | Mapping[str, Any],
    fit: FitResult | None = None,
    rig: RigLimits | None = None,
    seconds: float | None = None,
    ramp: float | None = None,
    seed: int = 0,
    spread: Spread | None = None,
    least: float = LEAST,
    report: Report = silent,
) -> Plan:
    """Plan a program of runs for a rig: `qian`, `kononykhin`, the path of a YAML file, or its content.

    `rig` are the limits; without them those of the fit's matrix. `seconds` is the length of a run, `ramp` (s) that in
    which a command grows and that in which it fades. `spread` is what the parameters of the fit may be off; `least` the
    smallest share of the amplitude asked to which a run is scaled: 1 leaves every amplitude as it is. Raises Unusable
    where program and fit do not go together, and where no run can be.
    """
    if not 0 < least <= 1:
        raise Unusable("bad-value", f"a least share of {least:g}", "least", "give more than 0, at most 1")
    actuator = fit.actuator if fit is not None and fit.actuator is not None else Actuator("UNNAMED")
    limits = actuator.rig_limits if rig is None else rig.over(actuator.rig_limits)
    actuator = replace(actuator, rig=limits or None)
    settings, spread = Settings(seconds, ramp, seed), spread or Spread()
    within = Inside(limits, least)
    asked = asked_program(program, settings)
    if asked is None:
        machine = None if fit is None else uncertain_bench(fit, spread, actuator, limits)
        name, judged = KONONYKHIN, list(_bench_runs(machine, limits, within, report))
    else:
        name, judged = asked.name, list(_loop_runs(asked.runs, fit, spread, actuator, within, report))
    runs = tuple(one for one in judged if isinstance(one, PlannedRun))
    refused = tuple(one for one in judged if isinstance(one, RefusedRun))
    if not runs:
        raise _nothing_left(refused[0])
    known = set.intersection(*(set(run.peaks) for run in runs))
    model = "" if fit is None else " + ".join((fit.model, *fit.effects))
    unjudged = limits.unjudged(dict.fromkeys(known, 0.0))
    return Plan(name, model, str(spread) if model else "", actuator, limits, runs, refused, unjudged)


def asked_program(program: str | Path | Mapping[str, Any], settings: Settings) -> Program | None:
    """The runs of a position loop or a valve that a program asks for; None for Kononykhin's laws, which a bench plays.

    Raises Unusable.
    """
    if program == KONONYKHIN:
        if settings.seconds is not None or settings.ramp is not None:
            raise Unusable(
                "bad-option", "the laws of a bench have their own lengths and ramps", "seconds, ramp", "leave them out"
            )
        return None
    if isinstance(program, Mapping):
        return program_of(program, settings)
    return qian_program(settings) if program == QIAN else read_program(program, settings)


def _nothing_left(first: RefusedRun) -> Unusable:
    """The refusal of a plan of which no run is left."""
    remedy = "give a rig with wider limits, or another gain"
    if first.factor is not None:
        remedy = f"shrink its amplitude to {first.factor:.3g} times what is asked, or allow that by a smaller least"
    return Unusable("beyond-limits", f"no run keeps the limits: {first.why}", run_name(first.id), remedy)


@dataclass(frozen=True)
class Inside:
    """What it means to be inside the limits: how much a run may take, and how far it may be scaled."""

    limits: RigLimits
    least: float = LEAST

    def tightest(self, peaks: Peaks) -> Utilisation | None:
        """The limit of which most is taken; None where nothing is judged."""
        found = self.limits.utilisation(peaks.sizes)
        return found[0] if found else None

    def refusal(self, name: str, peaks: Peaks, factor: float) -> RefusedRun | None:
        """Why a run cannot be that has to shrink by a factor; None where it can."""
        if not peaks.stable:
            return RefusedRun(name, "the loop is unstable at a corner of what the parameters may be")
        if factor >= self.least:
            return None
        worst = self.tightest(peaks)
        return RefusedRun(name, str(worst), factor)


def _loop_runs(
    asked: tuple[AskedRun, ...],
    fit: FitResult | None,
    spread: Spread,
    actuator: Actuator,
    within: Inside,
    report: Report,
) -> Iterator[PlannedRun | RefusedRun]:
    """Each run of a position loop, scaled or refused."""
    machine: UncertainMachine | None = None
    for number, one in enumerate(asked):
        report(Progress(_STAGE, number, len(asked)))
        run = _run(one)
        if fit is not None and machine is None:
            machine = uncertain_machine(fit, spread, run, actuator)

        def peaks(factor: float, run: Run = run, machine: UncertainMachine | None = machine) -> Peaks:
            louder = replace(run, channels={name: factor * samples for name, samples in run.channels.items()})
            return peaks_of_command(louder, actuator) if machine is None else machine.peaks(louder)

        yield _scaled(one, peaks, within)
    report(Progress(_STAGE, len(asked), len(asked)))


def _run(asked: AskedRun) -> Run:
    """The run before it was recorded."""
    signal = asked.signal
    command = signal.command()
    units = {"command": signal.unit, "displacement": "m"}
    return Run(
        asked.id,
        "",
        signal.sample_rate,
        {"command": command, "displacement": np.zeros(len(command))},
        units,
        specimen=asked.specimen,
        gain=asked.gain,
        kind=asked.kind,
        use=asked.use,
    )


def _scaled(asked: AskedRun, peaks: Any, within: Inside) -> PlannedRun | RefusedRun:
    """A run at the amplitude that keeps it inside, or why there is none."""
    factor, found = 1.0, peaks(1.0)
    first = found
    for _ in range(_TRIES):
        worst = within.tightest(found)
        if not found.stable or worst is None or worst.share <= AIM:
            break
        factor *= AIM / worst.share
        found = first.times(factor) if found.linear else peaks(factor)
    if refused := within.refusal(asked.id, first if found.stable else found, factor):
        return refused
    worst = within.tightest(found)
    signal = replace(asked.signal, amplitude=factor * asked.signal.amplitude)
    return PlannedRun(
        id=asked.id,
        kind=asked.kind,
        use=asked.use,
        asked=asked.signal.amplitude,
        signal=signal,
        law=None,
        specimen=asked.specimen,
        gain=asked.gain,
        limit=worst.limit if worst else "",
        share=worst.share if worst else None,
        peaks=found.sizes,
    )


def _bench_runs(
    machine: UncertainBench | None, limits: RigLimits, within: Inside, report: Report
) -> Iterator[PlannedRun | RefusedRun]:
    """Each record of a bench, scaled or refused."""
    todo = bench_plans(limits, machine)
    stroke = machine.stroke if machine else (limits.stroke or 0.0)
    for number, asked in enumerate(todo):
        report(Progress(_STAGE, number, len(todo)))
        law = whole = Law.of(asked)
        found = first = Peaks({}) if machine is None else machine.peaks(asked)
        factor = 1.0
        for _ in range(_TRIES):
            worst = within.tightest(found)
            if machine is None or worst is None or worst.share <= AIM:
                break
            factor *= AIM / worst.share
            law = whole.times(factor, stroke)
            found = machine.peaks(replace(asked, settings=law.settings, seconds=law.seconds, start=law.start))
        worst = within.tightest(found)
        refused = within.refusal(asked.id, first, factor)
        if refused is None and worst is not None and worst.share > 1:
            refused = RefusedRun(asked.id, f"{worst}, whatever its size")
        yield refused or PlannedRun(
            id=asked.id,
            kind=asked.kind,
            use="fit",
            asked=whole.size,
            signal=None,
            law=law,
            specimen=None,
            gain=None,
            limit=worst.limit if worst else "",
            share=worst.share if worst else None,
            peaks=found.sizes,
        )
    report(Progress(_STAGE, len(todo), len(todo)))
