"""The model against whole runs, as a comparison shows it: outputs, errors of eq. (17), offsets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ident.bench.model import Model, beyond_fast
from ident.bench.records import Record, bench_set
from ident.bench.speed_table import SpeedTable
from ident.fit.result import RunError
from ident.fit.run_errors import run_error
from ident.matrix import Matrix
from ident.presets import Preset
from ident.resolution import WHITE

Array = NDArray[np.float64]


def model_of(values: Mapping[str, float], supply: float, preset: Preset | None = None) -> Model:
    """The model that has these values by the equations' names, SI, currents in rated currents.

    `preset` says which effects it has; with any beside :data:`ident.bench.model.FAST` its chain is simulated.
    """
    table = SpeedTable.straight(1.0).with_values(values)
    strengths = {name: value for name, value in values.items() if "__" in name}
    chain = beyond_fast(preset.chain) if preset is not None else None
    return Model(values["T"], values["B"], values["I0"], values["kp"], values["dPfr"], table, supply, strengths, chain)


def outputs(preset: Preset, values: Mapping[str, float], matrix: Matrix) -> dict[str, Array]:
    """The position of each bench record's run, from where the record begins.

    A simulator of its own, exact between the corners of play and table: see docs/bench.md for what it saves.
    """
    bench = bench_set(matrix)
    model = model_of(values, bench.supply_pressure, preset)
    return {
        record.id: model.answer(record.current, record.rate, record.hold, float(record.position[0])).position
        for record in bench.records
    }


def errors_of(records: Sequence[Record], model: Model) -> tuple[RunError, ...]:
    """Eq. (17) of each bench record, and its offset."""
    out = []
    for record in records:
        found = model.answer(record.current, record.rate, record.hold, float(record.position[0])).position
        difference, size = record.position - found, float(np.std(record.position))
        error, offset = float(np.std(difference)) / size, float(np.mean(difference)) / size
        out.append(run_error(record, error, offset, size, "m"))
    return tuple(out)


def noise_floor(matrix: Matrix, use: str) -> float | None:
    """The error of eq. (17) that the steps of the converter alone make, mean over the runs of a use."""
    records = [record for record in bench_set(matrix).records if record.use == use]
    shares = [record.resolution / WHITE / float(np.std(record.position)) for record in records]
    return float(np.mean(shares)) if shares else None
