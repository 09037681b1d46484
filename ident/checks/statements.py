"""What the description leaves open, and what follows for a fit."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.presets import Preset
from ident.presets.suitable_models import in_question, moved_by_command
from ident.run import BENCH
from ident.words.message import Message, message

FEWEST = 100  # samples to fit: ten for each of the six parameters and four initial states of a position loop
_NO_CYLINDER = ("rad", "rad/s", "N*m", "1")  # units of an output of what turns, and of one in unknown units


def statements(matrix: Matrix) -> Iterator[Finding]:
    """Uses, and everything optional that a fit of the models in question would want."""
    yield from uses(matrix)
    known = [run for run in matrix.runs if run.kind not in BENCH]  # a bench has neither gain nor specimen
    # Without physical units nothing is to be had; what turns, or a temperature drives, is no cylinder; what is moved is
    # the specimen itself.
    runs = [
        run
        for run in known
        if {"command", "drive_force"} & run.channels.keys()
        and run.units.get("command") not in ("1", "K")
        and run.units.get(run.output) not in _NO_CYLINDER
        and run.output not in ("temperature", "current")
    ]
    hydraulic = [run for run in runs if "drive_force" not in run.channels]
    if not runs or specimen_is_moved(matrix):
        return
    models = _in_question(matrix)
    ratios = next((model.without_area for model in models if model.without_area), {})
    if hydraulic and ratios and matrix.actuator.piston_area is None:
        yield note("no-piston-area", message("check.no_piston_area", ratios=[ratio for ratio, _ in ratios.values()]))
    without = [run.id for run in hydraulic if run.gain is None]
    if without and any(model.chain.reads("Kp") for model in models):
        yield note("no-gain", message("check.no_gain", runs=without))
    if without := [run.id for run in runs if run.specimen is None]:
        yield note("no-specimen", message("check.no_specimen", runs=without))
    conditions = {(run.specimen, run.gain) for run in matrix.of_use("fit")}
    if len(conditions) == 1 and hydraulic:
        yield note("one-condition", message("check.one_condition"))


def specimen_is_moved(matrix: Matrix) -> bool:
    """Whether the command of every record is the motion of a specimen: nothing drives a machine there."""
    runs = [run for run in matrix.runs if "command" in run.channels]
    return len(runs) == len(matrix.runs) and any(moved_by_command(model, runs) for model in _in_question(matrix))


def _in_question(matrix: Matrix) -> tuple[Preset, ...]:
    """The models that a fit would compare; none where no model has such inputs and outputs."""
    try:
        return in_question(matrix.runs, matrix.machine, matrix.actuator.states_oil)
    except Unusable:
        return ()


def uses(matrix: Matrix) -> Iterator[Finding]:
    """Estimation data, validation data, and whether the second are like the first."""
    fit, verify = matrix.of_use("fit"), matrix.of_use("verify")
    if not fit:
        yield Finding.of(None, "fault", "no-fit-runs", message("check.no_fit_runs"))
    if not verify:
        yield Finding.of(None, "doubt", "no-verify-runs", message("check.no_verify_runs"))
    records = [run for run in fit if run.kind not in BENCH]
    if records and (samples := sum(run.length for run in records)) < FEWEST:
        yield Finding.of(None, "doubt", "few-samples", message("check.too_short", samples=samples, least=FEWEST))
    gains = [run.gain for run in fit if run.gain is not None]
    for run in verify:
        if gains and run.gain is not None and not min(gains) <= run.gain <= max(gains):
            values = {"run": run.id, "gain": run.gain, "lowest": min(gains), "highest": max(gains)}
            yield Finding.of(run.id, "note", "extrapolation", message("check.extrapolation", **values))


def note(code: str, said: Message) -> Finding:
    """A note on the matrix."""
    return Finding.of(None, "note", code, said)
