"""The centre of the stroke, which effects act about: of the way that a machine that integrates its command covered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ident.chain.chain import Chain, integrates
from ident.matrix import Matrix
from ident.preprocessing.step import Prepared, Step, Threshold
from ident.run import Run
from ident.words.engineering import with_unit

AT_END = Threshold(
    0.01,
    "of the way that was covered",
    "a position that near to the end of the way is at the end",
    "ten times the noise of a usual position transducer, and too narrow to hold a motion that goes on",
)
PUSHED = Threshold(
    0.1,
    "of the largest command",
    "a command of that size towards the end drives the machine on against it",
    "below it a dead zone or dry friction may hold the machine, and no stop",
)
RESTS = Threshold(
    10.0,
    "times the time in which the machine covers its end zone at its typical speed",
    "a machine that is driven on and stays that much longer stands against a stop",
    "turning back takes some such times; ten leave no doubt",
)


def middle_of(matrix: Matrix, chain: Chain) -> float:
    """The middle of the displacements of the runs to fit, m; 0 where they cover the zero of the transducer.

    A machine that is held in a loop has its zero where that is set. A cylinder in open loop goes to its ends, and the
    transducer counts from wherever it was mounted: where it was driven against both of them they tell the middle.
    """
    runs = [run for run in matrix.of_use("fit") if "displacement" in run.channels]
    if not runs or not integrates(chain, matrix.runs, matrix.actuator):
        return 0.0
    places = [run.channels["displacement"] for run in runs]
    low, high = float(min(map(np.min, places))), float(max(map(np.max, places)))
    covered = low <= 0.0 <= high
    return 0.0 if covered and not _driven_against_both(runs, low, high) else (low + high) / 2.0


def _driven_against_both(runs: Sequence[Run], low: float, high: float) -> bool:
    """Whether a machine was driven on at both ends of the way it covered, and stood longer than it takes to pass."""
    places, commands = ([run.channels[name] for run in runs] for name in ("displacement", "command"))
    speeds = [np.gradient(x) * run.sample_rate for x, run in zip(places, runs, strict=True)]
    gain = np.sign(sum(float(u @ v) / run.sample_rate for u, v, run in zip(commands, speeds, runs, strict=True)))
    least = PUSHED.value * max(float(np.abs(u).max()) for u in commands)
    typical = np.sqrt(
        np.mean(np.concatenate([v[np.abs(u) > least] for u, v in zip(commands, speeds, strict=True)]) ** 2)
    )
    near = AT_END.value * (high - low)
    stood = [
        max(
            np.sum((np.abs(x - end) < near) & (outwards * gain * u > least)) / run.sample_rate
            for x, u, run in zip(places, commands, runs, strict=True)
        )
        for end, outwards in ((low, -1.0), (high, 1.0))
    ]
    return bool(min(stood) * typical > RESTS.value * near)


def _act(prepared: Prepared) -> tuple[Prepared, tuple[str, ...]]:
    """Put the effects of the model about the centre of the stroke."""
    preset, matrix = prepared.model, prepared.matrix
    if preset.kind != "chain" or preset.data.driven_by != "command":
        return prepared, ()
    middle = middle_of(matrix, preset.core)
    # The effects that the model has are put about the new middle with it.
    prepared = replace(prepared, preset=replace(preset, middle=middle).with_effects(preset.effects))
    if not middle:
        return prepared, ()
    unit = next(run.units.get("displacement", "1") for run in matrix.runs if "displacement" in run.channels)
    said = (
        f"Effects of position use {with_unit(f'{middle:.4g}', unit)} as origin, the centre of the recorded stroke: the "
        "zero of the transducer is elsewhere."
    )
    return prepared, (said,)


STROKE_CENTRE = Step(
    name="stroke_centre",
    does="puts effects of position, such as end stops, about the centre of the stroke",
    applies="a machine in open loop integrates its command, and its position does not cover the transducer's zero, or "
    "it was driven against both ends",
    without="effects of position act about the zero of the transducer",
    thresholds=(AT_END, PUSHED, RESTS),
    act=_act,
    noted=False,
)
