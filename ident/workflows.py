"""The face: a matrix in; what is doubtful about it, an identified actuator, how well it agrees, and what it lacks.

Who serves which kind of model stands in one table here; the rooms below take a fitter or a simulator as an argument.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from ident.bench.continued import ContinuedBench
from ident.bench.diagnosis import diagnose_bench
from ident.bench.identification import BenchIdentification
from ident.bench.outputs import outputs as bench_outputs
from ident.comparison import compare as comparison
from ident.comparison.compare import Comparison, Simulator
from ident.custom.definition import preset_with, read_effect
from ident.design import proposal as design
from ident.design.experiment import Experiment
from ident.design.spread import USUAL, Spread
from ident.diagnosis import diagnose as diagnosis
from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.competing_models import competing_models
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.recommended import settings_after
from ident.diagnosis.result import Diagnosis
from ident.diagnosis.structure_selection import choose_structure
from ident.diagnosis.unfitted import unfitted
from ident.effects.effect import Effect
from ident.errors import TimeIsUp, Unusable
from ident.fit.alternatives import CompletedFit, FitWithAlternatives
from ident.fit.choices import Choices, settings_of
from ident.fit.continued import ContinuedIdentification
from ident.fit.drive_regression import RegressedIdentification
from ident.fit.identification import Identification, StepwiseFit, check_settings, completed
from ident.fit.parameter_bounds import Bounds, with_candidates_given
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.hybrid.kalman_identification import KalmanIdentification
from ident.matrix import Matrix
from ident.parallel import one_thread
from ident.planning import plan as planning
from ident.planning.plan import LEAST, Plan
from ident.preprocessing import screen
from ident.presets.model import Kind
from ident.progress import Report, silent
from ident.readers.rig import read_rig, rig_of
from ident.rig.limits import RigLimits
from ident.synthesis.matrix import Simulation, simulated
from ident.time_budget import TimeBudget
from ident.words.arguments import stated_kinds

if TYPE_CHECKING:
    from ident.figures import AltairChart, Study

Fitter = Callable[[Matrix, Settings, Report], StepwiseFit]
Diagnoser = Callable[[Matrix, FitResult, Sequence[Effect], SearchBudget], Diagnosis]


@dataclass(frozen=True)
class Served:
    """Who serves a kind of model: its fitter, those of methods of their own, its simulator and its diagnoser.

    `continued` is the fitter that begins where an earlier result ended, instead of with a search. It `proposes` terms
    that no list holds where its models have signals inside.
    """

    fitter: Fitter
    simulator: Simulator
    diagnoser: Diagnoser
    by_method: Mapping[str, Fitter]
    continued: Fitter
    proposes: bool = False


SERVED: Mapping[Kind, Served] = {
    "chain": Served(
        Identification,
        comparison.modelled,
        diagnosis.diagnose,
        {"inverse-dynamics": RegressedIdentification, "ekf": KalmanIdentification},
        ContinuedIdentification,
        proposes=True,
    ),
    "bench": Served(BenchIdentification, bench_outputs, diagnose_bench, {}, ContinuedBench),
}


def _served(model: str) -> Served:
    return SERVED[preset_with(model).kind]


def identification(matrix: Matrix, settings: Settings, report: Report = silent) -> StepwiseFit:
    """The steps of a fit: of test runs, of the records of a bench, or by regression.

    Without a model that which fits is taken, of those that the channels allow. Raises Unusable for settings that no
    matrix could be fitted with, and where the matrix does not allow the fit.
    """
    check_settings(settings)
    matrix = screen(matrix, settings.preprocessing)
    if not settings.model:
        choice = choose_structure(matrix, report, settings.preprocessing)
        named = replace(settings, model=choice.structures[0].machine)
        made = choice.made(named)
        return FitWithAlternatives(
            CompletedFit(made) if made else identification(choice.matrix, named, report), choice.structures
        )
    served = _served(settings.model)
    if settings.start is not None:
        return served.continued(matrix, settings, report)
    return served.by_method.get(settings.method, served.fitter)(matrix, settings, report)


@one_thread()
@stated_kinds
def identify(
    matrix: Matrix,
    settings: Settings | None = None,
    report: Report = silent,
    start: FitResult | Diagnosis | None = None,
    **choices: Unpack[Choices],
) -> FitResult:
    """The whole fit in one call; `choices` stand over the settings, as effects=["dead_zone"], fixed={"tau": "1 ms"}.

    Where nothing is chosen it is the fit of the model that the channels allow and the data prefer.

    With a `start` it is the fit that begins where that ended, and nothing else is chosen; of a diagnosis the one that
    it recommends, see :func:`ident.diagnosis.recommended.settings_after` for others. Raises Unusable as
    :func:`identification`.
    """
    if start is not None:
        if settings is not None or choices:
            raise Unusable(
                "bad-option",
                "settings cannot be given with a start",
                "start",
                "give one of the two: model, effects and bounds are those of the start",
            )
        return replace(completed(identification(matrix, settings_after(start), report)), matrix=matrix)
    chosen = settings_of(choices, settings) if choices else settings or Settings(model="")
    return replace(completed(identification(matrix, chosen, report)), matrix=matrix)


@one_thread()
@stated_kinds
def compare(matrix: Matrix, fit: FitResult) -> Comparison:
    """Every run of the matrix against the fitted model. Raises Unusable where the fit is of another model's data."""
    return comparison.compare(matrix, fit, _served(fit.model).simulator)


