"""A fit as tables for a reader: on a terminal and in a notebook."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ident.fit.result import Estimate, FitResult
from ident.preprocessing.pipeline import outcome_sentences
from ident.words.error import error_said
from ident.words.percent import percent
from ident.words.plus_minus import in_cells, plus_minus
from ident.words.result_tables import Listing, listings
from ident.words.titles import DATA

USES = tuple(DATA.values())


@listings.register
def fit_listings(result: FitResult) -> Iterator[Listing | str]:
    """Parameters, errors, what the data determine and what they do not, notes."""
    header = ("parameter", "value", "std error", "unit", "")
    title = " + ".join((result.model, *result.effects))
    yield result.headline
    yield Listing(title, header, parameter_rows(result.parameters), header[1:3])
    yield Listing("", ("error", *USES), error_rows(result), USES)
    yield from remarks(result)


def remarks(result: FitResult) -> Iterator[str]:
    """What the data determine and what they do not, and the notes, a line each."""
    if result.aic is not None:
        yield f"AIC: {result.aic:.6g} (only for comparison with fits to the same samples; the smaller is the better)"
    for combination in result.determined:
        value = plus_minus(combination.value, combination.std_error, combination.unit)
        yield f"identifiable: {combination.expression} = {value}"
    for entry in result.undetermined:
        yield f"not identifiable: {entry.name}: {entry.reason}"
    for note in result.notes:
        yield f"note: {note}"
    for said in outcome_sentences(result.preprocessing, result.notes):
        yield f"preprocessing: {said}"


def parameter_rows(parameters: Mapping[str, Estimate]) -> Iterator[tuple[str, ...]]:
    """One row a parameter, in a readable multiple of its unit."""
    for name, estimate in parameters.items():
        remark = "fixed" if estimate.fixed else "at its bound" if estimate.at_bound else ""
        yield name, *in_cells(estimate.value, estimate.std_error, estimate.unit), remark


def error_rows(result: FitResult) -> Iterator[tuple[str, ...]]:
    """The error by use: in the output's unit and with the mean counted, then eq. (17), noise floor and offset."""
    uses = ("fit", "held_out", "verify")
    errors = [result.error_of(use) for use in uses]
    yield "RMSE", *(of.rmse or "–" for of in errors)
    yield "with the mean", *(of.counted() for of in errors)
    yield "NRMSE fit", *(of.fit() for of in errors)
    yield "eq. (17)", *(of.alone() for of in errors)
    if result.window:
        over = result.window.error
        between = {use: " to ".join(map(error_said, ends)) for use, ends in result.window.free_run.items()}
        if between:
            yield "95 % interval", *(between.get(use, "–") for use in uses)
        yield f"over {result.window.length}", *(error_said(over.get(use)) for use in uses)
    yield "noise floor", *(percent(result.noise_floor.get(use)) for use in uses)
    offsets = zip((result.offset.get(use) for use in uses), errors, strict=True)
    yield "offset", *("–" if of.is_unstable else percent(offset) for offset, of in offsets)
