"""The acceptance test: limits of quantities from a small file, and which the actuator keeps."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ident.bench.analysis import Analysis
from ident.bench.estimate import BenchEstimate
from ident.bench.least_margins import least_margins
from ident.bench.model import dead_space
from ident.bench.position_error import position_error
from ident.bench.speed_linearity import of_table
from ident.errors import Unusable
from ident.fit.sheet_quantity import SheetQuantity
from ident.readers.strict_yaml import read_yaml
from ident.units.quantity import quantity
from ident.words.nearest import did_you_mean

QUANTITIES = {
    "zero_shift": ("1", "zero shift I0, in rated currents"),
    "dead_space": ("1", "dead space, half-width, in rated currents"),
    "hysteresis": ("1", "hysteresis B, half-width of the play, in rated currents"),
    "kp": ("Pa", "slope of the pressure difference, a rated current"),
    "friction": ("Pa", "pressure difference that overcomes friction"),
    "T": ("s", "time constant"),
    "delay": ("s", "pure delay in addition to T"),
    "gain": ("m/s", "speed at rated current, of one straight line"),
    "gain_forward": ("m/s", "speed at rated current forward"),
    "gain_back": ("m/s", "speed at rated current back"),
    "nonlinearity": ("1", "largest distance of the speed from one straight line over full speed"),
    "asymmetry": ("1", "difference of the gains forward and back over their mean"),
    "position_error": ("1", "position error of the model, RMS over deviation, mean over the frequency records"),
    "gain_margin": ("dB", "least gain margin of the position loop with the stated regulator"),
    "phase_margin": ("rad", "least phase margin of the position loop with the stated regulator"),
}
"""What a limit may be set for: unit and meaning."""
_PRINTED = {
    "1": (100.0, "%"),
    "s": (1e3, "ms"),
    "Pa": (1e-6, "MPa"),
    "m/s": (1e3, "mm/s"),
    "dB": (1.0, "dB"),
    "rad": (180.0 / math.pi, "°"),
}
"""By SI unit, what a value is multiplied by for a reader, and in which unit it is then. No answer depends on it."""
_CHARACTERISTIC = {
    "gain": "gain",
    "gain_forward": "forward",
    "gain_back": "back",
    "nonlinearity": "nonlinearity",
    "asymmetry": "asymmetry",
}
_SLOPE = (1e-8, "MPa/%")
"""The same of the slope of a pressure. No answer depends on it."""


@dataclass(frozen=True)
class Line:
    """A line of the sheet; `passed` is None where no limit is set. A quantity that was not found fails its limit.

    A production line judges with the standard errors: then its `outcome` is "inside", "outside" or "unknown".
    """

    quantity: str
    meaning: str
    value: float | None
    deviation: float | None
    unit: str
    lower: float | None
    upper: float | None
    outcome: str | None = None

    @property
    def printed(self) -> tuple[float, str]:
        """Factor and unit for a reader: per cent of rated current, ms, MPa, mm/s."""
        return _SLOPE if self.quantity == "kp" else _PRINTED[self.unit]

    @property
    def verdict(self) -> str:
        """In a word; nothing where no limit is set."""
        if self.outcome is not None:
            return {"inside": "pass", "outside": "FAIL"}.get(self.outcome, "inconclusive")
        return {None: "", True: "pass", False: "FAIL"}[self.passed]

    @property
    def passed(self) -> bool | None:
        """Within its limits; None where none is set."""
        if self.lower is None and self.upper is None:
            return None
        if self.value is None:
            return False
        above = self.lower is None or self.value >= self.lower
        return above and (self.upper is None or self.value <= self.upper)


def found_quantities(analysis: Analysis) -> dict[str, BenchEstimate]:
    """The quantities of the sheet by name: of the procedures, T, I0 and B of the model on all records where it is."""
    out: dict[str, BenchEstimate] = {}
    if analysis.static is not None:
        s = analysis.static
        out |= {
            "zero_shift": s.zero_shift,
            "dead_space": s.dead_space,
            "hysteresis": s.hysteresis,
            "kp": s.slope,
            "friction": s.friction,
        }
    if analysis.whole is not None:
        out |= _of_whole(analysis)
    if analysis.delay is not None:
        out["delay"] = analysis.delay.delay
    out |= _of_characteristic(analysis)
    sines = [response.id for response in analysis.frequency if response.id in analysis.errors]
    if sines and analysis.whole is not None:
        out["position_error"] = position_error(analysis.whole, sines)
    if analysis.whole is not None and analysis.regulator is not None:
        out |= least_margins(analysis.whole, analysis.regulator, analysis.delay)
    return out


def _of_whole(analysis: Analysis) -> dict[str, BenchEstimate]:
    assert analysis.whole is not None
    v, solution = analysis.whole.values, analysis.whole
    named = (
        ("zero_shift", "I0", "1"),
        ("hysteresis", "B", "1"),
        ("kp", "kp", "Pa"),
        ("friction", "dPfr", "Pa"),
        ("T", "T", "s"),
    )
    out = {name: BenchEstimate(v[own], solution.deviations[own], unit) for name, own, unit in named}
    return out | {"dead_space": BenchEstimate(solution.model.dead_space, solution.deviation(dead_space), "1")}


def _of_characteristic(analysis: Analysis) -> dict[str, BenchEstimate]:
    """Gains, nonlinearity, asymmetry of the model's characteristic, or where there is no model of the procedure's."""
    solution, model = analysis.whole, analysis.model
    if solution is None or model is None:
        if analysis.speed is None:
            return {}
        s = analysis.speed.straightness
        return {name: BenchEstimate(getattr(s, own), 0.0, QUANTITIES[name][0]) for name, own in _CHARACTERISTIC.items()}
    table = model.table

    def of(own: str) -> Callable[[Mapping[str, Any]], Any]:
        def value(values: Mapping[str, Any]) -> Any:
            columns = zip(*(np.atleast_1d(values[name]) for name in table.names), strict=True)
            tables = (table.with_values(dict(zip(table.names, map(float, column), strict=True))) for column in columns)
            return np.array([getattr(of_table(each), own) for each in tables])

        return value

    return {
        name: BenchEstimate(float(of(own)(model.table.values())[0]), solution.deviation(of(own)), QUANTITIES[name][0])
        for name, own in _CHARACTERISTIC.items()
    }


def sheet(analysis: Analysis, limits: Mapping[str, tuple[float | None, float | None]]) -> tuple[Line, ...]:
    """A line for each quantity found or limited."""
    found, out = found_quantities(analysis), []
    for name, (unit, meaning) in QUANTITIES.items():
        lower, upper = limits.get(name, (None, None))
        if name in found:
            out.append(Line(name, meaning, found[name].value, found[name].deviation, unit, lower, upper))
        elif name in limits:
            out.append(Line(name, meaning, None, None, unit, lower, upper))
    return tuple(out)


def sheet_quantities(
    analysis: Analysis, limits: Mapping[str, tuple[float | None, float | None]]
) -> dict[str, SheetQuantity]:
    """The quantities of the sheet that were found, with their limits, by name: the sheet as a fit keeps it."""
    return {
        line.quantity: SheetQuantity(line.value, line.deviation or 0.0, line.unit, line.lower, line.upper)
        for line in sheet(analysis, limits)
        if line.value is not None
    }


def passed(lines: tuple[Line, ...]) -> bool:
    """True where no limit is broken, and none is open."""
    return all(line.verdict in ("", "pass") for line in lines)


def judged(lines: Sequence[Line], by: Mapping[str, tuple[float | None, float | None, str]]) -> tuple[Line, ...]:
    """The lines against the limits of a production line, as it judged them: lower, upper and outcome by quantity."""
    judgements = (by.get(line.quantity, (None, None, None)) for line in lines)
    return tuple(
        replace(line, lower=lower, upper=upper, outcome=outcome)
        for line, (lower, upper, outcome) in zip(lines, judgements, strict=True)
    )


def read_limits(text: str, where: str) -> dict[str, tuple[float | None, float | None]]:
    """Limits by quantity, SI, from YAML: ``dead_space: {max: 0.6 %}``. Raises Unusable with the quantity at fault."""
    data = read_yaml(text.encode(), where) if text.strip() else None
    if data is None:
        return {}
    if not isinstance(data, Mapping):
        raise Unusable(
            "not-a-mapping", "the limits are no list of quantity: {min, max}", where, "write T: {max: 30 ms}"
        )
    return dict(_limits(data, where))


def _limits(data: Mapping[str, Any], where: str) -> Iterator[tuple[str, tuple[float | None, float | None]]]:
    for name, entry in data.items():
        if name not in QUANTITIES:
            raise Unusable("unknown-quantity", f"no quantity {name!r}", where, did_you_mean(str(name), QUANTITIES))
        if not isinstance(entry, Mapping) or not entry or set(entry) - {"min", "max"}:
            raise Unusable("bad-limit", f"{name} has no min or max", where, f"write {name}: {{min: …, max: …}}")
        unit = QUANTITIES[name][0]
        lower, upper = (
            quantity(entry[key], unit, f"{where} {name}.{key}") if key in entry else None for key in ("min", "max")
        )
        if lower is not None and upper is not None and not lower <= upper:
            raise Unusable("bad-limit", f"min of {name} is above its max", where, "exchange them")
        yield name, (lower, upper)
