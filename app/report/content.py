"""What the report says of one fit: error, parameters, figures, where it fails, what is missing, data, provenance."""

from __future__ import annotations

from collections.abc import Iterator

from app.fits.rows import combination_rows, error_rows, parameter_rows
from app.report.blocks import Block, Facts, Figure, Formula, Heading, Report, Signatures, Table, Tables, Text
from app.report.rows import budget_rows, candidate_rows, curve_rows, group_tables, ladder_steps, trend_rows
from app.report.sheet import NOTHING_STATED, Sheet, facts
from ident.checks.check import check
from ident.custom.definition import preset_with
from ident.diagnosis.next_commands import next_command
from ident.diagnosis.result import Diagnosis
from ident.diagnosis.sentences import cannot_distinguish
from ident.errors import Unusable
from ident.figures import figure
from ident.figures.subjects import Ladder
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.residuals.survey import Survey, survey
from ident.run import USES
from ident.words.engineering import printed_unit, quantity
from ident.words.error import error_in_print, errors_line
from ident.words.percent import percent_in_print
from ident.words.run_name import run_name
from ident.words.severity import level
from ident.words.titles import data, with_effects
from ident.workflows import compare, study

WRITTEN = "……………"
"""Stands where a data sheet leaves room to write by hand."""
CAPTIONS = {
    "bode": "Frequency response, measured and model",
    "residual-map": "Error of each run over frequency",
    "residual-curve": "Missing nonlinearity versus internal signals",
    "time": "Time record, part of one run",
    "step": "Step response of the model",
}


def content(
    matrix: Matrix, fit: FitResult, diagnosis: Diagnosis | None = None, sheet: Sheet = NOTHING_STATED
) -> Report:
    """The report of a fit. Raises Unusable where the fit is of another model's data."""
    found = survey(compare(matrix, fit))
    model = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    title = with_effects(model.title, fit.effects)
    blocks = [
        Facts(tuple((name, value or WRITTEN) for name, value in facts(sheet, matrix, fit)), wide=False),
        *([Text(_verdict(diagnosis), "verdict")] if diagnosis else ()),
        *_error(fit, found),
        *_parameters(fit),
        Heading("Measurement and model"),
        _drawn("bode", matrix, fit),
        _drawn("time", matrix, fit),
        _drawn("step", matrix, fit),
        *_failing(matrix, fit, found),
        *(_missing(diagnosis, matrix) if diagnosis else ()),
        *_data(matrix),
        Heading("Provenance"),
        Facts(_provenance(fit, model.citation)),
        Heading("Signatures"),
        _signatures(sheet, matrix),
    ]
    lead = f"{fit.method}, seed {fit.seed} · {len(fit.runs)} runs · servoident {fit.version}"
    errors = errors_line({use: fit.error_of(use) for use in USES}, percent_in_print)
    return Report(f"{matrix.actuator.serial}: {title}", f"Error {errors} · {lead}", blocks, sheet.logo)


def _signatures(sheet: Sheet, matrix: Matrix) -> Signatures:
    test, approval = sheet.test.over(matrix.test), sheet.approval
    who, since = ("", "") if approval is None else (approval.who, approval.since[:10])
    return Signatures((("Tested", test.operator, test.date), ("Checked", "", ""), ("Approved", who, since)))


def _error(fit: FitResult, found: Survey) -> Iterator[Block]:
    budget = found.budget
    yield Heading("Error")
    whole = "Means over runs of RMS(measured − model), of the same over std(measured),"
    fit_to = "NRMSE fit: 100 % less the latter, of the free simulation."
    yield Text(f"{whole} and of std(measured − model) / std(measured), eq. (17). {fit_to}")
    listed = error_rows(fit)
    rows = tuple(
        (f"{row.runs} {row.use}", row.size, row.with_mean, row.fit, row.error, row.floor, row.ratio, row.offset)
        for row in listed
    )
    header = ("Runs", "RMSE", "With the mean", "NRMSE fit", "Eq. (17)", "Noise floor", "Ratio", "Offset")
    yield Table(header, rows, (1, 2, 3, 4, 5, 6, 7))
    yield Facts(
        (
            *((f"Whiteness of the residual, {data(use)}", str(white)) for use, white in found.white.items()),
            *((("AIC, for fits to the same samples", f"{fit.aic:.6g}"),) if fit.aic is not None else ()),
        )
    )
    if budget:
        yield Heading("Error budget", 3)
        yield Table(("Part", "Meaning", "Size", "At least", "At most"), budget_rows(budget), (2, 3, 4))
        square = "The squares of the sizes add up to the square of the error on estimation data."
        yield Text(" ".join((square, *budget.notes)), "faint")


