"""What a record must have for an effect to be looked for: where it has not, no data could show the effect."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ident.matrix import Matrix

Need = Callable[[Matrix], bool]
ONE_SIDED = 0.05
"""Of the largest value: what may lie below zero by noise or an offset of a record that stays on one side.

Test: tests/effects/test_needs.py::test_a_record_is_one_sided_up_to_a_twentieth"""

_ELECTRIC = ("V", "A", "N*m", "rad", "rad/s")
"""Units of the command of an electric drive; a voltage is one of a valve, too."""


class Recorded(Protocol):
    """A run, or what is known of one."""

    @property
    def output(self) -> str:
        """The channel that a model must reproduce."""
        ...

    @property
    def units(self) -> Mapping[str, str]:
        """The SI units of the channels."""
        ...


def electric(runs: Iterable[Recorded], oil: bool) -> bool:
    """Whether units show a drive without oil: it turns, in rad or rad/s, or is a temperature, and nothing shows oil.

    `oil` is whether parts of a machine with oil are stated (:attr:`ident.matrix.Actuator.states_oil`). Unknown units
    (``1``) exclude nothing.
    """
    runs = tuple(runs)
    return not shows_oil(runs, oil) and all(
        run.units.get("command") == "K"
        or (run.units.get(run.output) in ("rad", "rad/s") and run.units.get("command") in _ELECTRIC)
        for run in runs
    )


def shows_oil(runs: Iterable[Recorded], stated: bool) -> bool:
    """Whether parts of a machine with oil are `stated`, or a run records a pressure."""
    return stated or any("Pa" in run.units.values() for run in runs)


def angle_measured(matrix: Matrix) -> bool:
    """Whether the position of every run is an angle, or a number, as a radian is: a length is no part of a turn."""
    return all(run.units.get("displacement") in ("rad", "1") and "displacement" in run.channels for run in matrix.runs)


def position_driven(matrix: Matrix) -> bool:
    """Whether a position is to be reproduced of every run, and its command is no position: no loop returns the mass, so
    a spring may. Of a speed alone nothing tells the place of rest."""
    return all(
        run.output == "displacement" and run.units.get("command", "m") not in ("m", "rad") for run in matrix.runs
    )


def force_answers(matrix: Matrix) -> bool:
    """Whether every run gives the motion and records the force: what is tested is moved, such as a damper."""
    return all(run.output == "force" for run in matrix.runs)


def one_force_record(matrix: Matrix) -> bool:
    """Whether one run alone is fitted, whose force answers its motion: what it has dissipated grows from its begin on.

    Of several runs each would have a damage of its own, found from its data, which is a strength of its own.
    """
    return force_answers(matrix) and len(matrix.of_use("fit")) == 1


def one_sided_position(matrix: Matrix) -> bool:
    """Whether a measured position, such as a level, stays on one side of zero: about zero a curve bends nothing."""
    return all(run.output == "displacement" and one_sided(run.measured) for run in matrix.runs)


def one_sided_answer(matrix: Matrix) -> bool:
    """Whether what answers stays on one side of zero: a position, or a force, a pressure or a current that a command
    sets, such as the thrust of a propeller."""
    set_by_command = ("force", "load_pressure", "current")
    return all(
        (run.output == "displacement" or ("command" in run.channels and run.output in set_by_command))
        and one_sided(run.measured)
        for run in matrix.runs
    )


def one_sided_command(matrix: Matrix) -> bool:
    """Whether the command stays on one side of zero: what drives then pushes and lets go, and never pulls."""
    return all("command" in run.channels and one_sided(run.command) for run in matrix.runs)


def force_commanded(matrix: Matrix) -> bool:
    """Whether the command of every run is the force of a drive, by its unit, and its motion is measured."""
    return all(run.units.get("command") in ("N", "N*m") and run.output != "force" for run in matrix.runs)


def speed_measured(matrix: Matrix) -> bool:
    """Whether a speed was recorded of every run, by a sensor of its own."""
    return all(run.output == "velocity" for run in matrix.runs)


def no_speed(matrix: Matrix) -> bool:
    """Whether no speed is to be reproduced: what slows it more than in proportion is the damping of a mass."""
    return all(run.output != "velocity" for run in matrix.runs)


def turns_round(matrix: Matrix) -> bool:
    """Whether speeds of rotation alone are recorded, one of which adds up to more than a turn within its run.

    What turns round comes to no end of a way, and nothing tells the place at which it began.
    """
    speeds = [run for run in matrix.runs if run.output == "velocity" and "displacement" not in run.channels]
    turning = len(speeds) == len(matrix.runs) and all(run.units.get("velocity") == "rad/s" for run in speeds)
    return turning and any(np.ptp(np.cumsum(run.measured)) > 2.0 * np.pi * run.sample_rate for run in speeds)


def one_sided(samples: NDArray[np.float64]) -> bool:
    """Whether samples stay on one side of zero."""
    lowest, highest = float(samples.min()), float(samples.max())
    return min(highest, -lowest) <= ONE_SIDED * max(highest, -lowest)
