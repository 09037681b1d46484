"""The offset of a command: what it is held at while a machine that integrates it stands still."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.chain.chain import integrates
from ident.preprocessing.step import Prepared, Step, Threshold
from ident.words.engineering import with_unit

FELT = Threshold(
    1e-3,
    "of the largest run's standard deviation of the command",
    "an offset that is larger is taken off",
    "a smaller one moves the machine by less than its records tell, and taking it off would be a notice about nothing",
)


def _act(prepared: Prepared) -> tuple[Prepared, tuple[str, ...]]:
    """Count commands from their neutral, where the chain integrates them, or where they are pulse widths.

    A pulse of 1 ms stops the motor of a drone, and one of 1.5 ms holds a servo in its middle: none has its zero at 0 s.
    A null bias, a dead zone that is not in the middle and a recorder's zero are one thing there, and any of them makes
    the model run away. One machine has one neutral: the middle one of the runs to fit that show it. Where friction or a
    dead zone holds the machine at commands of either sign, none of them is its neutral.
    """
    matrix, preset = prepared.matrix, prepared.model
    if preset.kind != "chain" or preset.data.driven_by != "command":
        return prepared, ()
    shown = [run.command[0] for run in matrix.of_use("fit") or matrix.runs if run.stands]
    neutral = float(np.median(shown)) if shown else 0.0
    felt = neutral and abs(neutral) > FELT.value * max(run.drive for run in matrix.runs)
    pulses = {run.units.get("command") for run in matrix.runs} == {"s"}
    if not felt or not (pulses or integrates(preset.core, matrix.runs, matrix.actuator)):
        return prepared, ()
    if any(level * neutral <= 0 for run in matrix.of_use("fit") for level in run.held_still(neutral)):
        return prepared, ()
    text = with_unit(f"{neutral:.4g}", matrix.runs[0].units.get("command", "1"))
    why = "a pulse width has its zero there" if pulses else "that is the neutral of a machine that integrates it"
    said = f"The command is counted from {text}, at which it is held first while the output stands: {why}."
    runs = tuple(replace(run, channels={**run.channels, "command": run.command - neutral}) for run in matrix.runs)
    return replace(prepared, matrix=replace(matrix, runs=runs)), (said,)


COMMAND_OFFSET = Step(
    name="command_offset",
    does="counts the command from the value at which the machine stands still",
    applies="a machine in open loop integrates its command, or the command is a pulse width, and the estimation runs "
    "begin with a command that is held while the output stands",
    without="the command is taken as it was recorded",
    thresholds=(FELT,),
    act=_act,
)
