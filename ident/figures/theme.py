"""How every figure looks: colours, type and size, in a light and a dark theme."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ident.errors import Unusable
from ident.words.nearest import did_you_mean

FONT = "Liberation Sans, Arial, Helvetica, sans-serif"

_SMALL = 0.6  # of the usual width


@dataclass(frozen=True)
class Look:
    """One theme; `series` is colour-blind safe (Okabe and Ito 2008, lightened for the dark ground), in order of use."""

    name: str
    ground: str
    ink: str
    faint: str
    grid: str
    series: tuple[str, ...]
    ramp: tuple[str, ...]  # for a quantity on a continuous scale, low to high
    share: float = 1.0  # of the usual width

    @property
    def small(self) -> bool:
        """True where a figure stands beside words that say what it is."""
        return self.share < _SMALL

    def across(self, pixels: float) -> int:
        """The width of a panel that usually has so many pixels."""
        return round(self.share * pixels)

    def config(self) -> dict[str, Any]:
        """The Vega-Lite configuration of this theme."""
        text = {"labelColor": self.ink, "titleColor": self.ink}
        return {
            "font": FONT,
            "background": self.ground,
            "padding": 12,
            "view": {"stroke": self.grid},
            "concat": {"spacing": 14},
            "axis": text
            | {
                "gridColor": self.grid,
                "domainColor": self.faint,
                "tickColor": self.faint,
                "titleFontWeight": "normal",
                "labelFontSize": 11,
                "titleFontSize": 12,
                "titlePadding": 8,
                "labelFlush": False,
            },
            "axisY": {"labelFlush": True},
            "legend": text | {"titleFontWeight": "normal", "labelFontSize": 11, "titleFontSize": 12, "labelLimit": 320},
            "title": {
                "color": self.ink,
                "subtitleColor": self.faint,
                "fontSize": 14,
                "subtitleFontSize": 12,
                "anchor": "start",
                "offset": 12,
                "subtitlePadding": 5,
                "subtitleLineHeight": 15,
            },
        }


_RAMP = ("#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#d9c400")

LOOKS: Mapping[str, Look] = {
    "light": Look(
        "light",
        "#ffffff",
        "#1d2329",
        "#5b6570",
        "#e3e7eb",
        ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a5c00", "#000000"),
        _RAMP,
    ),
    "dark": Look(
        "dark",
        "#171b20",
        "#e4e8ec",
        "#9aa5b1",
        "#2c333b",
        ("#4fb3ee", "#ff8a47", "#2cc79b", "#e79ac6", "#f2b632", "#a7d8f7", "#c9b458", "#f4f6f8"),
        ("#7a5fb0", "#6f7fd0", "#4aa3b8", "#3ec795", "#9be05f", "#f6e64a"),
    ),
}


def look(theme: str, share: float = 1.0) -> Look:
    """The theme of that name, panels `share` as wide as usual; raises Unusable for any other."""
    if theme not in LOOKS:
        raise Unusable("unknown-theme", f"no theme {theme!r}", "figure", did_you_mean(theme, LOOKS))
    return LOOKS[theme] if share == 1.0 else replace(LOOKS[theme], share=share)
