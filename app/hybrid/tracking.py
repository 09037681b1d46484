"""A run of a stored matrix followed as if it came in now: answered at once, and kept nowhere."""

from __future__ import annotations

from app.context import Context
from app.lru import LRU
from app.matrices import service as matrices
from ident.hybrid.tracked_run import Track, chosen
from ident.hybrid.tracked_run import track as tracked
from ident.matrix import Actuator
from ident.units.quantity import parameter_value
from schemas.track_result import TrackView

_MOST = 4  # tracks in memory
_tracks: LRU[tuple[Track, Actuator]] = LRU(_MOST)


def answer(context: Context, matrix: str, run: str | None, noise: str | None) -> TrackView:
    """Time constant and gain over a run, as they are sent. Raises Unusable, and Failure 404."""
    return TrackView(**track(context, matrix, run, noise)[0].to_json())


def track(context: Context, matrix: str, run: str | None = None, noise: str | None = None) -> tuple[Track, Actuator]:
    """Time constant and gain over a run, the first without one, and the machine. Raises Unusable, and Failure 404.

    `noise` is the standard deviation of the sensor, with a unit or in that of the output; the record tells it else.
    """

    def made() -> tuple[Track, Actuator]:
        found = matrices.load(context, matrix)
        followed = chosen(found, run)
        unit = followed.units.get(followed.output, "m")
        size = None if noise is None else parameter_value(noise, unit, "noise")
        return tracked(followed, size), found.actuator

    return _tracks.get((str(context.storage.folder), matrix, run, noise), made)
