"""The face: a matrix in; what is doubtful about it, an identified actuator, how well it agrees, and what it lacks.

Who serves which kind of model stands in one table here; the rooms below take a fitter or a simulator as an argument.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ident import figures
from ident.bench.diagnosis import diagnose_bench
from ident.bench.identification import BenchIdentification
from ident.bench.outputs import outputs as bench_outputs
from ident.checks.check import Finding, check
from ident.comparison import compare as comparison
from ident.comparison.compare import Comparison, Simulator
from ident.custom.definition import preset_with
from ident.diagnosis import diagnose as diagnosis
from ident.diagnosis.course import Course
from ident.diagnosis.result import Diagnosis
from ident.diagnosis.stepwise import MOST, USUAL
from ident.diagnosis.structures import ChosenFit, Made, chosen
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.figures import Chart, Study
from ident.fit.identification import Identification, StepwiseFit, check_settings, completed
from ident.fit.regressed import RegressedIdentification
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.hybrid.kalman_identification import KalmanIdentification
from ident.matrix import Matrix
from ident.presets.preset import Kind
from ident.progress import Report, silent
from ident.readers import read_matrix

Fitter = Callable[[Matrix, Settings, Report], StepwiseFit]
Diagnoser = Callable[[Matrix, FitResult, Sequence[Effect], Course], Diagnosis]


@dataclass(frozen=True)
class Served:
    """Who serves a kind of model: its fitter, those of methods of their own, its simulator and its diagnoser.

    It `proposes` terms that no list holds where its models have signals inside.
    """

    fitter: Fitter
    simulator: Simulator
    diagnoser: Diagnoser
    by_method: Mapping[str, Fitter]
    proposes: bool = False


SERVED: Mapping[Kind, Served] = {
    "chain": Served(
        Identification,
        comparison.modelled,
        diagnosis.diagnose,
        {"inverse-dynamics": RegressedIdentification, "ekf": KalmanIdentification},
        proposes=True,
    ),
    "bench": Served(BenchIdentification, bench_outputs, diagnose_bench, {}),
}


def _served(model: str) -> Served:
    return SERVED[preset_with(model).kind]


def identification(matrix: Matrix, settings: Settings, report: Report = silent) -> StepwiseFit:
    """The steps of a fit: of test runs, of the records of a bench, or by regression.

    Without a model that which fits is taken, of those that the channels allow. Raises Unusable for settings that no
    matrix could be fitted with, and where the matrix does not allow the fit.
    """
    check_settings(settings)
    if not settings.model:
        choice = chosen(matrix, report)
        named = replace(settings, model=choice.structures[0].machine)
        made = choice.made(named)
        return ChosenFit(Made(made) if made else identification(choice.matrix, named, report), choice.structures)
    served = _served(settings.model)
    return served.by_method.get(settings.method, served.fitter)(matrix, settings, report)


def identify(matrix: Matrix, settings: Settings | None = None, report: Report = silent) -> FitResult:
    """The whole fit in one call. Raises Unusable as :func:`identification`."""
    return completed(identification(matrix, settings or Settings(), report))


def compare(matrix: Matrix, fit: FitResult) -> Comparison:
    """Every run of the matrix against the fitted model. Raises Unusable where the fit is of another model's data."""
    return comparison.compare(matrix, fit, _served(fit.model).simulator)


def study(matrix: Matrix, fit: FitResult) -> Study:
    """A fit beside its data, for figures one after the other."""
    return Study(matrix, fit, _served(fit.model).simulator)


def figure(
    name: str, matrix: Matrix, fit: FitResult, theme: str = "light", share: float = 1.0, **options: Any
) -> Chart:  # fmt: skip
    """The figure of that name: see :func:`ident.figures.figure` for its options, and :func:`study` for several."""
    return figures.figure(name, study(matrix, fit), theme, share, **options)


def diagnose(
    matrix: Matrix, fit: FitResult | None = None, settings: Settings | None = None, most: int = USUAL,
    custom: Sequence[Effect] = (), report: Report = silent, seconds: float | None = None,
    found: Callable[[Diagnosis], None] | None = None, propose: bool | None = None,
) -> Diagnosis:  # fmt: skip
    """Rank what the fitted model lacks, add what helps beyond chance, and say what is left.

    Without a `fit` the model of `settings` is fitted first. `most` is the largest number of effects to add, `custom`
    are effects beside the catalogue's. Verify runs only report. After `seconds`, that of a fit included, nothing more
    is tried; `found` is told of the diagnosis as it stands after each effect. Terms that no list holds are searched for
    where the catalogue leaves the error unexplained; with `propose` true also where nobody knows the noise, with false
    never. Raises Unusable where matrix, fit or settings do not go together.
    """
    if not 0 <= most <= MOST:
        raise Unusable("bad-option", f"{most} effects", "max-effects", f"give 0 to {MOST}")
    if seconds is not None and not seconds > 0:
        raise Unusable("bad-option", f"{seconds:g} s", "time", "give the seconds that it may take")
    course = Course(most, seconds, report, found, propose=propose)
    fit = fit or identify(matrix, settings, report)
    served = _served(fit.model)
    if propose and not served.proposes:
        raise Unusable("bad-option", f"the model {fit.model} has no signals inside that a term could be of", "propose",
                       "leave it out")  # fmt: skip
    return served.diagnoser(matrix, fit, custom, course)


@dataclass(frozen=True)
class Story:
    """What came out, in the order in which a user asks."""

    findings: tuple[Finding, ...]  # can I trust the data?
    fit: FitResult  # what are the parameters, and how sure are they?
    comparison: Comparison  # how good is it, and where?


def run(path: Path, settings: Settings | None = None, report: Report = silent) -> Story:
    """Read, check, fit and compare. Raises Unusable where the input cannot be used."""
    matrix = read_matrix(path)
    findings = check(matrix)
    fit = identify(matrix, settings, report)
    return Story(findings, fit, compare(matrix, fit))
