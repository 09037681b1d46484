"""What marks, labels and legends of figures look like where they stand close together."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ident.figures.control_chart import control_chart
from ident.figures.delay_map import delay_map_chart
from ident.figures.feedforward import REFERENCE, feedforward_figure
from ident.figures.ladder import ladder
from ident.figures.share_map import share_map_chart
from ident.figures.theme import LOOKS
from ident.hybrid.coupled_stability import DelayMap
from ident.hybrid.feedforward_tracking import FeedforwardTracking
from ident.hybrid.share_map import ShareMap
from ident.matrix import Actuator
from ident.statistics import control_chart as chart_of

LOOK = LOOKS["dark"]
TIMES = tuple(np.linspace(0.0, 1.0, 50).tolist())
WAVE = tuple(np.sin(2 * np.pi * np.array(TIMES)).tolist())
FOLLOWED = FeedforwardTracking(
    gain=100.0, limit=432.0, draws=100, feedback_rms=0.01, both_rms=1e-5, drawn_feedback_rms=0.01, drawn_both_rms=1e-5,
    drawn_ratio=826.0, t=TIMES, reference=WAVE, feedback=WAVE, both=WAVE, low=WAVE, high=WAVE,
)  # fmt: skip


def test_the_legend_of_a_feedforward_has_the_lines_in_full_and_its_caption_fits():
    """The reference is dashed over the other lines, on which it lies."""
    chart = feedforward_figure(FOLLOWED, LOOK).to_dict()
    lines = chart["vconcat"][0]
    assert lines["encoding"]["color"]["legend"]["symbolOpacity"] == 1
    assert chart["datasets"][lines["data"]["name"]][-1]["n"] == REFERENCE
    assert len(chart["title"]["subtitle"]) == 2


def stable(count: int) -> np.ndarray:
    """The corner of small values."""
    return np.add.outer(np.arange(count), np.arange(count)) < count


SHARES, DELAYS = np.linspace(0.0, 0.95, 20), np.arange(1, 21)
MAPS = {
    "shares": share_map_chart(
        ShareMap(SHARES, SHARES, stable(20), *(np.full((20, 20), 0.01) for _ in range(3))),
        SimpleNamespace(name="qian"),
        "none",
        LOOK,
    ),
    "delays": delay_map_chart(DelayMap(("left", "right"), DELAYS, DELAYS, stable(20), np.ones((20, 20))), "own", LOOK),
}


@pytest.mark.parametrize("name", MAPS)
def test_each_row_of_a_map_has_its_label_at_its_height_and_a_cross_is_a_single_sign(name):
    """A label that is moved to the end of the axis stands at the next row; two outlines make no cross."""
    crosses = MAPS[name].to_dict()["layer"][1]
    assert crosses["encoding"]["y"]["axis"]["labelFlush"] is False
    assert crosses["mark"]["filled"] is True


def test_the_error_of_a_step_is_read_before_the_noise_floor():
    """The line of the floor ends before the text; the legend has the colours of the points."""
    layers = ladder([("first order", 0.00505, 0.00497)], 0.0051, Actuator("SW-1"), LOOK).to_dict()["layer"]
    assert [layer["mark"]["type"] for layer in layers][-3:] == ["rule", "text", "text"]
    assert layers[-2]["mark"]["stroke"] == LOOK.ground
    assert layers[0]["encoding"]["color"]["legend"]["symbolOpacity"] == 1


def test_a_control_chart_of_errors_is_in_per_cent():
    values = [0.0101, 0.0102, 0.0099, 0.0100]
    chart = control_chart(chart_of(values), "error.fit", "%", "every batch", list("abcd"), (None, 0.02), LOOK).to_dict()
    assert [row["v"] for row in chart["datasets"]["individuals"]] == [1.01, 1.02, 0.99, 1.0]
    assert {row["v"] for row in chart["datasets"]["individuals_lines"]} > {2.0}
    assert chart["vconcat"][0]["layer"][0]["encoding"]["y"]["axis"]["title"] == "error.fit (%)"
