"""What is in a matrix, as plain data for a table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ident.matrix import Matrix
from ident.preprocessing import screen
from ident.run import Run


@dataclass(frozen=True)
class RunSummary:
    """One run: what was set, how long, and the RMS of what moved, without means; SI, or the record's own units."""

    id: str
    file: str
    use: str
    kind: str
    samples: int
    duration: float
    sample_rate: float
    time_unit: str
    hold: str
    gain: float | None
    mass: float | None
    stiffness: float | None
    damping: float | None
    amplitude: float | None
    output: str
    rms: dict[str, float]  # of each channel
    units: dict[str, str]  # of each channel


@dataclass(frozen=True)
class Summary:
    """The whole matrix; `duration` is the sum over runs in s, None where a run's period is unknown."""

    serial: str
    runs: tuple[RunSummary, ...]
    fit_runs: int
    verify_runs: int
    duration: float | None
    gains: tuple[float, ...]
    specimens: int
    data_hash: str
    notices: tuple[str, ...]


def describe(matrix: Matrix) -> Summary:
    """The summary of a matrix, with the runs that a fit takes out of it."""
    matrix = screen(matrix)
    timed = all(run.time_unit == "s" for run in matrix.runs)
    return Summary(
        serial=matrix.actuator.serial,
        runs=tuple(summarize(run) for run in matrix.runs),
        fit_runs=len(matrix.of_use("fit")),
        verify_runs=len(matrix.of_use("verify")),
        duration=sum(run.duration for run in matrix.runs) if timed else None,
        gains=tuple(sorted({run.gain for run in matrix.runs if run.gain is not None})),
        specimens=len({run.specimen for run in matrix.runs if run.specimen is not None}),
        data_hash=matrix.data_hash,
        notices=matrix.notices,
    )


def summarize(run: Run) -> RunSummary:
    """The summary of a run."""
    specimen = run.specimen
    return RunSummary(
        id=run.id,
        file=run.file,
        use=run.use,
        kind=run.kind,
        samples=run.length,
        duration=run.duration,
        sample_rate=run.sample_rate,
        time_unit=run.time_unit,
        hold=run.hold,
        gain=run.gain,
        mass=None if specimen is None else specimen.mass,
        stiffness=None if specimen is None else specimen.stiffness,
        damping=None if specimen is None else specimen.damping,
        amplitude=run.amplitude,
        output=run.output,
        rms={name: float(np.std(samples)) for name, samples in run.channels.items()},
        units=dict(run.units),
    )
