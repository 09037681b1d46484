"""The missing characteristic itself: what would have to be added at a place of the chain, as a function of a signal.

With T the linear response from that place to the output, s the signal, r the residual, J the sensitivities to the
parameters, φ = Σ θ_b h_b a broken line through knots (h_b hat functions),

    r = T * φ(s) + J δ + noise                       least squares for θ and δ, each run weighted by its residual

so that nothing is inverted and noise is not amplified: T * h_b are simulated, with s as φ and δ make it
(:mod:`ident.residuals.curve_fit`). Bands are 95 % from the scores of separate stretches of the records, which holds for
residuals of any colour (:mod:`ident.residuals.normal_equations`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from ident.comparison.compare import Comparison, fitted
from ident.parallel import each
from ident.residuals.curve_fit import CurveFit, settle
from ident.residuals.normal_equations import deviations, gauge
from ident.residuals.traces import Band, Traces, traces
from ident.residuals.views import looked_along, unit, view_called, views

_BAND = 1.96  # standard errors of 95 %


@dataclass(frozen=True, kw_only=True)
class Curve:
    """One curve: `x` in `x_unit`, `y` with its band in `y_unit`.

    `explained` is the share of the residual's power that the curve takes away on stretches that it was not fitted to.
    """

    name: str
    missing: str
    against: str
    shows: str
    x_unit: str
    y_unit: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    explained: float

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        return asdict(self)


def curves(
    comparison: Comparison, of: Comparison | None = None, *, view: str | None = None, band: Band | None = None
) -> tuple[Curve, ...]:
    """The curves of a compared model, those that explain most first, or the one of `view`.

    With `of`, another model of the same runs, what that model has beyond the first one: its prediction of the curves.
    With `band` (Hz), from what the residual has within it.
    """
    found = traced(comparison, of)
    return curves_of(found, curve_fits(found, view), band)


def traced(comparison: Comparison, of: Comparison | None = None) -> Traces:
    """What moves inside the model, for every signal that a view reads."""
    preset, _, _ = fitted(comparison.fit, comparison.matrix)
    return traces(
        comparison, looked_along(preset), None if of is None else {run.run.id: run.modelled for run in of.runs}
    )


def curve_fits(found: Traces, view: str | None = None) -> tuple[CurveFit, ...]:
    """Every view that the model has the signals for, or one: what takes long, and no band changes."""
    named = view_called(view or "", found.preset)
    wanted = [named] if named else views(found.preset)  # an unknown name is refused by who draws
    return tuple(one for one in each(lambda view: settle(found, view), wanted) if one is not None)


def curves_of(found: Traces, of: Sequence[CurveFit], band: Band | None = None) -> tuple[Curve, ...]:
    """The curve of each view, those that explain most first."""
    return tuple(sorted((_curve(found, one, band) for one in of), key=lambda c: -c.explained))


def _curve(found: Traces, settled: CurveFit, band: Band | None) -> Curve:
    view, knots, normal = settled.view, settled.knots, settled.within(band)
    free, solution = gauge(normal, knots)
    deviation = deviations(normal, free)
    known = found.actuator.piston_area is not None
    unknown = any(trace.run.units.get(trace.run.output, "m") == "1" for trace in found.runs)
    x_unit = "1" if unknown else unit(found.preset, view.by, known)
    y_unit = "1" if unknown or view.relative else unit(found.preset, view.at, known)
    y = solution[: len(knots)]
    return Curve(
        name=view.name,
        missing=view.missing,
        against=view.against,
        shows=view.shows,
        x_unit=x_unit,
        y_unit=y_unit,
        x=tuple(knots.tolist()),
        y=tuple(y.tolist()),
        lower=tuple((y - _BAND * deviation).tolist()),
        upper=tuple((y + _BAND * deviation).tolist()),
        explained=normal.explained,
    )
