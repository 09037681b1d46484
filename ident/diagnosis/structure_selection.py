"""The choice of a machine where no model is named: the models that the channels allow, compared on held-out data.

Where the residual of the simplest good model exceeds the noise, an effect is missing, and a machine with more
parameters may have made up for a part of it. So the models are compared with one effect of the catalogue each, and the
most probable one is taken: by its likelihood on held-out data, less what each parameter costs. A lag, which has no
parts, is less probable beforehand than a machine. A machine that moves otherwise as a rule counts as the usual one. A
model with more parameters is among them only where it has as small an error without an effect, and with one gains
half of all that can be gained in addition to the first with its effect: a missing effect may hide the machine. A first
model with a parameter at its bound is the wrong machine: a model with a smaller error that is about as probable comes
before it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ident.chain.chain import integrates
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence.comparison import common_disturbance, gain
from ident.diagnosis.evidence.probability import structure_probabilities
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import evidence, finite_everywhere
from ident.diagnosis.operating_point import at_operating_point
from ident.diagnosis.ranking import rank
from ident.effects import CATALOGUE
from ident.effects.effect import undoable, undone
from ident.errors import Unusable
from ident.fit.identification import Identification, completed
from ident.fit.result import FitResult, Structure, Window
from ident.fit.settings import Settings
from ident.fit.summary import HARDLY, noticed
from ident.fit.windows import likelihood
from ident.matrix import Matrix
from ident.preprocessing import off_steps, screen
from ident.preprocessing.pipeline import ALL_ON
from ident.presets import Preset, preset
from ident.presets.suitable_models import (
    has_no_parts,
    in_question,
    is_assumed_loop,
    moved_by_command,
    on_a_spring,
    told_by_following,
    unusual,
    without_loop,
)
from ident.progress import Progress, Report, silent
from ident.words.message import Message, message
from ident.words.titles import title


@dataclass(frozen=True)
class StructureChoice:
    """The models in question, the chosen one first; the matrix, with a notice that gives the reason for the choice.

    `fit` is the fit of the first model with usual settings, None where it was the only model and needed no fit.
    """

    matrix: Matrix
    structures: tuple[Structure, ...] = ()
    fit: FitResult | None = None

    def made(self, settings: Settings) -> FitResult | None:
        """The fit, where these settings are the settings of that fit."""
        fit = self.fit
        usual = fit and Settings(model=fit.model, preprocessing=fit.settings.get("preprocessing", {}))
        return fit if fit is not None and settings == usual else None


def compared_structures(
    matrix: Matrix, report: Report = silent, preprocessing: Mapping[str, bool] = ALL_ON
) -> tuple[Structure, ...]:
    """The models in question, the chosen one first: the simplest whose held-out error is not worse.

    Where its residual exceeds the noise, each has one effect, and the most probable one is first. A machine that moves
    otherwise as a rule, as a motor along a way, counts as the usual one.

    Raises Unusable where the channels allow none.
    """
    matrix = screen(matrix, preprocessing)
    return _compared(undone(matrix, undoable(matrix, CATALOGUE)), report, preprocessing)[0]


def _compared(
    matrix: Matrix, report: Report, preprocessing: Mapping[str, bool]
) -> tuple[tuple[Structure, ...], FitResult | None]:
    """The models in question as :func:`compared_structures` has them, and the fit of the first where it was made.

    A loop that nobody stated is the only one where its fit explains the records. Where it explains hardly anything,
    nothing compares command and output, and models without a loop are in question, too.
    """
    models = in_question(matrix.runs, matrix.machine, matrix.actuator.states_oil)
    fitted: dict[str, _FittedStructure] = {}
    if len(models) == 1:
        (only,) = models
        structure = Structure(only.name, {"held_out": None}, len(only.parameters), str(_why_alone(only, matrix)))
        if matrix.machine or not is_assumed_loop(only, matrix.runs):
            return (structure,), None
        fitted = _all_fitted(models, matrix, report, preprocessing)
        fit, open_loop = fitted[only.name].fit, without_loop(matrix.runs, matrix.actuator.states_oil)
        if (fit.error["fit"] or 0.0) < HARDLY or not open_loop:
            return (structure,), fit
        models = (only, *open_loop)
    fitted |= _all_fitted([model for model in models if model.name not in fitted], matrix, report, preprocessing)
    over, tried = _judged(list(fitted.values()))
    springs = on_a_spring(models, matrix.runs, matrix.actuator.states_oil)
    if springs and not fitted[min(tried, key=lambda judged: judged.error).machine].integrates:
        fitted |= _all_fitted(springs, matrix, report, preprocessing)
        over, tried = _judged(list(fitted.values()))
    least = min(one.error for one in tried)
    good = [one for one in tried if one.error <= CRITERIA.equality.practically_equal * least]
    strange = {model.name for model in models if unusual(model, matrix.runs)}
    first = min(good, key=lambda one: (one.machine in strange, one.parameters))
    with_effects = _with_an_effect_each(first, tried, report)
    lags = {model.name for model in models if has_no_parts(model)}
    compared = [with_effects.get(judged.machine, judged) for judged in tried]
    with_effects |= _more_effects(with_effects, _probabilities(compared, lags, strange), report)
    compared = [with_effects.get(judged.machine, judged) for judged in tried]
    probable = _probabilities(compared, lags, strange)
    best, why = _preferred(with_effects[first.machine], list(with_effects.values()), probable)
    compared.sort(key=lambda model: model.machine != best.machine)
    said = (
        model.structure(over, _rather(model, best, probable) if number else why, probable.get(model.machine))
        for number, model in enumerate(compared)
    )
    return tuple(said), fitted[best.machine].fit


def _why_alone(only: Preset, matrix: Matrix) -> Message:
    """Why no other model than this one is in question."""
    if matrix.machine:
        return message("structure.described")
    if moved_by_command(only, matrix.runs):
        return message("structure.moved", machine=only.name, unit=matrix.runs[0].units["command"])
    if only.data.turns:
        return message("structure.turning", machine=only.name)
    if told_by_following(only, matrix.runs):
        of_position = "displacement" in only.chain.outputs
        return message("structure.position_loop" if of_position else "structure.loop", machine=only.name)
    return message("structure.driven", machine=only.name, driver=only.data.driven_by)


def _rather(model: _JudgedStructure, first: _JudgedStructure, probable: Mapping[str, float]) -> Message | None:
    """The remark on a model that is more probable than the first one, which comes first for another reason."""
    more = probable.get(model.machine, 0.0) > probable.get(first.machine, 1.0)
    return message("structure.rather", machine=model.machine) if more else None


def _probabilities(
    compared: Sequence[_JudgedStructure], lags: Collection[str], strange: Collection[str]
) -> dict[str, float]:
    """The probability of each compared model, by its machine; each model with its effect if it has one.

    `lags` have no parts, `strange` machines are unusual. An unusual machine that is not far more likely counts as the
    usual machine that integrates as it does, which moves so, too, where less of it shows.
    """
    sound = [model for model in compared if finite_everywhere(model.best)]
    if len(sound) < 2:
        return {}
    criteria = CRITERIA.structure
    sound.sort(key=lambda model: -model.error)  # the reference has the largest error
    residuals = [model.best.residuals_held_out for model in sound]
    disturbance = common_disturbance(residuals)
    gains = [gain(residuals[0], of, disturbance) for of in residuals]
    counts = [model.size for model in sound]
    priors = [criteria.no_parts if model.machine in lags else 1.0 for model in sound]
    machines = [model.machine for model in sound]
    probable = dict(zip(machines, structure_probabilities(gains, counts, priors), strict=True))
    for rare in (model for model in sound if model.machine in strange):
        usual = [model for model in sound if model.machine not in strange and model.integrates == rare.integrates]
        likeliest = max(usual, key=lambda model: probable[model.machine], default=None)
        part = (1.0 - criteria.unusual) * probable[rare.machine]
        if likeliest and criteria.unusual * probable[rare.machine] < probable[likeliest.machine]:
            probable[rare.machine] -= part
            probable[likeliest.machine] += part
    return probable


def _with_an_effect_each(
    first: _JudgedStructure, tried: Sequence[_JudgedStructure], report: Report
) -> dict[str, _JudgedStructure]:
    """The first model and the models with no more parameters, each with the effect that improves it most.

    A model with more parameters and as small an error is among them where, with its effect, it gains half of all that
    can be gained in addition to the first with its own. Only the first, without an effect, is returned where it is the
    only one. Where its residual is noise, the others are those that explain the records with an effect and have fewer
    parameters even so. Where no model explains the records with its effect, those that were about as good as the best
    without one are tried with the effects of which little was predicted, too.
    """
    as_good = CRITERIA.equality.practically_equal * min(judged.error for judged in tried)
    simple = [judged for judged in tried if judged.parameters <= first.parameters]
    larger = [judged for judged in tried if judged.parameters > first.parameters and judged.error <= as_good]
    if not first.above_noise:
        smaller = (judged.helped(report) for judged in simple if judged.parameters + 1 < first.parameters)
        sound = (judged for judged in (first, *smaller) if np.isfinite(judged.error))
        return {judged.machine: judged for judged in sound if not judged.above_noise}
    if len(simple) + len(larger) == 1:
        return {first.machine: first}
    helped = {judged.machine: judged.helped(report) for judged in simple}
    if all(judged.above_noise for judged in helped.values()):
        least = CRITERIA.structure.tried_further * min(judged.error for judged in simple)
        near = [helped[judged.machine] for judged in simple if judged.error <= least]
        helped |= {judged.machine: judged.helped_further(report) for judged in near}
    if helped[first.machine].above_noise:
        others = (judged.helped(report) for judged in larger)
        helped |= {judged.machine: judged for judged in others if _gains_half(helped[first.machine], judged)}
    return {machine: _explaining(judged, helped.values(), report) for machine, judged in helped.items()}


def _explaining(judged: _JudgedStructure, others: Collection[_JudgedStructure], report: Report) -> _JudgedStructure:
    """A model with a second effect, where it then explains the records, or more of them than each of the larger ones,
    and has fewer parameters than the largest of the others with their effects.

    A machine of many parameters makes up for one of two effects that a smaller one lacks, but not for both.
    """
    larger = [other for other in others if other.size > judged.size + 1]
    near = CRITERIA.structure.within_reach * min(other.error for other in others)
    if judged.with_effect is None or judged.size >= max(other.size for other in others) or judged.error > near:
        return judged
    if not judged.above_noise:
        return judged
    more = judged.helped(report)
    explains_more = bool(larger) and more.error < min(other.error for other in larger)
    return more if explains_more or not more.above_noise else judged


def _more_effects(
    models: Mapping[str, _JudgedStructure], probable: Mapping[str, float], report: Report
) -> dict[str, _JudgedStructure]:
    """The most probable model and the model of the smallest error with one more effect each, where they are two.

    Neither explains the records then, and each lacks another part: one the most, the other where little disturbs.
    """
    least = min(models.values(), key=lambda judged: judged.error)
    likeliest = max(models.values(), key=lambda judged: (probable.get(judged.machine, 0.0), judged is least))
    both = least, likeliest
    if least is likeliest or not all(judged.with_effect and judged.above_noise for judged in both):
        return {}
    return {judged.machine: judged.helped(report) for judged in both}


def _gains_half(first: _JudgedStructure, larger: _JudgedStructure) -> bool:
    """Whether a model with an effect gains half of all that can be gained in addition to the first model with its
    own."""
    if not (finite_everywhere(larger.best) and finite_everywhere(first.best)):
        return False
    found = evidence(first.best, larger.best)
    return found.gain > CRITERIA.evidence.reaches * found.most


def _preferred(
    first: _JudgedStructure, others: Collection[_JudgedStructure], probable: Mapping[str, float]
) -> tuple[_JudgedStructure, Message]:
    """The chosen one of models with an effect each, and the reason: the most probable one, of equals the first.

    Where a parameter of the first is at its bound, a model that is about as probable as any, with a smaller error and
    no parameter at a bound, comes before it.
    """
    within = [one for one in _as_probable(others, probable) if one.error < first.error and not one.at_bound]
    if first.at_bound and within:
        return _simplest(within), message("structure.within")
    best = max(others, key=lambda one: (probable.get(one.machine, 0.0), one.machine == first.machine))
    if not probable or best.machine == first.machine:
        return first, message("structure.simplest")
    return best, message("structure.more_probable")


def _as_probable(models: Collection[_JudgedStructure], probable: Mapping[str, float]) -> list[_JudgedStructure]:
    """Those of the models that are at least half as probable as the most probable one."""
    most = max(probable.get(model.machine, 0.0) for model in models)
    return [model for model in models if probable.get(model.machine, 0.0) >= 0.5 * most]


def _simplest(models: Collection[_JudgedStructure]) -> _JudgedStructure:
    """The model with the fewest parameters among the models with about the smallest error."""
    least = min(one.error for one in models)
    return min(
        (one for one in models if one.error <= CRITERIA.equality.practically_equal * least),
        key=lambda one: one.parameters,
    )


def _judged(fitted: Sequence[_FittedStructure]) -> tuple[float | None, list[_JudgedStructure]]:
    """All models judged by one error, and its horizon in s: over the windows by which one of them makes the records
    most likely.

    The state that a machine has integrated before a window has no information on its structure. But where no model
    that integrates is among the best over windows, or the least error over whole runs is smaller than the least error
    over windows, nothing was integrated: then whole runs count.
    """
    in_windows = [model for model in fitted if model.fit.window]
    likeliest = _likeliest_windows(in_windows)
    tried = [model.judged(likeliest) for model in fitted]
    if likeliest is None:
        return None, tried
    if len(in_windows) < len(fitted):
        whole = [one.judged(None) for one in fitted]
        least = min(one.error for one in tried)
        integrating = min(judged.error for model, judged in zip(fitted, tried, strict=True) if model.fit.window)
        if integrating > CRITERIA.equality.practically_equal * least or min(one.error for one in whole) < least:
            return None, whole
    return likeliest.horizon, tried


def _likeliest_windows(fitted: Sequence[_FittedStructure]) -> Window | None:
    """The windows of the model that makes the records most likely over its own, None where none is fitted over windows.

    The longest windows would judge a machine that integrates twice by a speed that no other model has.
    """
    windows = [model.fit.window for model in fitted if model.fit.window]
    if len({(window.horizon, window.memory) for window in windows}) < 2:
        return windows[0] if windows else None
    return max(zip(fitted, windows, strict=True), key=lambda own: own[0].judged(own[1]).log_likelihood)[1]


def _all_fitted(
    models: Sequence[Preset], matrix: Matrix, report: Report, preprocessing: Mapping[str, bool]
) -> dict[str, _FittedStructure]:
    """The models in question, fitted. A model that a command in closed loop does not allow is left out if others
    remain, and so is a model with a level that the records do not determine, if a model that integrates remains.

    Such a model integrates over these records, and its level, far away, is a constant input that the model that
    integrates does not have: with it an effect would look better than it is.
    """
    fitted, refused = {}, None
    for model in models:
        try:
            fitted[model.name] = _FittedStructure(model, matrix, report, preprocessing)
        except Unusable as error:
            if error.code != "closed-loop":
                raise
            refused = error
    if refused and not fitted:
        raise refused
    determined = {name: model for name, model in fitted.items() if not model.level_undetermined}
    return determined if any(model.fit.window for model in determined.values()) else fitted


def choose_structure(
    matrix: Matrix, report: Report = silent, preprocessing: Mapping[str, bool] = ALL_ON
) -> StructureChoice:
    """The models in question, and the matrix with a notice that gives the reason for the first.

    There is no notice where the first is the usual model and the only one in question. `preprocessing` has false for
    each step that is switched off.
    """
    matrix = screen(matrix, preprocessing)
    shown = undoable(matrix, CATALOGUE)
    found, fit = _compared(undone(matrix, shown), report, preprocessing)
    fit = None if shown else fit  # of records that the matrix does not hold
    first, *others = found
    usual = first.machine in (Settings().model, matrix.machine) and not others
    if usual and (matrix.machine or not told_by_following(preset(first.machine), matrix.runs)):
        return StructureChoice(matrix, found, fit)
    compared = [message("structure.of", machine=one.machine, why=one.why) for one in found]
    notice = str(message("structures", models=compared) if others else message("structures.one", why=first.why))
    if shown:
        notice = f"{notice} {message('structures.undone', effects=[title(effect.name) for effect in shown])}"
    return StructureChoice(replace(matrix, notices=(notice, *matrix.notices)), found, fit and noticed(fit, notice))


class _FittedStructure:
    """A model in question, fitted."""

    def __init__(self, model: Preset, matrix: Matrix, report: Report, preprocessing: Mapping[str, bool]) -> None:
        self.matrix, self.settings = matrix, Settings(model=model.name, preprocessing=off_steps(preprocessing))
        work = Identification(matrix, self.settings, report)
        self.fit, self.parameters = completed(work), len(work.objective.space.axes)
        self.integrates = integrates(model.chain, matrix.of_use("fit"), matrix.actuator)
        self.settings = replace(self.settings, known_zeros=tuple(self.fit.settings.get("known_zeros", ())))
        self._judged: dict[tuple[float | None, float | None], _JudgedStructure] = {}

    @property
    def level_undetermined(self) -> bool:
        """Whether the records do not determine where its output rests: to no better than the whole way of the output.

        Its slowest mode is then as slow as the records are long or slower, and it integrates over these.
        """
        ways = {run.output: float(np.ptp(run.measured)) for run in self.matrix.of_use("fit")}
        return any(offset.std_error > ways.get(name, np.inf) for name, offset in self.fit.transducer_offset.items())

    def judged(self, window: Window | None) -> _JudgedStructure:
        """The model judged by its error on held-out data, over the window where one is given."""
        over = (window.horizon, window.memory) if window else (None, None)
        if over not in self._judged:
            family = CandidateModels.of(self.matrix, self.settings, (), *over)
            start = {family.preset.parameter(name).in_equations: value for name, value in self.fit.values.items()}
            self._judged[over] = _JudgedStructure(family, self.parameters, self.fit.values, family.refit((), start))
        return self._judged[over]


@dataclass(frozen=True)
class _JudgedStructure:
    """A model in question judged by the error of all, and with the effect that improves it most."""

    models: CandidateModels
    parameters: int
    values: Mapping[str, float]
    refit: FittedModel
    with_effect: FittedModel | None = None
    untried: tuple[str, ...] = ()

    @property
    def machine(self) -> str:
        """The name of its machine."""
        return self.models.given.model

    @property
    def size(self) -> int:
        """The number of its parameters, of each effect one."""
        return self.parameters + len(self.best.effects)

    @property
    def error(self) -> float:
        """Its error on held-out data; infinite where a simulation diverges."""
        return _held_out(self.best)

    @property
    def integrates(self) -> bool:
        """Whether it integrates over the fitted runs."""
        return integrates(self.models.preset.chain, self.models.matrix.of_use("fit"), self.models.matrix.actuator)

    @property
    def log_likelihood(self) -> float:
        """How likely it makes the records over its windows, without an effect, in nats up to a constant."""
        found = likelihood(self.refit.fitness, self.refit.point, self.models.memory)
        return found if np.isfinite(found) else -np.inf

    @property
    def best(self) -> FittedModel:
        """The refit with the effect, where there is one, else without."""
        return self.with_effect or self.refit

    @property
    def above_noise(self) -> bool:
        """Whether a simulation confirms it and its residual is above the noise."""
        return self.best.finite and self.models.residual_above_noise(self.best)

    @property
    def at_bound(self) -> bool:
        """Whether the data ask for a value of one of its parameters beyond the bound."""
        return bool(self.best.at_bounds)

    def helped_further(self, report: Report) -> _JudgedStructure:
        """The same with the effects, too, that were not tried, where the records are short.

        Where a model went far astray for want of an effect, a prediction from there promises little of it.
        """
        return self.helped(report, further=True) if self.untried and self.models.is_short(self.refit) else self

    def helped(self, report: Report, further: bool = False) -> _JudgedStructure:
        """The model with one more effect of the catalogue, the one that improves it most; unchanged where none does.

        Tried are the effects that promise about as much as the best, and all of a lag, which has few; `further`, those
        that were left then.

        Effects are added to a machine that integrates about its operating point: see
        :mod:`ident.diagnosis.operating_point`. An effect that no simulation confirms is not taken: it would make a
        sound model look worse than any other.
        """
        if not self.refit.finite:
            return self

        def told(progress: Progress) -> None:
            report(replace(progress, stage="models with an effect", expected=()))

        more = self.with_effect is not None and not further
        base = self.best if more else at_operating_point(self.models, self.refit)
        names = self.untried if further else [name for name in self.models.effects if name not in base.effects]
        ranking = rank(self.models, base, names, told, thorough=further or has_no_parts(self.models.preset))
        refits = [one.refit for one in ranking if one.refit is not None and one.worth_adding and one.refit.finite]
        before = self.best if further else base
        best = min([before, *refits] if before.effects else refits, key=_held_out, default=None)
        return replace(self, with_effect=best, untried=tuple(one.effect for one in ranking if one.trial is None))

    def structure(self, over: float | None, more: Message | None, probability: float | None) -> Structure:
        """The facts of the model: its error over the horizon `over` in s, None for whole runs, and `more`, its
        reason."""
        alone = _held_out(self.refit)
        facts = [
            message("structure.error", error=alone)
            if over is None
            else message("structure.error_over", error=alone, seconds=over),
            message("structure.parameters", count=self.parameters),
        ]
        if self.with_effect is not None:
            facts.append(message("structure.effect", error=self.error, effects=self.with_effect.effects))
        if probability is not None:
            facts.append(message("structure.probability", probability=probability))
        why = message("structure.facts", facts=facts) if more is None else message("structure", facts=facts, why=more)
        held_out = alone if self.refit.finite else None
        return Structure(self.machine, {"held_out": held_out}, self.parameters, str(why), self.values, probability)


def _held_out(refit: FittedModel) -> float:
    return refit.held_out.error if refit.finite else float("inf")
