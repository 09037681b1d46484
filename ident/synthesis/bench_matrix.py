"""A simulated set of bench records on disk: the middle actuator of Kononykhin's paper under the bench's own laws."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from ident.bench.model import Model
from ident.bench.outputs import model_of
from ident.presets import Preset
from ident.progress import Progress, Report, silent
from ident.synthesis.bench_laws import CONTINUOUS, FREQUENCY, LEVELS, STATIC, driven

Array = NDArray[np.float64]
RATE = 1000.0  # Hz
STROKE = 0.1  # m
SUPPLY = 21e6  # Pa
BITS = 12
PRESSURE_NOISE = 40.0  # Pa RMS of each gauge for a noise of 1e-6: 0.2 MPa for the default 0.5 %
FREQUENCIES = (0.2, 0.5, 1.0, 2.0, 5.0)  # Hz
AMPLITUDES = (0.02, 0.1, 0.5)  # rated currents
LEVEL_CURRENTS = (0.03, 0.06, 0.12, 0.25, 0.5, 0.75, 1.0)
RANGES = ((0.015, 0.025), (0.045, 0.055), (0.075, 0.085))  # m
_PERIODS = 5
STEEPEST = 20.0  # rated currents a second
_TRAVEL = 0.06  # m at a fixed level
_BEYOND = 1.5  # times the dead space is the smallest current that is asked for

LIMITS = {
    "zero_shift": {"min": "-2 %", "max": "2 %"},
    "dead_space": {"max": "0.6 %"},
    "hysteresis": {"max": "0.4 %"},
    "friction": {"max": "1 MPa"},
    "T": {"max": "35 ms"},
    "nonlinearity": {"max": "10 %"},
    "asymmetry": {"min": "-15 %", "max": "15 %"},
    "position_error": {"max": "3 %"},
}
"""An acceptance test for the middle actuator, as an example of a limits file."""


@dataclass(frozen=True)
class Plan:
    """One record: kind, law with its settings, length (s), start (m), and what is stated about it."""

    id: str
    kind: str
    law: int
    settings: tuple[float, ...]
    seconds: float
    start: float
    labels: dict[str, Any]


def plans(gain: float, stroke: float = STROKE, offset: float = 0.0, dead_space: float = 0.0) -> Iterator[Plan]:
    """A full set for an actuator of a gain (m/s at rated current) and a stroke (m).

    `offset` is the zero shift and `dead_space` the half-width in which it stands, as far as they are known, in rated
    currents: the laws work about the first, and no amplitude or level is within 1.5 times the second.
    """
    lowest, part = _BEYOND * dead_space, stroke / STROKE
    for low, high in ((part * low, part * high) for low, high in RANGES):
        middle = 0.5 * (low + high)
        labels: dict[str, Any] = {"position_range": [f"{1e3 * low:g} mm", f"{1e3 * high:g} mm"]}
        # 1 % of current a mm, 0.25 mm/s, ±1.5 mm: the current crosses the dead space at 0.25 %/s
        yield Plan(f"static-{1e3 * middle:.0f}", "static", STATIC, (offset, 10.0, 2.5e-4, 1.5e-3), 48.0, middle, labels)
    for amplitude in _from(lowest, AMPLITUDES):
        for frequency in FREQUENCIES:
            swing = amplitude * gain / (2 * np.pi * frequency)
            labels = {"frequency": f"{frequency:g} Hz", "amplitude": f"{100 * amplitude:g} %"}
            settings = (offset, amplitude, frequency, 0.8 * frequency / gain)
            name = f"sine-{100 * amplitude:g}-{frequency:g}".replace(".", "_")
            yield Plan(name, "frequency", FREQUENCY, settings, _PERIODS / frequency, 0.5 * stroke - swing, labels)
    for level in _from(lowest, LEVEL_CURRENTS):
        length = min(3.0, part * _TRAVEL / (1.25 * gain * level))
        settings = (offset, level, length, 0.3)
        name = f"level-{100 * level:g}".replace(".", "_")
        yield Plan(name, "speed-levels", LEVELS, settings, 2 * (length + 0.3), 0.2 * stroke, {})
    settings = (offset, max(LEVEL_CURRENTS[0], lowest), 1.0, 0.9 * stroke)
    yield Plan("stroke", "speed-continuous", CONTINUOUS, settings, 1.2 * part / gain, 0.05 * stroke, {})


def _from(lowest: float, currents: tuple[float, ...]) -> tuple[float, ...]:
    """These currents where they are above the lowest that moves the actuator; what is below becomes that one."""
    above = tuple(current for current in currents if current > lowest)
    return above if len(above) == len(currents) else (float(f"{lowest:.3g}"), *above)


def record(plan: Plan, model: Model) -> tuple[Array, Array, Array]:
    """Current, position and pressure difference, without noise."""
    samples = round(plan.seconds * RATE)
    current, out = np.empty(samples), np.empty((3, samples))
    settings = np.array([*plan.settings, *[0.0] * 4][:4])
    driven(
        plan.law,
        settings,
        1.0 / RATE,
        2,
        STEEPEST,
        STROKE / 2**BITS,
        model.constants,
        model.table.nodes,
        model.table.pieces,
        plan.start,
        current,
        out,
    )
    return current, out[0], out[1]


def prepared(plan: Plan, model: Model) -> Plan:
    """A sine as a bench records it: drift compensated by periods before the record, the swing about the middle."""
    if plan.law != FREQUENCY:
        return plan
    current, position, _ = record(plan, model)
    period = round(RATE / plan.settings[2])
    middle = 0.5 * (position[-period:].max() + position[-period:].min())
    settings = (float(current[-period:].mean()), *plan.settings[1:])
    return replace(plan, settings=settings, start=0.5 * STROKE - float(middle - position[-period]))


def write_bench(
    out: Path, preset: Preset, seed: int, noise: float, report: Report = silent, serial: str = "SIM-BENCH-0001"
) -> None:
    """Write a full set to the folder `out`, which is there and empty: matrix.yaml, limits.yaml, runs/.

    `noise` is white on the position, relative to each record's deviation, before the converter of 12 bits; the gauges
    of the cavities have 0.2 MPa RMS at the default of 0.005, and in proportion else.
    """
    model = model_of({p.name: p.value for p in preset.parameters}, SUPPLY)
    todo, entries = list(plans(0.1)), []
    for index, plan in enumerate(todo):
        report(Progress("simulate", index, len(todo)))
        rng = np.random.default_rng([seed, index])
        current, position, pressure = record(prepared(plan, model), model)
        gauges = 0.5 * SUPPLY + 1e6 * PRESSURE_NOISE * noise * rng.standard_normal((2, len(current)))
        noisy = position + noise * np.std(position) * rng.standard_normal(len(position))
        np.savez(
            out / "runs" / f"{plan.id}.npz",
            current=100.0 * current,
            pressure_a=1e-6 * (gauges[0] + 0.5 * pressure),
            displacement=1e3 * quantised(noisy),
            pressure_b=1e-6 * (gauges[1] - 0.5 * pressure),
        )
        entries.append(_entry(plan))
    report(Progress("simulate", len(todo), len(todo)))
    notes = f"simulated with the model kononykhin, seed {seed}, noise {noise:g}, 12-bit position; not measured"
    machine = {
        "serial": serial,
        "name": "simulated",
        "stroke": f"{1e3 * STROKE:g} mm",
        "supply_pressure": f"{1e-6 * SUPPLY:g} MPa",
        "notes": notes,
    }
    whole = {"actuator": machine, "limits": "limits.yaml", "runs": entries}
    (out / "matrix.yaml").write_text(yaml.safe_dump(whole, sort_keys=False), encoding="utf-8")
    (out / "limits.yaml").write_text(yaml.safe_dump(LIMITS, sort_keys=False), encoding="utf-8")


def quantised(position: Array) -> Array:
    """The position as a converter of 12 bits over the stroke gives it."""
    return np.asarray(np.clip(np.round(position * (2**BITS / STROKE)), 0, 2**BITS - 1) * (STROKE / 2**BITS))


def _entry(plan: Plan) -> dict[str, object]:
    channels = {"current": "%", "displacement": "mm", "pressure_a": "MPa", "pressure_b": "MPa"}
    return {
        "id": plan.id,
        "file": f"runs/{plan.id}.npz",
        "sample_rate": f"{RATE:g} Hz",
        "kind": plan.kind,
        "rated_current": "100 %",
        **plan.labels,
        "channels": {name: {"column": name, "unit": unit} for name, unit in channels.items()},
    }
