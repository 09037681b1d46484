"""How late the actuators of one structure may answer: the critical delay of all, and a map over the delays of two."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
import scipy.linalg
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.controller import Controller, SampledController
from ident.hybrid.coupled_case import CoupledCase
from ident.hybrid.machine import Machine
from ident.hybrid.stability import coupled_loop
from ident.parallel import each, one_thread
from ident.progress import Progress, Report, silent
from ident.words.number import count
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
SHOWN = 20
"""Delays along each axis of a map, at most."""
_LATEST = 64
"""Samples: the longest delay of a map; each is a state of the loop whose poles are sought."""
_POINTS, _BEYOND = 4000, 100.0
"""Frequencies that are searched for crossings, evenly over their logarithm, and how far beyond the modes they go."""
_ABOUT = np.concatenate([-np.geomspace(30.0, 1e-2, 60), [0.0], np.geomspace(1e-2, 30.0, 60)])
"""Half-widths from each mode at which the loop is looked at in addition: so narrow are its peaks."""


def coupled_critical_delay(of: CoupledCase) -> float | None:
    """The longest pure delay τ (s) of all parts, otherwise perfect, with which the hybrid simulation stays stable.

    The poles are the roots of det(1 + R(s) K_p(s) exp(−sτ)) = 0 with R the receptance of the numerical part at the
    places of the parts and K_p = M_p s² + C_p s + K_p the specimen, both (P, P). They cross the imaginary axis where an
    eigenvalue of R K_p has the magnitude 1; the least delay that turns one to −1 there is critical. 0 where the
    specimen has more mass than its places leave to the computer, None where no delay is critical.
    """
    mass = of.specimen[0]
    light = np.linalg.inv(of.numerical_mass)[np.ix_(of.places, of.places)] @ mass
    if np.abs(np.linalg.eigvals(light)).max() >= 1:
        return 0.0
    found = []
    for omega, which in _crossings(of):
        turned = np.angle(-_loops(of, np.array([omega]))[0, which])
        found.append(float(turned % (2 * np.pi)) / omega)
    return min(found, default=None)


def _loops(of: CoupledCase, omega: Array) -> Complex:
    """The eigenvalues of R K_p at frequencies (f,) in rad/s, by their magnitude, (f, P)."""
    s = 1j * omega[:, None, None]
    dynamic = of.numerical_mass * s**2 + of.numerical_damping * s + of.numerical_stiffness
    receptance = np.linalg.inv(dynamic)[:, of.places][:, :, of.places]
    mass, damping, stiffness = of.specimen
    found = np.linalg.eigvals(receptance @ (mass * s**2 + damping * s + stiffness))
    return np.asarray(np.take_along_axis(found, np.argsort(np.abs(found), axis=1), axis=1))


def _crossings(of: CoupledCase) -> Iterator[tuple[float, int]]:
    """Frequencies (rad/s) at which an eigenvalue has the magnitude 1, and which one, by its magnitude."""
    omega = _frequencies(of)
    beyond = np.abs(_loops(of, omega)) - 1.0
    for i, which in zip(*np.nonzero(np.signbit(beyond[:-1]) != np.signbit(beyond[1:])), strict=True):

        def off(at: float, which: int = which) -> float:
            return float(np.abs(_loops(of, np.array([at]))[0, which])) - 1.0

        yield float(scipy.optimize.brentq(off, omega[i], omega[i + 1], rtol=1e-12)), int(which)


def _frequencies(of: CoupledCase) -> Array:
    """Where crossings are looked for, rad/s, in rising order: evenly, and closely about each mode."""
    case, modes = of.parts[0].case, []
    for mass, damping, stiffness in (
        (of.numerical_mass, of.numerical_damping, of.numerical_stiffness),
        (case.mass, case.damping, case.stiffness),
    ):
        n, inverse = len(mass), np.linalg.inv(mass)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ damping]])
        modes += [pole for pole in np.linalg.eigvals(A) if pole.imag > 0]
    if not modes:  # nothing swings: all over the poles
        modes = [1j * abs(pole) for pole in np.linalg.eigvals(A) if abs(pole) > 0] or [1j]
    sizes = [abs(pole) for pole in modes]
    evenly = np.geomspace(min(sizes) / _BEYOND, max(sizes) * _BEYOND, _POINTS)
    closely = [pole.imag + _ABOUT * abs(pole.real) for pole in modes]
    found = np.unique(np.concatenate([evenly, *closely]))
    return found[found > 0]


@dataclass(frozen=True, eq=False)
class DelayMap(TabularResult):
    """Whether the loop is stable over the delays of two parts, in samples, the others as the case has them.

    `names` are the parts, `first` (m,) and `second` (n,) their delays, `stable` and `radius` (m, n) of each pair, the
    largest magnitude of a pole of the sampled loop.
    """

    names: tuple[str, str]
    first: NDArray[np.int64]
    second: NDArray[np.int64]
    stable: NDArray[np.bool_]
    radius: Array

    def listings(self) -> Iterator[Listing | str]:
        """A row a delay of the first: up to which delay of the second the loop is stable."""
        header = (f"delay of {self.names[0]}", "stable", f"longest delay of {self.names[1]} from 1 on")
        yield Listing("", header, self._rows(), header)
        yield f"{int(self.stable.sum())} of {self.stable.size} pairs of delays are stable"

    def _rows(self) -> Iterator[tuple[str, ...]]:
        for delay, stable in zip(self.first, self.stable, strict=True):
            until = len(stable) if stable.all() else int(np.argmin(stable))
            longest = count(int(self.second[until - 1]), "sample") if until else "none"
            yield count(int(delay), "sample"), f"{int(stable.sum())} of {stable.size}", longest

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        return {
            "parts": list(self.names),
            "first": self.first.tolist(),
            "second": self.second.tolist(),
            "stable": self.stable.tolist(),
            "radius": self.radius.tolist(),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> DelayMap:
        """What :meth:`to_json` gave."""
        one, other = data["parts"]
        return cls((one, other), *(np.array(data[name]) for name in ("first", "second", "stable", "radius")))


def delay_map(
    machines: Sequence[Machine],
    of: CoupledCase,
    controllers: Sequence[Controller],
    delays: Sequence[int] | None = None,
    report: Report = silent,
) -> DelayMap:
    """The map over the delays of the first two parts; without `delays` to twice that at which all of them are too late.

    Raises Unusable where there is but one part, or the loop has no poles.
    """
    sampled = with_poles(machines, controllers)
    given = delays if delays is not None else _usual(machines, of, sampled)
    along = np.array(given, dtype=np.int64)
    rest = tuple(case.delay for case in of.cases[2:])
    done = [0]

    def row(first: int) -> list[float]:
        found = [_radius(machines, of.with_delays((first, int(second), *rest)), sampled) for second in along]
        done[0] += 1
        report(Progress("map", done[0], len(along)))
        return found

    with one_thread():
        radius = np.array(each(row, [int(one) for one in along]))
    return DelayMap((of.parts[0].name, of.parts[1].name), along, along, radius < 1.0, radius)


def with_poles(machines: Sequence[Machine], controllers: Sequence[Controller]) -> list[SampledController]:
    """The controllers, where a loop of two parts or more has the poles of a map. Raises Unusable."""
    sampled = [one for one in controllers if isinstance(one, SampledController)]
    off = sorted({name for one in machines for name in one.nonlinear})
    if len(machines) < 2 or len(sampled) < len(controllers) or off:
        why = f"{', '.join(off)} has no poles" if off else "it needs two parts with linear controllers"
        raise Unusable("bad-option", f"no map over delays: {why}", "map", "leave the map out, or change that")
    return sampled


def coupled_poles(machines: Sequence[Machine], of: CoupledCase, controllers: Sequence[SampledController]) -> Complex:
    """The poles z of the whole sampled loop."""
    return np.asarray(scipy.linalg.eigvals(coupled_loop(machines, of, controllers)[0]), complex)


def _radius(machines: Sequence[Machine], of: CoupledCase, controllers: Sequence[SampledController]) -> float:
    return float(np.abs(coupled_poles(machines, of, controllers)).max())


def _usual(machines: Sequence[Machine], of: CoupledCase, controllers: Sequence[SampledController]) -> list[int]:
    """Delays from 1 to twice the one at which the loop is lost where all parts have it, twenty at most."""
    lost = 1
    while lost < _LATEST and _radius(machines, of.with_delays((lost,) * len(of.parts)), controllers) < 1.0:
        lost = max(lost + 1, round(1.25 * lost))
    last = min(max(2 * lost, SHOWN), _LATEST)
    return sorted({round(one) for one in np.linspace(1, last, SHOWN)})
