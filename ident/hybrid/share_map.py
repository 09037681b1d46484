"""Stability and score of a hybrid simulation over the shares of mass and stiffness that are physical."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller import SampledController, no_controller
from ident.hybrid.hybrid_simulation import RUNAWAY
from ident.hybrid.loop import LANES
from ident.hybrid.machine import Machine, machine
from ident.hybrid.rig_assembly import rig_of, run
from ident.hybrid.scores import rms
from ident.hybrid.specimen_effects import references
from ident.hybrid.stability import critical_delay, spectral_radius
from ident.parallel import each
from ident.progress import Progress, Report, silent
from ident.words.engineering import quantity
from ident.words.percent import percent
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]
SHARES = 20
"""Shares along each axis where none are stated."""
LARGEST = 0.95
"""The largest share where none are stated: the numerical part needs a mass of its own."""


@dataclass(frozen=True, eq=False)
class ShareMap(TabularResult):
    """Of each pair of shares (0 to 1) of mass and stiffness, (masses, stiffnesses).

    `stable`; `reference_rms` and `tracking_rms` as in :class:`ident.hybrid.scores.Scores`, NaN where it ran away;
    `critical_delay` in s, NaN where no delay is too long.
    """

    masses: Array
    stiffnesses: Array
    stable: NDArray[np.bool_]
    reference_rms: Array
    tracking_rms: Array
    critical_delay: Array

    def listings(self) -> Iterator[Listing | str]:
        """A row a share of the mass: how many shares of the stiffness are stable with it, and the best of them."""
        header = ("physical mass", "stable", "least error (RMS) against the reference", "longest critical delay")
        yield Listing("", header, self._rows(), header)
        yield f"{int(self.stable.sum())} of {self.stable.size} pairs of shares are stable"

    def _rows(self) -> Iterator[tuple[str, ...]]:
        for mass, stable, error, delay in zip(
            self.masses, self.stable, self.reference_rms, self.critical_delay, strict=True
        ):
            best = error[np.isfinite(error)]
            longest = delay[np.isfinite(delay)]
            yield (
                percent(float(mass)),
                f"{int(stable.sum())} of {stable.size}",
                percent(float(best.min())) if len(best) else "–",
                quantity(float(longest.max()), "s") if len(longest) else "no limit",
            )

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data; null where there is no number."""
        tables = {name: _listed(getattr(self, name)) for name in ("reference_rms", "tracking_rms", "critical_delay")}
        return {
            "mass": self.masses.tolist(),
            "stiffness": self.stiffnesses.tolist(),
            "stable": self.stable.tolist(),
            **tables,
        }


def _listed(table: Array) -> list[list[float | None]]:
    return [[float(value) if np.isfinite(value) else None for value in row] for row in table]


def share_map(
    fit: FitResult,
    case: Case,
    controller: SampledController | None = None,
    effects: Mapping[str, float] | None = None,
    masses: Sequence[float] | None = None,
    stiffnesses: Sequence[float] | None = None,
    report: Report = silent,
) -> ShareMap:
    """The map of a case on the machine of a fit; sixteen pairs side by side, on every core.

    Where the loop is linear it is stable if its poles are; else if its record stayed bounded. Raises Unusable for
    shares outside 0 to below 1.
    """
    case.not_a_table("map")
    usual = np.linspace(0.0, LARGEST, SHARES)
    across, up = (usual if given is None else np.asarray(given, dtype=float) for given in (masses, stiffnesses))
    if any(np.min(shares) < 0 or np.max(shares) >= 1 for shares in (across, up)):
        raise Unusable("bad-option", "a share is not between 0 and 1", "map", "give shares from 0 to below 1")
    acting = controller or no_controller(case.sample_rate)
    ground = case.ground.samples(case.sample_rate)
    cases = [case.with_shares(m, k) for m in across for k in up]
    of = machine(fit, cases[0], effects)
    wanted = references(of, cases, ground)
    lock, count = Lock(), [0]

    def group(first: int) -> Array:
        found = _group(of, tuple(cases[first : first + LANES]), acting, ground, wanted[first : first + LANES])
        with lock:
            count[0] += len(found)
            report(Progress("map", count[0], len(cases)))
        return found

    found = np.concatenate(each(group, range(0, len(cases), LANES)))
    shape = len(across), len(up)
    stable, reference_rms, tracking_rms, critical = (column.reshape(shape) for column in found.T)
    return ShareMap(across, up, stable > 0, reference_rms, tracking_rms, critical)


def _group(
    of: Machine, cases: tuple[Case, ...], acting: SampledController, ground: Array, wanted: Sequence[Array]
) -> Array:
    """Stable, reference_rms, tracking_rms and critical delay of up to sixteen cases, (count, 4)."""
    _kept, rig = rig_of(
        (of,) * len(cases), cases, (acting,), ground, RUNAWAY * np.array([np.abs(one).max() for one in wanted])
    )
    run(rig, (acting,))
    rows = np.full((len(cases), 4), np.nan)
    for lane, case in enumerate(cases):
        kept = rig.ended[lane] >= len(ground)
        rows[lane, 0] = kept and (bool(of.nonlinear) or spectral_radius(of, case, acting) < 1)
        if kept:
            rows[lane, 1] = rms(rig.y[:, lane], wanted[lane])
            rows[lane, 2] = rms(rig.y[:, lane], rig.d[:, lane])
        critical = critical_delay(case)
        rows[lane, 3] = np.nan if critical is None else critical
    return rows
