"""From an optimum to a result in the contract's words."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import integrates
from ident.checks.missing_input import missing_inputs
from ident.checks.unit_factor import unit_causes
from ident.fit.contradicted import contradicting
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.far_bounds import far_bounds
from ident.fit.fitness import Fitness
from ident.fit.information import aic
from ident.fit.local_optima import disagreements
from ident.fit.low_frequency_delay import slow_lag
from ident.fit.multistart import Optimum
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.reduction import excited_band
from ident.fit.result import Combination, Estimate, FitResult, RunError, Starts, TransducerOffset, Undetermined, Window
from ident.fit.run_errors import fit_percent, rmse_of, run_error
from ident.fit.search import evolution
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import Space
from ident.fit.transducer import Offset, offset_at, offsets_that_count, rest_of
from ident.fit.uncertainty import Covariance, covariance
from ident.matrix import Matrix
from ident.noise.floor import Floors
from ident.parallel import each
from ident.presets.preset import Combined
from ident.presets.record_units import SAMPLE
from ident.presets.suitable_models import is_assumed_loop
from ident.run import Run, over_runs
from ident.simulation.steps import FASTEST, MOST
from ident.unstable import UNSTABLE
from ident.words.engineering import quantity
from ident.words.error import error_said
from ident.words.message import message
from ident.words.messages import MESSAGES
from ident.words.percent import PER_CENT
from ident.words.plus_minus import determined
from ident.words.run_name import run_name

_OF = FIT_CRITERIA.determination
_AT_BOUND = "the estimate is at its bound: the best value is outside it"
_VAGUE = "its standard error is {:.3g} times its value"
HARDLY = _OF.hardly
_SAID_FIRST = tuple(MESSAGES[key].partition("{")[0] for key in ("hardly", "missing_input.fit", "contradicted"))
Array = NDArray[np.float64]


def summarise(
    settings: Settings, optimum: Optimum, state: Mapping[str, Any], floors: Floors, seconds: float
) -> FitResult:
    """The result of a fit that ended at an optimum; `floors` are the noise floors of the runs."""
    over_windows, point, here = optimum.fitness, optimum.point, optimum.here
    objective = over_windows.whole() if isinstance(over_windows, SimulatedFitness) else over_windows
    space, matrix, preset = objective.space, objective.matrix, objective.preset
    values = {name: float(found[0]) for name, found in space.values(point[None]).items()}
    verify_runs = matrix.of_use("verify")
    verify = objective.shown_on(verify_runs, point).runs if verify_runs else ()
    fit_runs = matrix.of_use("fit")
    found = covariance(here, point, optimum.as_good)
    window = _window(over_windows, point, found, optimum.left_out)
    own = (
        here.runs
        if preset.is_linear and not window and not optimum.left_out
        else objective.fresh(fit_runs).exact(point, sensitivities=False).runs
    )
    offsets = {} if window else offsets_that_count(here)
    fit_errors, verify_errors = _run_errors(fit_runs, own, offsets), _run_errors(verify_runs, verify, offsets)
    meant = [i for i, run in enumerate(fit_runs) if run.id not in optimum.left_out]
    mean_runs, mean_errors = [fit_runs[i] for i in meant], [fit_errors[i] for i in meant]
    with_mean = {
        "fit": _mean(mean_runs, mean_errors, "error_with_mean"),
        "verify": _mean(verify_runs, verify_errors, "error_with_mean"),
    }
    strengths = {p.in_equations for p in preset.parameters if p.of}
    strengths |= {axis.name for axis in space.axes if axis.lower == 0}  # what may be nothing has no relative error
    strengths |= {*preset.crossing} & {*space.names}
    relative = {name: found.relative(_value(objective, name)) for name in space.names if name not in strengths}
    deviation = {name: abs(values[name]) * error for name, error in relative.items()}
    deviation |= {name: found.deviation(_value(objective, name)) for name in space.names if name in strengths}
    ranges = {name: upper - lower for name, (lower, upper) in space.bounds(values).items()}
    weak = [name for name in relative if relative[name] > _OF.determined]
    weak += [name for name in deviation if name in strengths and deviation[name] > _OF.determined * ranges[name]]
    vague = {
        name: deviation[name] / abs(values[name])
        for name in deviation
        if name not in (*weak, *preset.crossing) and not determined(values[name], deviation[name])
    }
    weak += vague
    if space.convention:
        weak = [
            *weak,
            *(name for name in preset.data.share_force if name in relative and name not in weak),
            space.convention,
        ]
    for one in space.conventions:
        weak += [name for name in (*(n for n in one.shared if n in space.names), *one.held) if name not in weak]
    bounded = [name for name in space.names if values[name] != 0 and name not in weak and space.at_bound(name, point)]
    weak += bounded
    label = _labels(objective)
    known = {name: error for name, error in deviation.items() if name not in weak}
    against = () if window else tuple(contradicting(verify_runs, verify_errors))
    told = disagreements(optimum.ends, known, {name: label[name][0] for name in known})
    return FitResult(
        model=preset.name,
        effects=settings.effects,
        parameters={
            label[name][0]: _estimate(objective, name, values, deviation, point, name in weak) for name in space.order
        },
        correlation=found.correlation({label[name][0]: _value(objective, name) for name in space.names}),
        determined=tuple(_determined(objective, found, relative, values, bounded)) if weak else (),
        undetermined=tuple(
            Undetermined(label[name][0], _AT_BOUND if name in bounded else _reason(over_windows, name, relative, point))
            if name not in vague
            else Undetermined(label[name][0], _VAGUE.format(vague[name]))
            for name in weak
        ),
        error={
            "fit": _mean(mean_runs, mean_errors, "error"),
            "held_out": None,
            "verify": _mean(verify_runs, verify_errors, "error"),
        },
        offset={
            "fit": _mean(mean_runs, mean_errors, "offset"),
            "verify": _mean(verify_runs, verify_errors, "offset"),
        },
        anchored_error=with_mean,
        error_with_mean=with_mean,
        **rmse_of(
            (*mean_errors, *verify_errors),
            {"fit": [run.share for run in mean_runs], "verify": [run.share for run in verify_runs]},
        ),
        transducer_offset=told_offsets(offsets, matrix),
        fit_percent=fit_percent((*mean_errors, *verify_errors), with_mean),
        aic=None
        if window
        else aic([one.error for one in mean_errors], [own[i].length for i in meant], len(space.names)),
        window=window,
        starts=_labelled(optimum.starts, label),
        noise_floor=floors.of_use(matrix),
        left_out=optimum.left_out,
        runs=(*fit_errors, *verify_errors),
        method=settings.method,
        seed=settings.seed,
        evaluations=objective.evaluations,
        seconds=seconds,
        version=version("servoident"),
        data_hash=matrix.data_hash,
        notes=(
            *_notes(settings, objective, floors, fit_errors, against),
            *_known_zeros(settings, objective.runs, offsets),
            *_read_offsets({name: one for name, one in offsets.items() if name not in settings.known_zeros}, matrix),
            *_beyond(optimum, values, label),
            *told,
            *_alone(optimum.starts),
            *_fast_modes(objective, point, state, optimum.searched or space),
            *_bad_runs(fit_errors, optimum.left_out),
        ),
        settings=settings.to_json(),
        searched=tuple(label[name][0] for name in space.names),
        evolution=evolution(optimum.searched or space, state),
        actuator=matrix.actuator,
        conditions=matrix.conditions,
        preprocessing=matrix.preprocessing,
    )


def _run_errors(
    runs: Sequence[Run], found: Sequence[NormalMatrices], offsets: Mapping[str, Offset]
) -> tuple[RunError, ...]:
    return tuple(
        run_error(
            run,
            m.error,
            m.offset,
            float(np.sqrt(run.power / run.length)),
            run.units.get(run.output, "1"),
            offset_at(run, offsets),
        )
        for run, m in zip(runs, found, strict=True)
    )


def _mean(runs: Sequence[Run], found: Sequence[RunError], what: str) -> float | None:
    return float(over_runs([getattr(of_run, what) for of_run in found], runs)) if runs else None


def _window(fitness: Fitness, point: Array, known: Covariance, left_out: tuple[str, ...]) -> Window | None:
    """The windows of a fit that was made over them, the errors there, and between what those of the free run lie."""
    if not isinstance(fitness, SimulatedFitness) or fitness.horizon is None:
        return None
    error: dict[str, float | None] = {"fit": None, "held_out": None, "verify": None}
    free_run: dict[str, tuple[float, ...]] = {}
    scatter = known.drawn(_OF.drawn)
    for use in ("fit", "verify"):
        if runs := tuple(run for run in fitness.matrix.of_use(use) if run.id not in left_out):
            found = fitness.fresh(runs).exact(point, sensitivities=False).runs
            error[use] = float(over_runs([min(run.error, UNSTABLE) for run in found], runs))
            free = over_runs(
                [run.errors_beside(scatter) for run in fitness.whole().fresh(runs).exact(point).runs], runs
            )
            if np.all(np.isfinite(free)):  # a free run that goes astray has no interval
                free_run[use] = tuple(float(end) for end in np.quantile(free, _OF.interval))
    clock = fitness.preset.display.recorded.clock
    return Window(fitness.horizon, error, free_run, fitness.memory, clock if clock == SAMPLE else "")


def _labels(objective: Fitness) -> dict[str, tuple[str, str]]:
    """Name and unit under which a parameter is reported: a ratio to the area where the area is unknown."""
    plain = {p.in_equations: (p.name, objective.preset.unit(p)) for p in objective.preset.parameters}
    known = objective.matrix.actuator.piston_area is not None
    shown = objective.preset.display.recorded.shown
    ratios = {name: (label, shown(unit)) for name, (label, unit) in (objective.preset.without_area or {}).items()}
    return plain if known else plain | ratios


def _labelled(starts: Starts | None, label: Mapping[str, tuple[str, str]]) -> Starts | None:
    """The starts with their values under the names of the report."""
    return starts and replace(starts, values={label[name][0]: found for name, found in starts.values.items()})


def _value(objective: Fitness, name: str) -> Callable[[Array], Array]:
    return lambda points: objective.space.values(points)[name]


def _estimate(
    objective: Fitness,
    name: str,
    values: Mapping[str, float],
    deviation: Mapping[str, float],
    point: Array,
    weak: bool,
) -> Estimate:
    parameter, value = objective.preset.parameter(name), values[name]
    unit = _labels(objective)[name][1]
    if name not in deviation:
        return Estimate(value, unit, None, value, value, False, parameter.symbol, parameter.meaning, fixed=True)
    lower, upper = objective.space.bounds(values)[name]
    error = None if weak else deviation[name]
    at_bound = objective.space.at_bound(name, point)
    return Estimate(value, unit, error, lower, upper, at_bound, parameter.symbol, parameter.meaning)


def _determined(
    objective: Fitness,
    found: Covariance,
    relative: Mapping[str, float],
    values: Mapping[str, float],
    bounded: Sequence[str],
) -> Iterator[Combination]:
    """Where a parameter is not determined: the parameters and combinations that are; none that ended at its bound."""
    label, space = _labels(objective), objective.space
    for name, error in relative.items():
        shared = {n for one in space.conventions for n in one.shared}
        if (
            error <= _OF.determined
            and name not in (*shared, *bounded)
            and not (space.convention and name in objective.preset.data.share_force)
        ):
            yield Combination(label[name][0], values[name], label[name][1], abs(values[name]) * error)
    named = [(combined.text.replace("**", "^"), combined) for combined in objective.preset.combinations]
    for text, combined in (*named, *_forces_as_commands(objective, label)):
        names = combined.equation.names - values.keys()
        known = {name: np.array(space.typical[name]) for name in names}

        def quantity(points: Array, combined: Combined = combined, known: Mapping[str, Array] = known) -> Array:
            return np.asarray(combined.equation.value({**known, **space.values(points)}))

        error = found.relative(quantity)
        open_ = any(one.held.keys() & combined.equation.names for one in space.conventions)
        if error <= (_OF.determined if open_ else _OF.combined):  # all that is known of what a convention holds
            value = float(quantity(found.point[None])[0])
            unit = objective.preset.combined_unit(combined)
            yield Combination(text, value, unit, abs(value) * error)
    yield from slow_lag(objective, found)


def _forces_as_commands(objective: Fitness, label: Mapping[str, tuple[str, str]]) -> Iterator[tuple[str, Combined]]:
    """The forces of effects over the force for each unit of the command, where the forces have no scale: dry friction
    of a motor of unknown inertia is known as the voltage that overcomes it."""
    preset, space = objective.preset, objective.space
    if not space.convention:
        return
    drives = [name for name in preset.display.of_drive if name in preset.data.share_force and name in space.names]
    if len(drives) == 1:
        for parameter in preset.parameters:
            name = parameter.in_equations
            if parameter.of and parameter.is_force and name in space.names:
                text = f"{name} / {drives[0]}"
                yield text.replace(name, label[name][0]), Combined(text, "m", "command that overcomes it")


def _reason(objective: Fitness, name: str, relative: Mapping[str, float], point: Array) -> str:
    if name == objective.space.convention:
        return "fixed by convention: no specimen of known mass, stiffness or damping gives the forces a scale"
    if objective.space.convention and name in objective.preset.data.share_force:
        return "only the ratio to the moving mass is identifiable: the mass is fixed by convention"
    for one in objective.space.conventions:
        if name in one.held:
            return one.why
        if name in one.shared:
            return f"identifiable only together with {' and '.join(one.held)}, which is fixed by convention"
    if name not in relative:
        if objective.space.at_bound(name, point) and _felt(objective, name, point):
            return _AT_BOUND
        return "every value within its bounds explains these runs equally well"
    size = (
        "no influence on these runs"
        if relative[name] > _OF.no_influence
        else f"standard error {PER_CENT * relative[name]:.0f} % of the value"
    )
    return f"{size}; correlated with other parameters (see the identifiable combinations)"


def _felt(objective: Fitness, name: str, point: Array) -> bool:
    """Whether the error is larger where a strength is off."""
    space = objective.space
    off = space.point({n: 0.0 if n == name else float(value[0]) for n, value in space.values(point[None]).items()})
    here, without = objective.errors(np.stack([point, off]))
    return bool(without > _OF.felt * here)


def _notes(
    settings: Settings, objective: Fitness, floors: Floors, found: Sequence[RunError], against: Sequence[str]
) -> list[str]:
    """What is said of a fit, first of all why it is not to be trusted; `against` is what validation data say."""
    error = float(over_runs([run.error for run in found], objective.matrix.of_use("fit")))
    hardly = tuple(_hardly_explained(settings, objective, error))  # of the data that were fitted, and so of all others
    notes = [*_unrecorded(objective.runs), *(hardly or against), *objective.matrix.notices]
    if objective.space.scale_free and objective.space.axes:
        notes.append(
            f"Bounds of the preset {objective.preset.name} were not used: they hold for another machine, or piston "
            "area, gain or specimen are not given. The search was over scale-free ratios."
        )
    if objective.matrix.actuator.piston_area is None and objective.preset.without_area:
        notes.append("Piston area unknown: only the ratios to it are identifiable, and parameters are given as ratios.")
    if floors.measured:
        notes.append("Noise floor estimated from repeated runs, or from a command that repeats itself.")
    elif floors.of_use(objective.matrix)["fit"] is None:
        notes.append(
            "Noise floor unknown: the command has power up to nearly half the sample rate, so no part of the "
            "spectrum shows the noise alone. Repeat one run with a stated specimen or gain to measure it."
        )
    else:
        notes.append("Noise floor: a lower bound, from the spectrum above the command bandwidth (white noise assumed).")
    if objective.unstable:
        notes.append(
            f"{objective.unstable} candidate parameter sets were unstable and were rejected. This costs only computing "
            "time."
        )
    if not error < UNSTABLE:
        notes.append("The model is unstable at these values: its error is reported as 1000.")
    return notes


def noticed(fit: FitResult, notice: str) -> FitResult:
    """A fit with one more notice of its matrix, the first of them."""
    at = sum(note.startswith(_SAID_FIRST) for note in fit.notes)
    return replace(fit, notes=(*fit.notes[:at], notice, *fit.notes[at:]))


def told_offsets(offsets: Mapping[str, Offset], matrix: Matrix) -> dict[str, TransducerOffset]:
    """The offsets of transducers as a result keeps them."""
    return {
        name: TransducerOffset(one.value, _unit_of(name, matrix), one.std_error, one.large)
        for name, one in offsets.items()
    }


def _unit_of(channel: str, matrix: Matrix) -> str:
    """The SI unit of a channel, "1" where it has none."""
    return next((run.units[channel] for run in matrix.runs if channel in run.units), "1")


def _read_offsets(offsets: Mapping[str, Offset], matrix: Matrix) -> Iterator[str]:
    """What each transducer reads above the model, or below it."""
    for name, one in offsets.items():
        size, error = (quantity(value, _unit_of(name, matrix)) for value in (abs(one.value), one.std_error))
        side = "above" if one.value >= 0 else "below"
        if name == "temperature":
            yield str(message("transducer_offset.temperature", offset=size, error=error, side=side))
        else:
            yield str(message("transducer_offset", channel=name, offset=size, error=error, side=side))


def _known_zeros(settings: Settings, runs: Sequence[Run], offsets: Mapping[str, Offset]) -> Iterator[str]:
    """Which means count because rest tells the zero of a transducer, and whether the model explains them."""
    for name in settings.known_zeros:
        own = [run for run in runs if run.output == name]
        if (rest := rest_of(run.zero_at_rest for run in own)) is None:
            continue
        value, error = (quantity(one, own[0].units.get(name, "1")) for one in rest)
        yield str(message("known_zero", channel=name, value=value, error=error))
        if name in offsets and offsets[name].large:
            yield str(message("known_zero.left", channel=name))


def _unrecorded(runs: Sequence[Run]) -> Iterator[str]:
    """What is said first where an input acts on the runs that is not recorded."""
    for stretches in each(missing_inputs, runs):
        for stretch in stretches[:1]:
            yield str(message("missing_input.fit", evidence=stretch.evidence))


def _hardly_explained(settings: Settings, objective: Fitness, error: float) -> Iterator[str]:
    """What is said first of a fit that is hardly better than no model, with the likely causes."""
    if error < HARDLY:
        return
    preset, runs = objective.preset, objective.runs
    far = list(far_bounds(settings, preset, objective.matrix, excited_band(runs)))
    if error >= UNSTABLE:
        yield from [str(message("unstable", causes=far))] if far else []
        return
    integrated = integrates(preset.chain, runs, objective.matrix.actuator)
    causes = [
        *far,
        *([message("cause.offset")] if integrated else []),
        *([message("cause.no_loop", channel=runs[0].output)] if is_assumed_loop(preset, runs) else []),
        message("cause.sign"),
        message("cause.model", model=preset.name),
        *unit_causes(objective.matrix.runs),
    ]
    yield str(message("hardly", error=error, causes=causes))


def _beyond(optimum: Optimum, values: Mapping[str, float], label: Mapping[str, tuple[str, str]]) -> Iterator[str]:
    """What was searched on beyond a bound that nobody set, and what that brought."""
    first = {one.name: one for one in reversed(optimum.beyond)}
    for name, one in first.items():
        called, unit = label[name]
        yield (
            f"{called} ended at {quantity(one.bound, unit)}, a bound that no user set, with an error of "
            f"{error_said(one.error)}: it was searched beyond it, and is {quantity(values[name], unit)} with "
            f"{error_said(optimum.here.error)}."
        )


def _fast_modes(objective: Fitness, point: Array, state: Mapping[str, Any], searched: Space) -> Iterator[str]:
    """What is followed only roughly: vectors of the search, over the space `searched`, and the model that was found."""
    if not isinstance(objective, SimulatedFitness):
        return
    roughly = f"above {FASTEST:.3g} radians per sample the integrator, with {MOST} steps per sample, is inaccurate."
    tried = (searched.values(np.array(entry["population"])) for entry in state["history"])
    count = sum(int(np.sum(np.abs(objective.fastest(values)) > FASTEST)) for values in tried)
    if count:
        yield f"{count} candidate models had dynamics that are too fast for the integrator: {roughly}"
    here = float(np.abs(objective.fastest(objective.space.values(point[None]))[0]))
    if here > FASTEST:
        yield f"The fastest mode of the model has {here:.3g} radians per sample: {roughly}"


def _alone(starts: Starts | None) -> Iterator[str]:
    """What is said of an optimum that hardly a start came to."""
    if starts and starts.agree < min(FIT_CRITERIA.optima.settled, starts.tried):
        yield (
            f"Only {starts.agree} of {starts.tried} optimiser starts reached this error, so a better optimum may "
            "exist. Try another seed."
        )


def _bad_runs(errors: Sequence[RunError], left_out: tuple[str, ...]) -> Iterator[str]:
    typical = float(np.median([run.error for run in errors]))
    for run in errors:
        if run.id in left_out:
            yield (
                f"{run_name(run.id, begins=True)} was left out of the fit: its error is {error_said(run.error)}, that "
                f"of the others typically {error_said(typical)}. Look at its labels and its record."
            )
