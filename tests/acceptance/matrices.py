"""Matrices from the independent reference, in memory, as the program reads them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from threadpoolctl import threadpool_limits

from ident.matrix import Actuator, Matrix
from ident.run import Run, Specimen
from tests.reference import qian_reference as reference

NOISE = 0.005
SHORT, LONG = 2.0, 30.0  # s of a run, in the two forms of the tests


def as_run(record: reference.Record, hold: str) -> Run:
    """A record of the reference as the program reads it."""
    cell = record.trial.cell
    return Run(
        id=record.trial.id,
        file="",
        sample_rate=reference.SAMPLE_RATE,
        channels={"command": record.command, "displacement": record.displacement},
        units={"command": "m", "displacement": "m"},
        specimen=Specimen(cell.mass, cell.stiffness, cell.damping),
        gain=cell.gain,
        amplitude=record.trial.amplitude,
        kind="blwn",
        hold=hold,
        use=record.trial.use,
    )


def as_matrix(records: Sequence[reference.Record], hold: str) -> Matrix:
    """A matrix of runs on the actuator of the paper."""
    actuator = Actuator(serial="REFERENCE-1", piston_area=reference.Plant().A)
    return Matrix(actuator, tuple(as_run(record, hold) for record in records), data_hash="0" * 64)


@lru_cache(maxsize=2)
def records_of(seconds: float, hold: str, seed: int = 1) -> tuple[reference.Record, ...]:
    """The 63 + 21 runs at Table 4's parameters with 0.5 % noise."""
    plant = reference.Plant()
    with threadpool_limits(1):  # the runs are shared out to the cores: products in threads of their own only wait
        found = reference.measure_all(plant, reference.trials(), seconds=seconds, noise=NOISE, seed=seed, hold=hold)
    return tuple(found)
