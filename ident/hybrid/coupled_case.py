"""Several actuators on one structure: each with its own place, loop and specimen, coupled through both.

A part is a :class:`Case` by itself: the structure, of which this part alone is physical, with the gain, the delay and
the limits of its actuator. What is left to the computer is the structure without all of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.case import Case
from ident.hybrid.ground_motion import GroundMotion
from ident.run import Specimen
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
MOST = 8
"""Parts: with two systems side by side they fill the lanes of a kernel."""
QUANTITIES = ("mass", "damping", "stiffness")


@dataclass(frozen=True, eq=False)
class Part:
    """One actuator with what it moves: its `case`, the `fit` of its machine and its `controller` as they are named.

    Both are "" where the part has those of the simulation.
    """

    name: str
    case: Case
    fit: str = ""
    controller: str | Mapping[str, Any] = ""


@dataclass(frozen=True, eq=False)
class CoupledCase:
    """Parts of one structure, which share its coordinates, ground, sample rate.

    `specimen` holds mass, damping and stiffness of all that is physical by the displacements of the parts, (3, P, P):
    on its diagonals stand the specimens of the parts, beside them what joins these. Raises Unusable where two parts
    have one place or one name, or more is physical than there is.
    """

    name: str
    parts: tuple[Part, ...]
    specimen: Array

    def __post_init__(self) -> None:
        names = [part.name for part in self.parts]
        if not 1 <= len(names) <= MOST or len(set(names)) < len(names):
            raise Unusable(
                "bad-case",
                f"{len(names)} parts, {len(set(names))} names",
                "physical",
                f"give 1 to {MOST} parts, each its own name",
            )
        if len(set(self.places)) < len(names):
            raise Unusable("bad-case", "two parts have the same place", "physical", "give each its own")
        if not np.allclose(self.specimen, np.swapaxes(self.specimen, 1, 2)):
            raise Unusable("bad-case", "a matrix of the specimen is not symmetric", "specimen", "correct it")
        if np.linalg.eigvalsh(self.numerical_mass).min() <= 0:
            raise Unusable("bad-case", "no mass is left in the numerical part", "physical mass", "give less of it")

    @property
    def cases(self) -> tuple[Case, ...]:
        """The case of each part."""
        return tuple(part.case for part in self.parts)

    @property
    def places(self) -> tuple[int, ...]:
        """The degree of freedom that each part moves."""
        return tuple(case.place for case in self.cases)

    @property
    def mass(self) -> Array:
        """The mass of the whole structure, (n, n)."""
        return self.parts[0].case.mass

    @property
    def storeys(self) -> int:
        """The number n of degrees of freedom."""
        return self.parts[0].case.storeys

    @property
    def influence(self) -> Array:
        """How far each degree of freedom goes with the ground, (n,)."""
        return self.parts[0].case.influence

    @property
    def sample_rate(self) -> float:
        """Of the outer loop, Hz."""
        return self.parts[0].case.sample_rate

    @property
    def ground(self) -> GroundMotion:
        """The motion of the ground."""
        return self.parts[0].case.ground

    @property
    def numerical_mass(self) -> Array:
        """The mass that is left to the computer, (n, n)."""
        return self._less(self.mass, 0)

    @property
    def numerical_damping(self) -> Array:
        """The damping that is left to the computer, (n, n)."""
        return self._less(self.parts[0].case.damping, 1)

    @property
    def numerical_stiffness(self) -> Array:
        """The stiffness that is left to the computer, (n, n)."""
        return self._less(self.parts[0].case.stiffness, 2)

    @property
    def coupling(self) -> Array:
        """The mass, damping and stiffness that join the specimens, (3, P, P): the entries off the diagonals."""
        return np.array([of - np.diag(np.diag(of)) for of in self.specimen])

    @property
    def joined(self) -> bool:
        """Whether a specimen joins actuators."""
        return bool(self.coupling.any())

    def _less(self, whole: Array, which: int) -> Array:
        left = whole.copy()
        left[np.ix_(self.places, self.places)] -= self.specimen[which]
        return left

    def part(self, name: str) -> Part:
        """The part of that name. Raises Unusable."""
        for one in self.parts:
            if one.name == name:
                return one
        raise Unusable(
            "unknown-part",
            f"the case has no part {name!r}",
            "part",
            did_you_mean(name, [one.name for one in self.parts]),
        )

    def changed(self, **fields: Any) -> CoupledCase:
        """The case whose parts all have these fields instead of their own: ground, delay."""
        return replace(self, parts=tuple(replace(one, case=replace(one.case, **fields)) for one in self.parts))

    def with_ground(self, given: Path | str) -> CoupledCase:
        """The case with another motion, as :meth:`ident.hybrid.case.Case.with_ground`."""
        return self.changed(ground=self.cases[0].with_ground(given).ground)

    def with_isolator(self, isolator: Specimen, name: str | None = None) -> CoupledCase:
        """The case with an isolator on the specimen of each part, or of the part of that `name` alone.

        It stands in the laboratory and in the whole structure. Raises Unusable where there is no such part.
        """
        on = self.places if name is None else (self.part(name).case.place,)
        cases, specimen = self.cases, self.specimen.copy()
        for number, place in enumerate(self.places):
            if place in on:
                specimen[:, number, number] += [getattr(isolator, quantity) for quantity in QUANTITIES]
                cases = tuple(
                    case.with_isolator(isolator) if case.place == place else case.with_added(isolator, place)
                    for case in cases
                )
        parts = tuple(replace(one, case=case) for one, case in zip(self.parts, cases, strict=True))
        return replace(self, parts=parts, specimen=specimen)

    def with_delays(self, delays: tuple[int, ...]) -> CoupledCase:
        """The case whose parts have these delays, in samples."""
        cases = (replace(one.case, delay=delay) for one, delay in zip(self.parts, delays, strict=True))
        return replace(self, parts=tuple(replace(one, case=case) for one, case in zip(self.parts, cases, strict=True)))


System = Case | CoupledCase
"""What a hybrid simulation is of: one actuator or several."""


def case_of_part(of: System, name: str | None) -> Case:
    """The case of one actuator: of the part of that name, where there are several. Raises Unusable."""
    if isinstance(of, CoupledCase):
        if not name:
            named = ", ".join(one.name for one in of.parts)
            raise Unusable("several-parts", "the case has several parts", "part", f"name one of {named}")
        return of.part(name).case
    if name:
        raise Unusable("unknown-part", "the case has one part, without a name", "part", "leave it out")
    return of


def in_coordinates_of(rows: Array) -> Array:
    """T (n, n) whose first rows are `rows` (P, n): in z = T x the displacement of part p is z_p.

    The other coordinates are those directions of x that move no part, each of length 1. Raises Unusable where the
    places of the parts depend on each other.
    """
    count, n = rows.shape
    if count > n or np.linalg.matrix_rank(rows) < count:
        raise Unusable(
            "bad-case",
            "the places of the parts are not independent",
            "physical place",
            "give each part a place that does not follow from the others",
        )
    return np.vstack([rows, scipy.linalg.null_space(rows).T])


def transformed(matrix: Array, inverse: Array) -> Array:
    """T⁻ᵀ M T⁻¹ (n, n): a mass, damping or stiffness in the coordinates z = T x."""
    found = inverse.T @ matrix @ inverse
    return np.asarray((found + found.T) / 2)
