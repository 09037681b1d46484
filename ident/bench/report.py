"""An analysis as plain JSON data."""

from __future__ import annotations

import math
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

from ident.bench.acceptance import Line, passed
from ident.bench.analysis import Analysis
from ident.bench.model import Model
from ident.bench.records import BenchSet
from ident.bench.speed import Speed
from ident.bench.static import Static
from ident.matrix import Matrix


def to_json(matrix: Matrix, bench: BenchSet, analysis: Analysis, lines: tuple[Line, ...]) -> dict[str, Any]:
    """Everything found, SI, currents in rated currents ("1"); `passed` is false where a limit is broken."""
    whole = analysis.whole
    return {
        "actuator": asdict(matrix.actuator),
        "rated_current": {"value": bench.rated, "unit": bench.unit},
        "static": None if analysis.static is None else _static(analysis.static),
        "by_range": [_static(each) for each in analysis.by_range],
        "frequency": [asdict(response) for response in analysis.frequency],
        "dynamics": None if analysis.dynamics is None else asdict(analysis.dynamics),
        "delay": None if analysis.delay is None else asdict(analysis.delay),
        "speed": None if analysis.speed is None else _speed(analysis.speed),
        "model": None
        if whole is None
        else _model(whole.model) | {"deviations": whole.deviations, "correlation": whole.correlation},
        "step_by_step": None if analysis.steps is None else _model(analysis.steps),
        "position_error": {"model": analysis.errors, "step_by_step": analysis.step_errors},
        "sheet": [asdict(line) | {"passed": line.passed} for line in lines],
        "passed": passed(lines),
        "missing": [asdict(each) | {"text": each.text} for each in analysis.missing],
        "notes": list(analysis.notes),
        "seconds": analysis.seconds,
        "version": version("servoident"),
        "data_hash": matrix.data_hash,
    }


def _static(found: Static) -> dict[str, Any]:
    names = ("zero_shift", "dead_space", "slope", "friction", "hysteresis")
    values = {name: asdict(getattr(found, name)) for name in names}
    return values | {"position_range": found.position_range, "records": list(found.records)}


def _speed(found: Speed) -> dict[str, Any]:
    return {
        "straightness": asdict(found.straightness),
        "levels": [asdict(level) for level in found.levels],
        "bezier": {"heights": list(found.bezier), "ends": list(found.bezier_ends)},
        "table": {
            "currents": list(found.table.fractions),
            "forward": list(map(float, found.table.forward)),
            "back": list(map(float, found.table.back)),
            "interpolation": found.table.kind,
        },
        "deviations": found.deviations,
    }


def _model(model: Model) -> dict[str, Any]:
    supply = model.Ps if math.isfinite(model.Ps) else None
    return {"values": model.values(), "dead_space": model.dead_space, "supply_pressure": supply}
