"""Identification of servo-hydraulic actuators: a measured matrix in, a model and what it lacks out.

The face for notebooks; what it names is imported when it is first used.

    from ident import compare, diagnose, figure, identify, read_matrix

    matrix = read_matrix(Path("bench/SW-117"))
    fit = identify(matrix)                     # parameters, standard errors, error
    found = diagnose(matrix, fit)              # what the model lacks
    figure("bode", matrix, fit).save("bode.svg")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ident.checks.check import check
    from ident.fit.settings import Settings
    from ident.readers import read_matrix
    from ident.workflows import compare, diagnose, figure, identify

_ROOMS = {
    "Settings": "ident.fit.settings", "check": "ident.checks.check", "compare": "ident.workflows",
    "diagnose": "ident.workflows", "figure": "ident.workflows", "identify": "ident.workflows",
    "read_matrix": "ident.readers",
}  # fmt: skip

__all__ = ["Settings", "check", "compare", "diagnose", "figure", "identify", "read_matrix"]


def __getattr__(name: str) -> Any:
    if name not in _ROOMS:
        raise AttributeError(f"the library has no {name!r}: it has {', '.join(__all__)}")
    return getattr(import_module(_ROOMS[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