def _screened(matrix: Matrix, fit: FitResult) -> Matrix:
    """The matrix with the uses of runs that a fit gave them, for what takes some of the runs."""
    return screen(matrix, fit.settings.get("preprocessing", {}))


def study(matrix: Matrix, fit: FitResult) -> Study:
    """A fit beside its data, for figures one after the other."""
    from ident.figures import Study  # noqa: PLC0415 - altair, which a fit does not need

    return Study(_screened(matrix, fit), fit, _served(fit.model).simulator)


@stated_kinds
def figure(
    result: FitResult | Comparison | Diagnosis | Matrix,
    name: str,
    matrix: Matrix | None = None,
    theme: str = "light",
    share: float = 1.0,
    **options: Any,
) -> AltairChart:
    """The Altair chart of that name: see :func:`ident.figures.figure` for its options, and :func:`study` for several.

    A result that was made here knows its data; beside one that was read from a file the `matrix` is given. Of a
    diagnosis it is the ladder, of a matrix its `signals` and `spectra` as measured. Raises Unusable for a name that the
    result has no figure of, and where data are missing.
    """
    from ident import figures  # noqa: PLC0415

    if isinstance(result, Matrix):
        recorded = figures.Recorded(result.runs, result.actuator)
        return figures.shown(figures.figure(name, recorded, theme, share, **options))
    matrix = matrix or result.matrix
    if matrix is None:
        raise Unusable(
            "no-data",
            "the result does not hold the data that it was made of",
            f"figure {name}",
            "give matrix=read_matrix(…)",
        )
    if isinstance(result, Diagnosis):
        return figures.shown(figures.of_diagnosis(result, name, matrix.actuator, theme, share, **options))
    fit = result.fit if isinstance(result, Comparison) else result
    return figures.shown(figures.figure(name, study(matrix, fit), theme, share, **options))


@one_thread()
@stated_kinds
def diagnose(
    matrix: Matrix,
    fit: FitResult | None = None,
    settings: Settings | None = None,
    most: int = CRITERIA.selection.usual,
    custom: Sequence[Effect | Mapping[str, Any] | str] = (),
    report: Report = silent,
    seconds: float | None = None,
    found: Callable[[Diagnosis], None] | None = None,
    propose: bool | None = None,
    budget: TimeBudget | None = None,
    bounds: Bounds | None = None,
) -> Diagnosis:
    """Rank what the fitted model lacks, add what helps beyond chance, and say whether the residual is explained.

    Without a `fit` the model of `settings` is fitted first. `most` is the largest number of effects to add, `custom`
    are effects beside the catalogue's, or their definitions. Verify runs only report. After `seconds`, that of a fit
    included, no simulation is begun any more, and what was found is told with what was not looked at; a time `budget`
    in their place has begun before. `found` is told of the diagnosis as it stands after each effect, and of the
    catalogue's verdict before terms are searched for. Terms that no list holds are searched for where the catalogue
    leaves the error unexplained; with `propose` true also where nobody knows the noise, with false never. `bounds` are
    of parameters of effects that may be added, as ``{"presliding_friction.displacement": ("1 um", "1 mm")}``; those
    in the settings hold as well. Raises Unusable where matrix, fit or settings do not go together.
    """
    if not 0 <= most <= CRITERIA.selection.most:
        raise Unusable("bad-option", f"{most} effects", "max-effects", f"give 0 to {CRITERIA.selection.most}")
    if seconds is not None and not seconds > 0:
        raise Unusable("bad-option", f"{seconds:g} s", "time", "give the seconds that it may take")
    budget = budget or TimeBudget(seconds)
    course = SearchBudget(most, budget, report, found, propose=propose)
    try:
        with budget.running():
            fit = fit or identify(matrix, settings, report)
    except TimeIsUp:
        return replace(unfitted(matrix, settings or Settings(), budget.taken), matrix=matrix)
    served = _served(fit.model)
    if propose and not served.proposes:
        raise Unusable(
            "bad-option",
            f"the model {fit.model} has no signals inside that a term could be of",
            "propose",
            "leave it out",
        )
    own = tuple(one if isinstance(one, Effect) else read_effect(one, model=fit.model) for one in custom)
    fit = with_candidates_given(fit, bounds or {}, own=own)
    return replace(served.diagnoser(_screened(matrix, fit), fit, own, course), matrix=matrix)


