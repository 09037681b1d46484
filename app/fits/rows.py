"""A finished fit as its page and its report show it: rows of text, nothing left to compute in a template."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from markupsafe import Markup, escape

from ident.equations.mathml import mathml
from ident.errors import Unusable
from ident.fit.result import Estimate, FitResult
from ident.words.engineering import multiple, quantity
from ident.words.error import ErrorOf
from ident.words.number import trimmed
from ident.words.percent import percent_in_print
from ident.words.plus_minus import determined, in_cells
from ident.words.titles import DATA, of_parameter, symbol


@dataclass(frozen=True)
class ParameterRow:
    """One parameter; value, standard error and bounds are multiples of the printed unit.

    `plain` is the value in SI with its unit, as a command or a matrix takes it.
    """

    name: str
    symbol: str
    meaning: str
    unit: str
    value: str
    std_error: str
    relative: str
    lower: str
    upper: str
    remark: str
    plain: str = ""


@dataclass(frozen=True)
class ErrorRow:
    """Errors of one use of runs; `sized` is the use under which their sizes in the output's unit are told.

    `size` is the RMSE, `with_mean` the error with the mean counted, `fit` 100 % less that, `error` eq. (17), with the
    mean beside it where it counts, and the runs on which the model is unstable.
    """

    use: str
    runs: int
    error: str
    floor: str
    ratio: str
    offset: str
    sized: str = ""
    size: str = "–"
    with_mean: str = "–"
    fit: str = "–"


@dataclass(frozen=True)
class Determined:
    """A combination of parameters that the data determine, with its relative standard error."""

    expression: Markup
    spoken: str
    value: str
    relative: str


def parameter_rows(fit: FitResult) -> tuple[ParameterRow, ...]:
    """The table of parameters, in the model's order."""
    undetermined = {entry.name for entry in fit.undetermined}
    return tuple(_parameter(name, entry, name in undetermined) for name, entry in fit.parameters.items())


def _parameter(name: str, entry: Estimate, undetermined: bool) -> ParameterRow:
    value, std_error, unit = in_cells(entry.value, entry.std_error, entry.unit)
    size, _ = multiple(entry.value, entry.unit)
    known = determined(entry.value, entry.std_error)
    return ParameterRow(
        name=name,
        symbol=symbol(name, entry.symbol),
        meaning=of_parameter(name, entry.meaning),
        unit=unit,
        value=value,
        std_error=std_error,
        relative="–"
        if entry.std_error is None or not entry.value or not known
        else percent_in_print(entry.std_error / abs(entry.value), 2),
        lower=trimmed(entry.lower / size),
        upper=trimmed(entry.upper / size),
        remark="; ".join(_remarks(entry, undetermined)),
        plain=f"{entry.value:.8g} {'' if entry.unit == '1' else entry.unit}".strip(),
    )


def _remarks(entry: Estimate, undetermined: bool) -> Iterator[str]:
    if entry.fixed:
        yield "fixed"
    if entry.at_bound:
        yield "at its bound"
    if undetermined:
        yield "not identifiable from these data"


def error_rows(fit: FitResult) -> tuple[ErrorRow, ...]:
    """Errors by use, with the noise floor beside each; then those over windows, where the fit was made over some."""
    over = f" over {fit.window.length}" if fit.window else ""
    return (*_errors(fit, fit.error, "", fit.offset), *(_errors(fit, fit.window.error, over, {}) if fit.window else ()))


def _errors(
    fit: FitResult, errors: Mapping[str, float | None], over: str, offset: Mapping[str, float | None]
) -> Iterator[ErrorRow]:
    for use in ("fit", "held_out", "verify"):
        error, floor = errors.get(use), fit.noise_floor.get(use)
        if error is None:
            continue
        whole = fit.error_of(use)
        said = ErrorOf(error, unstable=whole.unstable) if over else whole
        unstable = said.is_unstable
        yield ErrorRow(
            use=DATA[use] + over,
            runs=sum(run.use == use for run in fit.runs),
            error=said.in_print(),
            floor="unknown" if floor is None else percent_in_print(floor),
            ratio=f"{error / floor:.2f} ×" if floor and not unstable else "–",
            offset=percent_in_print(offset.get(use), 2) if offset and not unstable else "–",
            sized="" if over else use,
            size="–" if over else whole.rmse or "–",
            with_mean="–" if over else whole.counted(percent_in_print),
            fit="–" if over else whole.fit(percent_in_print),
        )


def combination_rows(fit: FitResult) -> tuple[Determined, ...]:
    """What is determined although its factors may not be."""
    return tuple(
        Determined(
            expression=_formula(entry.expression),
            spoken=entry.expression,
            value=quantity(entry.value, entry.unit),
            relative=percent_in_print(entry.std_error / abs(entry.value), 2) if entry.value else "–",
        )
        for entry in fit.determined
    )


def _formula(expression: str) -> Markup:
    """An expression of the grammar as MathML; as text where it is outside the grammar."""
    try:
        equation = mathml(f"determined = {expression.replace('^', '**')}")
    except Unusable:
        return escape(expression)
    _, _, right = equation.partition("<mo>=</mo>")
    return Markup(f"<math><mrow>{right}")
