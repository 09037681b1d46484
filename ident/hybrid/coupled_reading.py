"""The case of a hybrid simulation with several actuators, as a user writes it.

    structure: {mass: [2 t, 2 t, 2 t], stiffness: {matrix: [...], unit: kN/m}, damping: {ratio: 2 %}}
    physical:
      - {name: left,  storey: 1, mass: 10 %, stiffness: 50 kN/m, fit: left.json, controller: left/controller.json}
      - {name: right, storey: 3, mass: 10 %, stiffness: 50 kN/m, gain: 5, piston_area: 300 mm^2, rig: {stroke: 100 mm}}

What a part does not state (gain, piston_area, supply_pressure, delay, noise, rig) is that of the case, and its fit and
controller are those of the simulation. `place: [1, 0.5, 0]` instead of `storey` says how far the part goes with each
degree of freedom. `structure: {direction: [1, 0, 0]}` says which of them the ground moves, `specimen: {mass, stiffness,
damping}` what is physical in the coordinates of the structure, with what joins the parts, instead of theirs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.case import Case, called_or_read, case_of, matrix
from ident.hybrid.coupled_case import QUANTITIES, CoupledCase, Part, System, in_coordinates_of, transformed
from ident.readers.typed_fields import Fields
from ident.run import Specimen

Array = NDArray[np.float64]
_OWN = ("gain", "piston_area", "supply_pressure", "delay", "noise", "rig")
_PART = ("name", "storey", "place", "mass", "stiffness", "damping", "fit", "controller", *_OWN)
_UNITS = {"mass": "mass", "damping": "damping", "stiffness": "stiffness"}
_OUTSIDE = 1e-9
"""Of its largest entry: what a specimen may have at coordinates that no part moves is rounding."""


def read_system(given: str | Path) -> System:
    """A case by its name or from a YAML file, of one actuator or of several. Raises Unusable."""
    return called_or_read(given, system_of)


def system_of(data: Any, base: Path | None = Path(), name: str = "case") -> System:
    """The case of a description, as :func:`ident.hybrid.case.case_of`; `physical` may be a list of parts."""
    listed = isinstance(data, Mapping) and isinstance(data.get("physical"), list)
    return coupled_of(data, base, name) if listed else case_of(data, base, name)


def coupled_of(data: Mapping[str, Any], base: Path | None, name: str) -> CoupledCase:
    """The case of several parts of a description. Raises Unusable with the field at fault."""
    entries = [Fields(one, f"physical part {i}", _PART) for i, one in enumerate(data["physical"], 1)]
    if not entries:
        raise Unusable("missing-field", "there is no part", "physical", "give one part at least")
    whole = {key: value for key, value in data.items() if key not in ("physical", "specimen", *_OWN)}
    cases = [_alone(data, whole, entry, base, name) for entry in entries]
    rows = np.array([_row(entry, case) for entry, case in zip(entries, cases, strict=True)])
    turn = in_coordinates_of(rows)
    inverse: Array = np.asarray(np.linalg.inv(turn), float)
    specimen = _joint(data["specimen"], cases, inverse) if data.get("specimen") is not None else _apart(cases)
    found = []
    for number, (entry, alone) in enumerate(zip(entries, cases, strict=True)):
        called = entry.text("name", f"part {number + 1}")
        case = replace(alone, name=f"{alone.name}, {called}")
        mass, damping, stiffness = (float(of[number, number]) for of in specimen)
        found.append(
            Part(
                called,
                _placed(case, number, turn, inverse, rows, Specimen(mass, stiffness, damping)),
                entry.text("fit"),
                _controller(entry),
            )
        )
    return CoupledCase(cases[0].name, tuple(found), specimen)


def _alone(data: Mapping[str, Any], whole: Mapping[str, Any], entry: Fields, base: Path | None, name: str) -> Case:
    """The structure with this part alone physical."""
    own = {key: entry.data.get(key, data.get(key)) for key in _OWN}
    physical = {key: entry.data[key] for key in ("storey", *QUANTITIES) if key in entry}
    if "specimen" in data and set(physical) - {"storey"}:
        raise Unusable(
            "bad-case", "the specimen is stated twice", entry.where, "state it in the part, or under specimen"
        )
    stated = {key: value for key, value in own.items() if value is not None}
    try:
        return case_of({**whole, **stated, "physical": physical}, base, name)
    except Unusable as error:
        raise Unusable(error.code, error.what, f"{entry.where}: {error.where}", error.remedy) from None


def _row(entry: Fields, case: Case) -> list[float]:
    """How far a part goes with each degree of freedom, (n,)."""
    if "place" not in entry:
        return [float(i == case.place) for i in range(case.storeys)]
    given = entry.data["place"]
    numbers = [one for one in given if isinstance(one, int | float)] if isinstance(given, list) else []
    if "storey" in entry or len(numbers) != case.storeys or not np.isfinite(numbers).all() or not any(numbers):
        raise Unusable(
            "bad-case",
            "not one number for each degree of freedom",
            entry.place("place"),
            f"give {case.storeys} numbers, or a storey instead",
        )
    return [float(one) for one in numbers]


def _controller(entry: Fields) -> str | Mapping[str, Any]:
    given = entry.data.get("controller")
    return given if isinstance(given, Mapping) else entry.text("controller")


def _apart(cases: list[Case]) -> Array:
    """Specimens that nothing joins, (3, P, P)."""
    return np.array([np.diag([getattr(case.physical, name) for case in cases]) for name in QUANTITIES])


def _joint(data: Any, cases: list[Case], inverse: Array) -> Array:
    """The specimen of a description by the displacements of the parts, (3, P, P)."""
    fields, parts, n = Fields(data, "specimen", QUANTITIES), len(cases), cases[0].storeys
    found = np.zeros((len(QUANTITIES), parts, parts))
    for number, name in enumerate(QUANTITIES):
        if name not in fields:
            continue
        given = matrix(fields, name, _UNITS[name])
        if given.shape != (n, n):
            raise Unusable(
                "bad-case",
                f"{name} is {len(given)} rows, the structure {n}",
                "specimen",
                "give it in the coordinates of the structure",
            )
        by_parts = transformed(given, inverse)
        outside = np.abs(by_parts).copy()
        outside[:parts, :parts] = 0.0
        if outside.max() > _OUTSIDE * np.abs(by_parts).max():
            raise Unusable(
                "bad-case",
                f"its {name} is where no part moves it",
                "specimen",
                "give what the parts move, or another place for one of them",
            )
        found[number] = by_parts[:parts, :parts]
    return found


def _placed(case: Case, number: int, turn: Array, inverse: Array, rows: Array, specimen: Specimen) -> Case:
    """The case in the coordinates whose first ones are the displacements of the parts, where `rows` ask for these."""
    if np.isin(rows, (0.0, 1.0)).all() and (rows.sum(axis=1) == 1).all():
        return replace(case, physical=specimen)  # a storey each: the structure's own coordinates have them
    mass, damping, stiffness = (transformed(getattr(case, name), inverse) for name in QUANTITIES)
    return replace(
        case,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        physical=specimen,
        place=number,
        direction=turn @ case.influence,
    )
