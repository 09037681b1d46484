"""What the bench's figures of a fitted model are drawn from: the records of its matrix, and the model of the fit."""

from __future__ import annotations

from ident.bench.model import Model
from ident.bench.outputs import model_of
from ident.bench.records import BenchSet, Record, bench_set
from ident.comparison.compare import fitted
from ident.errors import Unusable
from ident.figures.study import Study


def model_and_records(study: Study, what: str, *kinds: str) -> tuple[Model, tuple[Record, ...]]:
    """The fitted model, and the records of these kinds. Raises Unusable where `what` has none to be drawn of."""
    preset, _, values = fitted(study.fit, study.matrix)
    bench: BenchSet = bench_set(study.matrix)
    found = bench.of_kind(*kinds)
    if not found:
        raise Unusable(
            "missing-record",
            f"the {what} cannot be drawn without a record of kind {kinds[0]}",
            "figure",
            f"add a run with kind: {kinds[0]}",
        )
    return model_of(values, bench.supply_pressure, preset), found
