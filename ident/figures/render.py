"""A chart as bytes: one definition for page, screen and paper, without a browser or a network."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import altair as alt
import vl_convert

from ident.errors import Unusable
from ident.figures.chart_template import Filled, unchecked
from ident.words.nearest import did_you_mean

Panel = alt.Chart | alt.LayerChart | alt.FacetChart
Chart = alt.LayerChart | alt.FacetChart | alt.HConcatChart | alt.VConcatChart | alt.ConcatChart | Filled

AltairChart = alt.LayerChart | alt.HConcatChart | alt.VConcatChart | alt.ConcatChart | alt.FacetChart | alt.Chart
_KINDS: Mapping[str, type[AltairChart]] = {
    "layer": alt.LayerChart,
    "hconcat": alt.HConcatChart,
    "vconcat": alt.VConcatChart,
    "concat": alt.ConcatChart,
    "facet": alt.FacetChart,
}
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
    return renders(chart, (format,), live=live)[format]


def renders(chart: Chart, formats: Sequence[str], *, live: bool = False) -> dict[str, bytes]:
    """The same in several formats, by their names: drawn once, as an SVG, of which the others are made."""
    for format_ in formats:
        if format_ not in MEDIA:
            raise Unusable("unknown-format", f"no format {format_!r}", "figure", did_you_mean(format_, MEDIA))
    text = _text(chart, live=live)
    svg = vl_convert.vegalite_to_svg(text, allowed_base_urls=[]) if {*formats} - {"json"} else ""
    return {format_: text.encode() if format_ == "json" else _CONVERT[format_](svg) for format_ in formats}


def _text(chart: Chart, *, live: bool) -> str:
    """The chart in the language of Vega-Lite."""
    if isinstance(chart, Filled):
        return chart.to_json(live=live)
    with unchecked():  # Altair turns its checks off for each copy it makes, and then on again for all threads
        return chart.to_json(indent=None, validate=False)


_CONVERT: Mapping[str, Callable[[str], bytes]] = {
    "svg": lambda svg: svg.encode(),
    "png": lambda svg: vl_convert.svg_to_png(svg, scale=2),
    "pdf": vl_convert.svg_to_pdf,
}
