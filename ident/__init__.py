"""Identification of servo-hydraulic actuators: a measured matrix in, a model and what it lacks out.

The face for notebooks; what it names is imported when it is first used.

    import ident

    matrix = ident.read_matrix("bench/SW-117")
    fit = ident.identify(matrix)               # parameters, standard errors, error
    found = ident.diagnose(matrix, fit)        # what the model lacks
    ident.figure(fit, "bode")                  # shows itself
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ident.words.result_tables import TABLES as _TABLES

if TYPE_CHECKING:
    from ident.checks.check import check
    from ident.errors import Unusable
    from ident.fit.settings import Settings
    from ident.matrix import Matrix
    from ident.readers import from_arrays, from_table, read_matrix
    from ident.workflows import (
        compare,
        diagnose,
        figure,
        identify,
        load,
        next_run,
        plan,
        propose,
        save,
        simulate,
    )

_ROOMS = {
    "Matrix": "ident.matrix",
    "Settings": "ident.fit.settings",
    "Unusable": "ident.errors",
    "check": "ident.checks.check",
    "compare": "ident.workflows",
    "diagnose": "ident.workflows",
    "figure": "ident.workflows",
    "from_arrays": "ident.readers",
    "from_table": "ident.readers",
    "identify": "ident.workflows",
    "load": "ident.workflows",
    "next_run": "ident.workflows",
    "plan": "ident.workflows",
    "propose": "ident.workflows",
    "read_matrix": "ident.readers",
    "save": "ident.workflows",
    "simulate": "ident.workflows",
}

_TABLES.update(
    {
        "ident.bench.analysis": "ident.bench.tables",
        "ident.diagnosis.result": "ident.diagnosis.tables",
        "ident.fit.result": "ident.fit.tables",
    }
)

__all__ = [
    "Matrix",
    "Settings",
    "Unusable",
    "check",
    "compare",
    "diagnose",
    "figure",
    "from_arrays",
    "from_table",
    "identify",
    "load",
    "next_run",
    "plan",
    "propose",
    "read_matrix",
    "save",
    "simulate",
]


def __getattr__(name: str) -> Any:
    if name not in _ROOMS:
        raise AttributeError(f"the library has no {name!r}: it has {', '.join(__all__)}")
    found = getattr(import_module(_ROOMS[name]), name)
    if name == "Matrix":
        for maker in ("from_arrays", "from_table"):  # where they stood in earlier versions: notebooks call them there
            setattr(found, maker, staticmethod(getattr(import_module("ident.readers"), maker)))
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
