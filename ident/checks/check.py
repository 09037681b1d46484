"""Every physical doubt about a matrix, in words, before a fit is started on it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ident.checks.amplitude import amplitude
from ident.checks.band import band
from ident.checks.clipping import clipping
from ident.checks.copied import copied
from ident.checks.delay import delays
from ident.checks.feedback import CODE, feedback
from ident.checks.finding import Finding, Findings
from ident.checks.flat import flat
from ident.checks.gain import force_sign, gain
from ident.checks.late_start import late_starts
from ident.checks.means import means
from ident.checks.missing_input import missing_input
from ident.checks.offset import offset
from ident.checks.passivity import turned_sign
from ident.checks.ranges import ranges
from ident.checks.repeats import repeats
from ident.checks.response import Response, respond
from ident.checks.rig import BEYOND, beyond_rig
from ident.checks.scale import scale
from ident.checks.self_oscillation import self_oscillating
from ident.checks.statements import specimen_is_moved, statements
from ident.checks.summary import RunSummary, Summary, describe
from ident.checks.timing import timing
from ident.checks.unit_factor import unit_factor
from ident.matrix import Actuator, Matrix
from ident.preprocessing import screen
from ident.run import Run
from ident.words.arguments import stated_kinds

__all__ = ["Finding", "Findings", "RunSummary", "Summary", "check", "describe"]

ORDER = ("fault", "doubt", "note")


@stated_kinds
def check(matrix: Matrix) -> Findings:
    """Everything that a person should know about the data: what left the rig's limits, faults, doubts, notes."""
    matrix = screen(matrix)
    measured = [(run, respond(run)) for run in matrix.runs]
    found = [finding for run, response in measured for finding in one_run(run, response, matrix.actuator)]
    if specimen_is_moved(matrix):  # whoever moves it, its force answers the motion
        found = [finding for finding in found if finding.code != CODE]
    found += [
        *delays(measured),
        *(scaled := list(scale(measured))),
        *repeats(matrix),
        *means(matrix),
        *late_starts(matrix),
        *statements(matrix),
    ]
    found += unit_factor(measured, [one.run for one in scaled])
    return Findings(sorted(_once(found, matrix), key=lambda each: (each.code != BEYOND, ORDER.index(each.severity))))


def _once(found: Sequence[Finding], matrix: Matrix) -> Iterator[Finding]:
    """What concerns a record is said once, not at each of its outputs."""
    records = {run.id: run.record or run.id for run in matrix.runs}
    said = set()
    for finding in found:
        record = records.get(finding.run or "", "")
        key = record, finding.code, finding.text.replace(finding.run or record, record)
        if not record or key not in said:
            yield finding
        said.add(key)


def one_run(run: Run, response: Response | None, actuator: Actuator) -> Iterator[Finding]:
    """What can be said of a run by itself."""
    yield from timing(run, response)
    yield from clipping(run)
    yield from flat(run)
    yield from copied(run)
    yield from band(run, response)
    yield from amplitude(run)
    yield from gain(run, response)
    yield from force_sign(run)
    yield from turned_sign(run)
    yield from offset(run)
    yield from feedback(run)
    yield from missing_input(run)
    yield from self_oscillating(run)
    yield from ranges(run, actuator)
    yield from beyond_rig(run, actuator)
