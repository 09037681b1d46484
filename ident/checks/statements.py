"""What the description leaves open, and what follows for a fit."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.matrix import Matrix
from ident.run import BENCH, Run
from ident.words.listed import first_of

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
            "piston_area is not stated: only the ratios Z0/A^2, Ka/A^2 and Cl/A^2 can be determined; state it to get "
            "the parameters themselves",
        )
    yield from unstated(
        hydraulic, "gain", "no-gain", "Kp = 1 is taken, so that Z0 means Z0 times Kp; state the gain that was set"
    )
    yield from unstated(
        runs,
        "specimen",
        "no-specimen",
        "its mass, stiffness and damping count as the actuator's own, and m0, c0 mean totals; state the specimen",
    )
    conditions = {(run.specimen, run.gain) for run in matrix.of_use("fit")}
    if len(conditions) == 1 and hydraulic:
        yield note(
            "one-condition",
            "all fit runs have one specimen and one gain: some parameters will be determined in combination only; "
            "measure further specimens and gains",
        )


def uses(matrix: Matrix) -> Iterator[Finding]:
    """Runs to fit, runs to verify, and whether the second are like the first."""
    fit, verify = matrix.of_use("fit"), matrix.of_use("verify")
    if not fit:
        text = "every run is kept for verification and none is left to fit; set use: fit on some"
        yield Finding(None, "fault", "no-fit-runs", text)
    if not verify:
        text = (
            "no run is kept for verification, so a fit cannot be judged on data that it has not seen; set use: verify"
        )
        yield Finding(None, "doubt", "no-verify-runs", text)
    gains = [run.gain for run in fit if run.gain is not None]
    for run in verify:
        if gains and run.gain is not None and not min(gains) <= run.gain <= max(gains):
            text = (
                f"run {run.id} verifies at Kp = {run.gain:g}, outside the {min(gains):g} to {max(gains):g} of the fit: "
                "its error includes an extrapolation"
            )
            yield Finding(run.id, "note", "extrapolation", text)


def unstated(runs: list[Run], name: str, code: str, follows: str) -> Iterator[Finding]:
    """A note where runs do not state something: once, however many they are."""
    without = [run.id for run in runs if getattr(run, name) is None]
    if without:
        yield note(code, f"{name} is not stated for {first_of(without)}: {follows}")


def note(code: str, text: str) -> Finding:
    """A note on the matrix."""
    return Finding(None, "note", code, text)
