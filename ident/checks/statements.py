"""What the description leaves open, and what follows for a fit."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.matrix import Matrix
from ident.run import BENCH, Run
from ident.words.listed import first_of
from ident.words.run_name import run_name

_TURNING = ("rad", "rad/s", "N*m")  # units of an output


def statements(matrix: Matrix) -> Iterator[Finding]:
    """Uses, and everything optional that a fit of the hydraulic chain would want."""
    yield from uses(matrix)
    known = [run for run in matrix.runs if run.kind not in BENCH]  # a bench has neither gain nor specimen
    # Without physical units nothing is to be had; what turns is no cylinder, and what is moved is the specimen itself.
    runs = [
        run
        for run in known
        if {"command", "drive_force"} & run.channels.keys()
        and run.units.get("command") != "1"
        and run.units.get(run.output) not in _TURNING
    ]
    hydraulic = [run for run in runs if "drive_force" not in run.channels]
    if hydraulic and matrix.actuator.piston_area is None:
        yield note(
            "no-piston-area",
            "piston_area is not given: only the ratios Z0/A^2, Ka/A^2 and Cl/A^2 are identifiable. State it to get "
            "the parameters themselves",
        )
    yield from unstated(hydraulic, "gain", "no-gain", "Kp = 1 is assumed, so Z0 means Z0 times Kp. State the gain")
    yield from unstated(
        runs,
        "specimen",
        "no-specimen",
        "its mass, stiffness and damping are included in m0 and c0. State the specimen",
    )
    conditions = {(run.specimen, run.gain) for run in matrix.of_use("fit")}
    if len(conditions) == 1 and hydraulic:
        yield note(
            "one-condition",
            "all estimation runs have the same specimen and gain: some parameters will be identifiable only in "
            "combination. Measure other specimens and gains",
        )


def uses(matrix: Matrix) -> Iterator[Finding]:
    """Runs to fit, runs to verify, and whether the second are like the first."""
    fit, verify = matrix.of_use("fit"), matrix.of_use("verify")
    if not fit:
        text = "every run is validation data, and none is left to fit. Set use: fit on some runs"
        yield Finding(None, "fault", "no-fit-runs", text)
    if not verify:
        text = "there are no validation data, so a fit cannot be judged on data that it has not used. Set use: verify"
        yield Finding(None, "doubt", "no-verify-runs", text)
    gains = [run.gain for run in fit if run.gain is not None]
    for run in verify:
        if gains and run.gain is not None and not min(gains) <= run.gain <= max(gains):
            text = (
                f"{run_name(run.id)} is validation data at Kp = {run.gain:g}, outside the {min(gains):g} to "
                f"{max(gains):g} of the estimation data. Its error includes an extrapolation"
            )
            yield Finding(run.id, "note", "extrapolation", text)


def unstated(runs: list[Run], name: str, code: str, follows: str) -> Iterator[Finding]:
    """A note where runs do not state something: once, however many they are."""
    without = [run.id for run in runs if getattr(run, name) is None]
    if without:
        yield note(code, f"{name} is not given for {first_of(without)}: {follows}")


def note(code: str, text: str) -> Finding:
    """A note on the matrix."""
    return Finding(None, "note", code, text)