def _parameters(fit: FitResult) -> Iterator[Block]:
    yield Heading("Parameters")
    header = ("Symbol", "Meaning", "Value", "Std error", "Unit", "Relative", "Lower", "Upper", "Remark")
    known = parameter_rows(fit)
    rows = tuple(
        (p.symbol, p.meaning, p.value, p.std_error, p.unit, p.relative, p.lower, p.upper, p.remark) for p in known
    )
    yield Table(header, rows, (2, 3, 5, 6, 7))
    if fit.determined:
        yield Heading("Identifiable combinations", 3)
        combined = tuple(
            (Formula(row.expression, printed_unit(entry.expression)), row.value, row.relative)
            for row, entry in zip(combination_rows(fit), fit.determined, strict=True)
        )
        yield Table(("Combination", "Value", "Relative std error"), combined, (1, 2))
    if fit.undetermined:
        yield Heading("Not identifiable", 3)
        symbols = {p.name: p.symbol for p in known}
        yield Facts(tuple((symbols.get(entry.name, entry.name), entry.reason) for entry in fit.undetermined))
    if fit.notes:
        yield Heading("Notes", 3)
        yield from map(Text, fit.notes)


def _failing(matrix: Matrix, fit: FitResult, found: Survey) -> Iterator[Block]:
    yield Heading("Residual analysis")
    yield _drawn("residual-curve", matrix, fit)
    header = ("Curve", "Shows", "Internal signal", "Share of the residual variance")
    yield Table(header, curve_rows(found.curves), (3,))
    yield _drawn("residual-map", matrix, fit)
    yield Tables(
        tuple(
            Table(
                (by.capitalize(), "Runs", "Error", "Mean"),
                tuple((g.label, str(g.runs), error_in_print(g.error), percent_in_print(g.mean)) for g in groups),
                (1, 2, 3),
            )
            for by, groups in group_tables(found.where).items()
        )
    )
    yield Heading("Parameters that depend on a condition", 3)
    trends = trend_rows(found.trends)
    if trends:
        alone = "Estimate from the runs of each condition alone, with all other parameters fixed"
        yield Text(f"{alone}. A physical constant would not change: the model is missing an effect.")
        yield Table(("Parameter", "Against", "Values", "p"), trends, (3,))
    else:
        yield Text("No significant dependence.")


def _missing(diagnosis: Diagnosis, matrix: Matrix) -> Iterator[Block]:
    verdict = diagnosis.verdict
    yield Heading("Missing effects")
    for line in diagnosis.summary:
        yield Text(line, "verdict")
    yield Text(_verdict(diagnosis))
    if verdict.unexplained:
        yield Text("No effect in the library brings the error near the noise floor.")
    for group in verdict.indistinguishable:
        yield Text(cannot_distinguish(group, verdict.effects))
    for suspect in verdict.suspects:
        yield Text(f"Label looks wrong: {run_name(suspect.run)}: {suspect.what}")
    if command := next_command(diagnosis):
        yield Text(command)
    if steps := ladder_steps(diagnosis):
        chart = figure("ladder", Ladder(steps, diagnosis.noise_floor.get("fit"), matrix.actuator))
        yield Figure("ladder", chart, "The error with each effect added")
    header = ("Effect", "Probability", "Predicted error", "Estimation", "Held-out", "Validation", "Reason")
    yield Table(header, candidate_rows(diagnosis), (1, 2, 3, 4, 5))


def _verdict(diagnosis: Diagnosis) -> str:
    return diagnosis.verdict.text or "The diagnosis gives no verdict in words."


def _data(matrix: Matrix) -> Iterator[Block]:
    yield Heading("Data")
    found = check(matrix)
    if found:
        rows = tuple((level(entry.severity), entry.run or "all", entry.text) for entry in found)
        yield Table(("Level", "Run", "Finding"), rows, marked=0)
    else:
        yield Text("No errors, no warnings.")


def _provenance(fit: FitResult, citation: str) -> tuple[tuple[str, str], ...]:
    taken = quantity(fit.seconds, "s")
    starts = f"; {fit.starts}" if fit.starts else ""
    return (
        ("Model", f"{fit.model}: {citation}"),
        ("Method", f"{fit.method}, seed {fit.seed}, {fit.evaluations} evaluations in {taken}{starts}"),
        ("Data, SHA-256", fit.data_hash),
    )


def _drawn(name: str, matrix: Matrix, fit: FitResult) -> Figure:
    """A figure; where the model or the data do not allow it, what that is."""
    try:
        return Figure(name, figure(name, study(matrix, fit)), CAPTIONS[name])
    except Unusable as error:
        return Figure(name, str(error), CAPTIONS[name])
