"""The model against whole runs, as a comparison shows it: outputs, errors of eq. (17), offsets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ident.bench.model import Model
from ident.bench.records import Record, bench_set
from ident.bench.speed_table import SpeedTable
from ident.fit.result import RunError
from ident.matrix import Matrix
from ident.presets import Preset

Array = NDArray[np.float64]


def model_of(values: Mapping[str, float], supply: float) -> Model:
    """The model that has these values, SI, currents in rated currents."""
    table = SpeedTable.straight(1.0).with_values(values)
    return Model(values["T"], values["B"], values["I0"], values["kp"], values["dPfr"], table, supply)


def outputs(_preset: Preset, values: Mapping[str, float], matrix: Matrix) -> dict[str, Array]:
    """The position of each bench record's run, from where the record begins; the model's equations are all one's own.

    A simulator of its own, exact between the corners of play and table: see docs/bench.md for what it saves.
    """
    bench = bench_set(matrix)
    model = model_of(values, bench.supply_pressure)
    return {
        record.id: model.answer(record.current, record.rate, record.hold, float(record.position[0])).position
        for record in bench.records
    }


def run_errors(matrix: Matrix, values: Mapping[str, float]) -> tuple[RunError, ...]:
    """Eq. (17) of each bench record's run, and its offset."""
    bench = bench_set(matrix)
    return errors_of(bench.records, model_of(values, bench.supply_pressure))


def errors_of(records: Sequence[Record], model: Model) -> tuple[RunError, ...]:
    """The same of a model, whatever it has beside the four blocks."""
    out = []
    for record in records:
        found = model.answer(record.current, record.rate, record.hold, float(record.position[0])).position
        difference, size = record.position - found, float(np.std(record.position))
        error, offset = float(np.std(difference)) / size, float(np.mean(difference)) / size
        out.append(RunError(record.id, record.use, min(error, 1e3), float(np.clip(offset, -1e3, 1e3))))
    return tuple(out)


def noise_floor(matrix: Matrix, use: str) -> float | None:
    """What the steps of the converter alone leave of eq. (17), mean over the runs of a use."""
    records = [record for record in bench_set(matrix).records if record.use == use]
    shares = [record.resolution / np.sqrt(12.0) / float(np.std(record.position)) for record in records]
    return float(np.mean(shares)) if shares else None
