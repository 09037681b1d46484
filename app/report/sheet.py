"""What a data sheet states beside the fit: the test, the fit's id, its approval, and the logo of the laboratory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.readers.provenance_description import describe_test
from ident.rig.provenance import UNSTATED, Provenance
from ident.words.engineering import quantity
from ident.words.number import plain

ZERO_CELSIUS = 273.15  # K
_MEDIA = {b"\x89PNG\r\n\x1a\n": ("png", "image/png"), b"\xff\xd8\xff": ("jpg", "image/jpeg")}
_LARGEST = 1 << 20  # bytes


@dataclass(frozen=True)
class Logo:
    """A picture, with the ending of its name and its media type."""

    content: bytes
    ending: str
    media: str


@dataclass(frozen=True)
class Approval:
    """Who approved the fit, when and why."""

    who: str
    since: str
    why: str = ""


@dataclass(frozen=True)
class Sheet:
    """`test` stands over what the data set states; `fit` and `fitted` are the id of a stored fit and its date."""

    test: Provenance = UNSTATED
    fit: str = ""
    fitted: str = ""
    approval: Approval | None = None
    logo: Logo | None = None

    def of(self, stated: Mapping[str, str]) -> Sheet:
        """With what is stated of the test, by the names of its fields. Raises Unusable."""
        given = describe_test({name: value for name, value in stated.items() if value}, "data sheet")
        return replace(self, test=given.over(self.test))


NOTHING_STATED = Sheet()


def facts(sheet: Sheet, matrix: Matrix, fit: FitResult) -> Iterator[tuple[str, str]]:
    """Names and values in the order of a data sheet; what is not stated is left to be written by hand."""
    test, machine = sheet.test.over(matrix.test), matrix.actuator
    yield "Laboratory", test.laboratory
    yield "Customer", test.customer
    yield "Order", test.order
    yield "Serial number", machine.serial
    yield "Actuator", ", ".join(text for text in (machine.name, machine.batch and f"batch {machine.batch}") if text)
    if machine.servo_valve:
        yield "Servo valve", machine.servo_valve
    if machine.piston_area:
        yield "Piston area", quantity(machine.piston_area, "m^2")
    if machine.supply_pressure:
        yield "Supply pressure", quantity(machine.supply_pressure, "Pa")
    yield "Oil temperature", temperature(test, matrix)
    yield "Operator", test.operator
    yield "Date of the test", test.date
    yield "Data set, SHA-256", fit.data_hash[:12]
    if sheet.fit:
        yield "Fit", f"{sheet.fit} of {sheet.fitted[:10]}"
    yield "Approval", _approved(sheet)


def _approved(sheet: Sheet) -> str:
    if sheet.approval is None:
        return "not approved"
    why = f": {sheet.approval.why}" if sheet.approval.why else ""
    return f"by {sheet.approval.who or 'unknown'} on {sheet.approval.since[:10]}{why}"


def temperature(test: Provenance, matrix: Matrix) -> str:
    """As it is stated, else the range of the means of what the runs recorded, °C."""
    means = [float(np.mean(run.channels["temperature"])) for run in matrix.runs if "temperature" in run.channels]
    known = [test.oil_temperature] if test.oil_temperature is not None else means
    if not known:
        return ""
    low, high = (plain(of(known) - ZERO_CELSIUS, 3) for of in (min, max))
    return f"{low} °C" if low == high else f"{low} to {high} °C"


def logo(path: Path) -> Logo:
    """The picture in a file. Raises Unusable where it is none."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise Unusable("bad-logo", error.strerror or "cannot be read", f"logo {path.name}", "name a file") from error
    for start, (ending, media) in _MEDIA.items():
        if content.startswith(start) and len(content) <= _LARGEST:
            return Logo(content, ending, media)
    raise Unusable("bad-logo", "it is not a PNG or JPEG of at most 1 MB", f"logo {path.name}", "save it as PNG")
