"""A run of a fit's matrix, followed by the tracking filter, as the page shows it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from urllib.parse import urlencode

from ident.hybrid.tracked_run import Track
from ident.words.number import plain
from ident.words.plus_minus import plus_minus
from schemas.matrix import RunView


@dataclass(frozen=True)
class Tracked:
    """What the filter found at the end of a run, and its verdict."""

    rows: tuple[tuple[str, str, str], ...]
    holds: bool
    reason: str
    nis: str
    noise: str


@dataclass(frozen=True)
class TrackingView:
    """The runs of the matrix to choose from, what was asked, the answer, or why there is none."""

    matrix: str
    runs: tuple[str, ...]
    given: Mapping[str, str]
    found: Tracked | None = None
    problem: str = ""

    @property
    def figure(self) -> tuple[str, str]:
        """The address of the figure, and its query."""
        asked = {name: self.given[name] for name in ("run", "noise") if self.given.get(name)}
        return f"/api/v1/matrices/{self.matrix}/track/figures/tracking", urlencode(asked)


def tracking_view(
    matrix: str, runs: Sequence[RunView], given: Mapping[str, str], found: Track | None = None, problem: str = ""
) -> TrackingView:
    """The section for the runs of a matrix that have a command."""
    names = tuple(run.id for run in runs if "command" in run.channels)
    return TrackingView(matrix, names, given, None if found is None else _tracked(found), problem)


def _tracked(found: Track) -> Tracked:
    clock = "s" if found.run.time_unit == "s" else "samples"
    said, unit = found.verdict, found.run.units.get(found.run.output, "m")
    return Tracked(
        rows=(
            ("τyr", "time constant", plus_minus(float(found.tau[-1]), float(found.std_tau[-1]), clock)),
            ("kyr", "gain", plus_minus(float(found.gain[-1]), float(found.std_gain[-1]), "1")),
        ),
        holds=said.holds,
        reason=said.reason,
        nis="unknown" if said.nis_mean is None else plain(said.nis_mean),
        noise=plus_minus(found.noise.measurement, None, unit),
    )
