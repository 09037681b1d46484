"""The mean or the straight line that a run is asked to leave out of its signals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ident.errors import Unusable
from ident.run import Run, Samples
from ident.words.run_name import run_name

TRENDS = ("none", "mean", "line")
ABSOLUTE = ("pressure_a", "pressure_b", "supply_pressure", "vertical_load", "temperature")
"""Channels whose level is physics: a valve's flow follows from the pressures themselves. They keep it."""
LEFT = 1e-12
"""Share of the largest sample below which a signal without its trend is rounding; see test_trend.py."""


def without_trend(run: Run, trend: str, outputs: Sequence[str]) -> Run:
    """The run with x(k) - a - b k in place of x(k), k = 0 … n - 1, in every channel but the absolute ones.

    a is the mean and b is 0 for "mean"; both are those of least squares for "line". The command before the first
    sample, k < 0, loses the same line. Raises Unusable ``nothing-left`` where the command or an output is only that.
    """
    if trend == "none":
        return run
    degree = TRENDS.index(trend) - 1
    lines = {name: _line(samples, degree) for name, samples in run.channels.items() if name not in ABSOLUTE}
    k = np.arange(run.length, dtype=np.float64)
    channels = {
        name: samples - np.polyval(lines[name], k) if name in lines else samples
        for name, samples in run.channels.items()
    }
    for name in {"command", *outputs} & lines.keys():
        if float(np.ptp(channels[name])) <= LEFT * float(np.abs(run.channels[name]).max()):
            where = f"{run_name(run.id)} trend"
            what = f"nothing is left of the channel {name} without its {trend}"
            raise Unusable("nothing-left", what, where, "write trend: none")
    past = run.past
    if past is not None:
        past = past - np.polyval(lines["command"], np.arange(-len(past), 0, dtype=np.float64))
    return replace(run, channels=channels, past=past)


def _line(samples: Samples, degree: int) -> Samples:
    """The coefficients of the mean or the line of least squares over the sample number, the highest power first."""
    if degree == 0:
        return np.array([samples.mean()])
    k = np.arange(len(samples)) - 0.5 * (len(samples) - 1)
    slope = float(k @ samples / (k @ k))
    return np.array([slope, float(samples.mean()) + slope * float(k[0])])
