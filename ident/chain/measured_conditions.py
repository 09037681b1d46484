"""Conditions of a run that were measured sample by sample: a chain reads their deviation from the mean, too."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

from ident.chain.chain import SUPPLY, VERTICAL, Chain
from ident.run import Run
from ident.stages import Stage

MEASURED_CONDITIONS = {"Ps": (SUPPLY, "supply_pressure", "Pa"), "Nv": (VERTICAL, "vertical_load", "N")}
"""The condition, which is the mean, with the input that is the rest of it, the channel, and its unit."""


def with_measured_conditions(chain: Chain, runs: Iterable[Run]) -> Chain:
    """The chain with every condition that some run measured followed sample by sample; other runs hold theirs."""
    runs = tuple(runs)
    for condition, (beside, channel, unit) in MEASURED_CONDITIONS.items():
        if chain.reads(condition) and any(is_measured(run, channel, unit) for run in runs):
            chain = replace(chain, stages=tuple(_read(condition, beside, chain)))
    return chain


def is_measured(run: Run, channel: str, unit: str) -> bool:
    """Whether a run has a channel in its unit."""
    return channel in run.channels and run.units.get(channel) == unit


def _read(condition: str, beside: str, chain: Chain) -> Iterator[Stage]:
    for stage in chain.stages:
        texts = [
            (re.sub(rf"\b{condition}\b", f"({condition} + {beside})", one.text), one.meaning)
            for one in stage.equations
            if condition in one.names
        ]
        yield stage.with_equations(*texts) if texts else stage