@stated_kinds
def propose(
    matrix: Matrix,
    fit: FitResult | None = None,
    settings: Settings | None = None,
    report: Report = silent,
    seconds: float | None = None,
) -> Diagnosis:
    """The terms that no list holds, found beside the fitted model as it is, in `proposals` of what is returned.

    The effect that each of them is, `proposals[0].effect`, goes into ``identify(matrix, custom=[…])``. Raises Unusable
    as :func:`diagnose`.
    """
    return diagnose(matrix, fit, settings, most=0, report=report, seconds=seconds, propose=True)


@one_thread()
@stated_kinds
def next_run(found: Diagnosis, matrix: Matrix | None = None, seed: int = 0) -> Experiment:
    """The run that best tells apart what a diagnosis leaves in question; ``.command()`` is its signal.

    Raises Unusable where none can be proposed, or the data of a diagnosis that was read from a file are not given.
    """
    matrix = matrix or found.matrix
    if matrix is None:
        raise Unusable(
            "no-data",
            "the diagnosis does not hold the data that it was made of",
            "next run",
            "give matrix=read_matrix(…)",
        )
    return design.propose(competing_models(found), matrix, seed)


@stated_kinds
def plan(
    program: str | Path | Mapping[str, Any],
    fit: FitResult | None = None,
    rig: RigLimits | Mapping[str, Any] | Path | str | None = None,
    seconds: float | None = None,
    ramp: float | None = None,
    seed: int = 0,
    spread: float = USUAL,
    spreads: Mapping[str, float] | None = None,
    least: float = LEAST,
    report: Report = silent,
) -> Plan:
    """Command files for a rig, kept inside its limits; ``.write(folder)`` writes them with a matrix.yaml.

    `program` is ``"qian"``, ``"kononykhin"``, the path of a YAML file or its content. `rig` are the limits, as
    ``{"stroke": "150 mm", "speed": "0.5 m/s"}`` or a file that holds them; without them those of the fit's matrix.
    Every parameter of the fit may be off by the share `spread`, those in `spreads` by their own. See
    :func:`ident.planning.plan.plan` for the rest and for what is refused.
    """
    limits = read_rig(rig) if isinstance(rig, str | Path) else rig_of(rig) if isinstance(rig, Mapping) else rig
    return planning.plan(program, fit, limits, seconds, ramp, seed, Spread(spread, spreads or {}), least, report)


@stated_kinds
def simulate(
    preset: str = "qian2014",
    seconds: float = 30.0,
    seed: int = 0,
    noise: float = 0.005,
    effects: Mapping[str, float] | None = None,
    small: bool = False,
    report: Report = silent,
) -> Matrix:
    """A simulated test matrix: a paper's model with `effects`, SI, as {"dead_zone": 4e-4}, hidden in it.

    It holds 63 runs to fit and 21 to verify, each of `seconds`; a `small` one 18 and 9. `noise` is white, its standard
    deviation relative to each run's output. Raises Unusable for a model that has no test matrix of its own.
    """
    return simulated(Simulation(preset, seconds, seed, noise, effects or {}, small), report)


@stated_kinds
def save(result: FitResult | Diagnosis, path: Path | str) -> None:
    """Write a fit or a diagnosis as JSON: the file that `servoident fit --json` or `diagnose --json` writes."""
    text = json.dumps(result.to_json(), indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    Path(path).write_text(text, encoding="utf-8")


@stated_kinds
def load(path: Path | str, matrix: Matrix | None = None) -> FitResult | Diagnosis:
    """The fit or the diagnosis in a JSON file, of any version; with its `matrix`, figures can be drawn of it.

    Raises Unusable where it is neither.
    """
    try:
        data = json.loads(Path(path).read_bytes())
    except (ValueError, RecursionError):
        data = None
    kind = Diagnosis if isinstance(data, dict) and "candidates" in data else FitResult
    return replace(kind.from_json(data), matrix=matrix)
