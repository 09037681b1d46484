"""Results that a command is given: the fit or the diagnosis of a JSON file, of any version."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.diagnosis.result import Diagnosis
    from ident.fit.result import FitResult

T = TypeVar("T")
_LARGEST = 500_000_000  # bytes: a fit with the history of its search is some megabytes


def read_fit(path: Path) -> FitResult:
    """A fit from its JSON file; raises Unusable where it is not one."""
    from ident.fit.result import FitResult

    return _read(path, FitResult.from_json)


def read_diagnosis(path: Path) -> Diagnosis:
    """A diagnosis from its JSON file; raises Unusable where it is not one."""
    from ident.diagnosis.result import Diagnosis

    return _read(path, Diagnosis.from_json)


def read_result(path: Path) -> FitResult | Diagnosis:
    """The fit or the diagnosis of a JSON file; raises Unusable where it is neither."""
    from ident.diagnosis.result import Diagnosis
    from ident.fit.result import FitResult

    def either(data: object) -> FitResult | Diagnosis:
        is_diagnosis = isinstance(data, dict) and "candidates" in data
        return Diagnosis.from_json(data) if is_diagnosis else FitResult.from_json(data)

    return _read(path, either)


def _read(path: Path, reader: Callable[[object], T]) -> T:
    """What the file holds; a refusal names the file."""
    try:
        data = json.loads(path.read_bytes()) if path.stat().st_size <= _LARGEST else None
    except (ValueError, RecursionError):
        data = None
    try:
        return reader(data)
    except Unusable as error:
        raise Unusable(error.code, error.what, str(path), error.remedy) from None
