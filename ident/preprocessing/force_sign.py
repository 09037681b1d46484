"""Force and motion have one sign: a specimen that is moved takes work, and a mass goes where a force drives it."""

from __future__ import annotations

from dataclasses import replace

from ident.preprocessing.motion_sign import BALANCED, FOLLOWED, TOLD, a_motor_is_against, against_its_drive, drives_mass
from ident.preprocessing.power import GIVES_BACK, mean_power, product
from ident.preprocessing.step import Prepared, Step
from ident.run import MOTIONS, Run


def work(run: Run) -> float | None:
    """mean(F v) over the product of the sizes, −1 … 1; None where the run has no force and motion of its own.

    The larger of that as recorded and that without the means: a force that is not zeroed does work only where the
    motion goes one way, and a specimen that is moved one way takes its work by the means.
    """
    if run.output != "force" or "force" not in run.channels or run.channels.keys().isdisjoint(MOTIONS):
        return None
    recorded = run.channels["force"], run.driven_by("velocity").command
    return max(product(*recorded), mean_power(*recorded))


def gives_work_back(run: Run) -> bool:
    """Whether a moved specimen would have to drive what moves it."""
    found = work(run)
    return found is not None and found < GIVES_BACK.value


def _act(prepared: Prepared) -> tuple[Prepared, tuple[str, ...]]:
    """Turn the sign of the force in every run in which the specimen would give work back; of a mass that a force
    drives, that of the motion where all runs to fit say that it is counted the other way."""
    matrix = prepared.matrix
    if drives_mass(prepared.model):
        return _motion_turned(prepared)
    wrong = [run for run in matrix.runs if gives_work_back(run)] if prepared.model.data.driven_by in MOTIONS else []
    if not wrong:
        return prepared, ()
    ids = ", ".join(run.id for run in wrong)
    worst = max(work(run) or 0.0 for run in wrong)
    said = (
        f"The force of {ids} is taken with the other sign: as recorded, force times speed is {worst:.2f} of their "
        f"deviations in the mean, but a passive specimen cannot produce work."
    )
    runs = tuple(run.turned("force") if run in wrong else run for run in matrix.runs)
    return replace(prepared, matrix=replace(matrix, runs=runs)), (said,)


def _motion_turned(prepared: Prepared) -> tuple[Prepared, tuple[str, ...]]:
    matrix = prepared.matrix
    runs = matrix.of_use("fit") or matrix.runs
    told = [against for run in runs if (against := against_its_drive(run)) is not None]
    is_against = all(told) if told else a_motor_is_against(runs)
    if not is_against:
        return prepared, ()
    said = (
        f"The {matrix.runs[0].output} is taken with the other sign: as recorded it goes against the force that drives "
        f"it. Mass, damper and spring go with it."
    )
    return replace(prepared, matrix=replace(matrix, runs=tuple(run.turned(run.output) for run in matrix.runs))), (said,)


FORCE_SIGN = Step(
    name="force_sign",
    does="turns the sign of the force of a run, or of the motion that a force drives",
    applies="a motion drives the model, a run records force and speed, and their product says that the specimen gives "
    "work back; or a force, a pressure, a torque or a motor drives a mass in open loop, and every estimation run says "
    "that the motion is counted against it; or none of them says anything, and only a motor of negative gain explains "
    "them",
    without="force and motion are taken with the sign that was recorded",
    thresholds=(GIVES_BACK, BALANCED, FOLLOWED, TOLD),
    act=_act,
)
