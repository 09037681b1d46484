"""Which runs a figure shows: what the reader asked for, or a few that stand for the rest."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.figures import words
from ident.figures.drawing import Several
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.run import Run
from ident.words.run_name import run_name

CONDITIONS = ("kp", "amplitude", "specimen", "use")
RUNS = ("run", *CONDITIONS)
"""The options of a figure that shows some runs."""


@dataclass(frozen=True)
class RunFilter:
    """Filters by run id, Kp, RMS amplitude (m), specimen (as legends print it) and use; None takes any."""

    run: Sequence[str] | None = None
    kp: Sequence[float] | None = None
    amplitude: Sequence[float] | None = None
    specimen: Sequence[str] | None = None
    use: str | None = None

    @property
    def open(self) -> bool:
        """True where nothing was asked for."""
        return self == RunFilter()

    def allows(self, run: Run) -> bool:
        """Whether a run passes every filter."""
        return (
            (self.run is None or run.id in self.run)
            and (self.kp is None or any(_same(run.gain, value) for value in self.kp))
            and (self.amplitude is None or any(_same(run.amplitude, value) for value in self.amplitude))
            and (self.specimen is None or words.specimen(run.specimen) in self.specimen)
            and (self.use in (None, "all") or run.use == self.use)
        )


def run_filter(
    run: Several = None, kp: Several = None, amplitude: Several = None, specimen: Several = None, use: Several = None
) -> RunFilter:
    """The filter from what a request or a notebook gives: one value or several, numbers also as text."""
    return RunFilter(
        run=_texts(run),
        kp=_numbers("kp", kp),
        amplitude=_numbers("amplitude", amplitude),
        specimen=_texts(specimen),
        use=None if use is None else str(use),
    )


def _texts(option: Several) -> tuple[str, ...] | None:
    if option is None or option == "":
        return None
    return (str(option),) if isinstance(option, str | float | int) else tuple(map(str, option))


def _numbers(name: str, option: Several) -> tuple[float, ...] | None:
    texts = _texts(option)
    try:
        return None if texts is None else tuple(map(float, texts))
    except ValueError:
        raise Unusable("not-a-number", f"{name} is {option!r}", "figure option", "give a number") from None


def _same(stated: float | None, wanted: float) -> bool:
    """Equal as a reader of labels means it: within 1 %."""
    return stated is not None and abs(stated - wanted) <= 0.01 * abs(wanted)


def chosen(matrix: Matrix, wanted: RunFilter) -> tuple[Run, ...]:
    """The runs that pass; without a filter the verify runs, or all without these. Raises Unusable where none pass."""
    if wanted.open:
        return matrix.of_use("verify") or matrix.runs
    runs = tuple(run for run in matrix.runs if wanted.allows(run))
    if not runs:
        asked = ", ".join(f"{name} {value}" for name, value in vars(wanted).items() if value is not None)
        raise Unusable("no-such-run", f"no run with {asked}", "figure", "choose among the runs of the matrix")
    return runs


def filter_in(options: Mapping[str, Any], names: Sequence[str] = RUNS) -> RunFilter:
    """The filter among the options of a figure."""
    return run_filter(**{name: options[name] for name in names if name in options})


def selected_run(matrix: Matrix, options: Mapping[str, Any]) -> Run | None:
    """The run that was asked for by its id."""
    return None if not options.get("run") else chosen(matrix, run_filter(run=options["run"]))[0]


def typical_run(matrix: Matrix, fit: FitResult) -> Run:
    """The verify run (or, without one, the run) whose error is the middle one."""
    runs = matrix.of_use("verify") or matrix.runs
    errors = {entry.id: entry.error for entry in fit.runs}
    ordered = sorted(runs, key=lambda run: errors.get(run.id, 0.0))
    return ordered[len(ordered) // 2]


def unstable_on(run: Run) -> Unusable:
    """The refusal of a figure of the residual where the model runs away."""
    return Unusable("unstable-model", f"the model is unstable on {run_name(run.id)}", "fit", "choose another run")


def by_gain(runs: Sequence[Run]) -> dict[float | None, list[Run]]:
    """Runs grouped by Kp, in numeric order."""
    groups: dict[float | None, list[Run]] = defaultdict(list)
    for run in sorted(runs, key=lambda run: (run.gain is None, run.gain or 0.0)):
        groups[run.gain].append(run)
    return dict(groups)


def representative(runs: Sequence[Run], count: int) -> list[Run]:
    """At most `count` runs that differ in specimen first: the middle amplitude, specimens evenly spread by k/m."""
    if len(runs) <= count:
        return list(runs)
    ordered = sorted(runs, key=_natural_frequency)
    amplitudes = sorted({run.amplitude for run in runs if run.amplitude is not None})
    if amplitudes:
        middle = amplitudes[len(amplitudes) // 2]
        ordered = [run for run in ordered if _same(run.amplitude, middle)]
    places = np.unique(np.linspace(0, len(ordered) - 1, count).round().astype(int))
    return [ordered[place] for place in places]


def _natural_frequency(run: Run) -> tuple[float, float]:
    specimen = run.specimen
    if specimen is None or specimen.mass == 0:
        return (0.0, 0.0)
    return (specimen.stiffness / specimen.mass, specimen.mass)
