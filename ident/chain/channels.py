"""Channels of a run that the equations of an effect read by name: what one is beside its mean is an input."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable
from weakref import WeakKeyDictionary

import numpy as np

from ident.equations.equation import Equation
from ident.errors import Unusable
from ident.run import CHANNELS, Run
from ident.words.run_name import run_name

_MOTION = ("command", "displacement", "velocity", "acceleration")  # a model has its own
READABLE = tuple(channel for channel in CHANNELS if channel not in _MOTION)
"""What an effect may read of a record, each under its channel's name, in SI; the name alone stands for the mean."""
BESIDE_MEAN = {f"d{channel}": channel for channel in READABLE}
"""The inputs of a chain that are the rest of these channels."""
_means: WeakKeyDictionary[Run, dict[str, float]] = WeakKeyDictionary()


def means(run: Run) -> dict[str, float]:
    """The mean of every readable channel of a run, 0 of one that it has not."""
    if run not in _means:
        _means[run] = {c: float(np.mean(run.channels[c])) if c in run.channels else 0.0 for c in READABLE}
    return _means[run]


def read_whole(equation: Equation, known: Collection[str]) -> Equation:
    """The equation of an effect, with the channels that it names followed sample by sample; `known` are other names."""
    named = [channel for channel in READABLE if channel in equation.names and channel not in known]
    return equation.with_values(
        {c: ast.BinOp(ast.Name(c, ast.Load()), ast.Add(), ast.Name(f"d{c}", ast.Load())) for c in named}
    )


def unmeasured(symbols: Iterable[str], runs: Iterable[Run]) -> tuple[str, str, str] | None:
    """The first channel among symbols that a run cannot give, that run, and why; None where there is none."""
    read = [channel for channel in READABLE if channel in set(symbols)]
    for run in runs:
        for channel in read:
            if channel not in run.channels:
                return channel, run.id, f"no {channel} channel, which an effect of the model reads"
            if run.output == channel:
                return channel, run.id, f"{channel} is what the model has to show: no effect can read it"
    return None


def refuse_unmeasured(symbols: Iterable[str], runs: Iterable[Run]) -> None:
    """Raise Unusable where an effect reads a channel that a run cannot give."""
    if found := unmeasured(symbols, runs):
        channel, run, what = found
        remedy = f"give the run its {channel}, leave the run out, or fit without the effect"
        raise Unusable("missing-channel", what, run_name(run), remedy)
