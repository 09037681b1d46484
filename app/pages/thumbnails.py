"""A run at a glance: lowest and highest value of input and output in each of a few columns, as a small SVG."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from app.context import Context
from app.errors import missing
from app.matrices import service as matrices
from ident.decimation.levels import Levels
from ident.run import Run, Samples

WIDTH, HEIGHT = 160, 34  # px
_COLUMNS = 80
_EXTREMES = 8  # of a column, lowest and highest each, where a picture is drawn from levels
_INPUT, _OUTPUT = "#8792a0", "#2f8fd3"  # seen on light and on dark ground: a picture does not know the page's theme
Whole = NDArray[np.int64]
_lock = Lock()


def thumbnail(context: Context, matrix: str, place: int) -> str:
    """The picture of a matrix's run by its place among the runs; raises Failure 404."""
    with _lock:  # a page asks for all of them at once, and the first reads the samples
        drawn = _drawn(context, matrix)
    if not 0 <= place < len(drawn):
        raise missing("run", str(place))
    return drawn[place]


@lru_cache(maxsize=16)
def _drawn(context: Context, matrix: str) -> tuple[str, ...]:
    runs, levels = matrices.drawn_from(context, matrix)
    return tuple(picture(run, run.channels.__getitem__ if levels is None else _thinned(levels, run.id)) for run in runs)


def _thinned(levels: Levels, run: str) -> Callable[[str], Samples]:
    """The extremes of a channel in time order, some for each column of a picture."""
    return lambda channel: levels.envelope(run, channel, 0, levels.length(run), _EXTREMES * _COLUMNS)[1]


def picture(run: Run, samples: Callable[[str], Samples]) -> str:
    """Input grey, output blue; on one scale where both have one unit, so that a wrong gain or sign shows."""
    names = [next((name for name in ("command", "current", "drive_force") if name in run.channels), run.output)]
    names += [run.output] if run.output != names[0] else []
    bands = [_band(samples(name)) for name in names]
    if len({run.units.get(name) for name in names}) == 1:
        low, high = min(b[0].min() for b in bands), max(b[1].max() for b in bands)
        ranges = [(low, high)] * len(bands)
    else:
        ranges = [(b[0].min(), b[1].max()) for b in bands]
    colours = (_INPUT, _OUTPUT)[-len(bands) :]
    return _svg("".join(_path(*parts) for parts in zip(bands, ranges, colours, strict=True)))


def curve(samples: NDArray[np.float64]) -> str:
    """One column of a raw file, blue."""
    band = _band(samples)
    return _svg(_path(band, (float(band[0].min()), float(band[1].max())), _OUTPUT))


def _svg(paths: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
        f'viewBox="0 0 {WIDTH} {HEIGHT}" stroke-linejoin="round">{paths}</svg>'
    )


def _band(samples: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lowest and highest sample of each column; columns share their edges, so that a steep line has no gap."""
    edges = np.linspace(0, len(samples) - 1, min(_COLUMNS, len(samples) - 1) + 1).astype(int)
    inside = np.minimum.reduceat(samples, edges[:-1]), np.maximum.reduceat(samples, edges[:-1])
    last = samples[edges[1:]]
    return np.minimum(inside[0], last), np.maximum(inside[1], last)


def _path(band: tuple[NDArray[np.float64], NDArray[np.float64]], between: tuple[float, float], colour: str) -> str:
    """The band as a closed line in whole pixels."""
    lower, upper = (_heights(values, *between) for values in band)
    across = np.linspace(1, WIDTH - 1, len(lower)).round().astype(int)
    way = [*zip(across, upper, strict=True), *zip(across[::-1], lower[::-1], strict=True)]
    points = "L".join(f"{x} {y}" for x, y in way)
    return f'<path d="M{points}Z" fill="{colour}" fill-opacity=".55" stroke="{colour}"/>'


def _heights(values: NDArray[np.float64], low: float, high: float) -> Whole:
    reach = high - low or 1.0
    return np.asarray((HEIGHT - 2 - (HEIGHT - 4) * (values - low) / reach).round(), dtype=np.int64)
