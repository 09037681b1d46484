"""A chart as bytes: one definition for page, screen and paper, without a browser or a network."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import altair as alt
import vl_convert

from ident.errors import Unusable
from ident.figures.frame import Filled, unchecked
from ident.words.nearest import did_you_mean

Panel = alt.Chart | alt.LayerChart | alt.FacetChart
Chart = alt.LayerChart | alt.HConcatChart | alt.VConcatChart | alt.ConcatChart | Filled

AltairChart = alt.LayerChart | alt.HConcatChart | alt.VConcatChart | alt.ConcatChart | alt.FacetChart | alt.Chart
_KINDS: Mapping[str, type[AltairChart]] = {
    "layer": alt.LayerChart, "hconcat": alt.HConcatChart, "vconcat": alt.VConcatChart, "concat": alt.ConcatChart,
    "facet": alt.FacetChart,
}  # fmt: skip
Row = dict[str, Any]


@dataclass(frozen=True)
class Rows:
    """Rows of a figure's data, handed through Altair as they are: it would copy and check each of them many times."""

    rows: list[Row]
    _schema: ClassVar[dict[str, Any]] = {"type": "array"}

    def to_dict(self) -> list[Row]:
        """The rows."""
        return self.rows


def datasets(tables: Mapping[str, list[Row]]) -> dict[str, Rows]:
    """Named tables as a chart's `datasets`."""
    return {name: Rows(rows) for name, rows in tables.items()}


def shown(chart: Chart) -> AltairChart:
    """A chart of Altair, which shows itself in a notebook, can be saved and worked on."""
    if not isinstance(chart, Filled):
        return chart
    spec = chart.to_dict()
    kind = next((kind for key, kind in _KINDS.items() if key in spec), alt.Chart)
    made: AltairChart = kind.from_dict(spec, validate=False)
    return made


MEDIA: Mapping[str, str] = {
    "json": "application/json",
    "svg": "image/svg+xml",
    "png": "image/png",
    "pdf": "application/pdf",
}
"""Formats by name, with their media types."""


def render(chart: Chart, format: str, *, live: bool = False) -> bytes:  # noqa: A002 - the word of the contract
    """The chart as Vega-Lite JSON, SVG, PNG (two dots a pixel) or PDF; raises Unusable for any other format.

    A `live` JSON keeps what differs between runs and bands in its parameters, for a page that exchanges only these.
    """
    if format not in MEDIA:
        raise Unusable("unknown-format", f"no format {format!r}", "figure", did_you_mean(format, MEDIA))
    if isinstance(chart, Filled):
        text = chart.to_json(live=live)
    else:
        with unchecked():  # Altair turns its checks off for each copy it makes, and then on again for all threads
            text = chart.to_json(indent=None, validate=False)
    if format == "json":
        return text.encode()
    drawn = _CONVERT[format](text)
    return drawn.encode() if isinstance(drawn, str) else drawn


_CONVERT: Mapping[str, Callable[[str], Any]] = {
    "svg": lambda text: vl_convert.vegalite_to_svg(text, allowed_base_urls=[]),
    "png": lambda text: vl_convert.vegalite_to_png(text, scale=2, allowed_base_urls=[]),
    "pdf": lambda text: vl_convert.vegalite_to_pdf(text, allowed_base_urls=[]),
}
