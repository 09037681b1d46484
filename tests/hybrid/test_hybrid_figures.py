"""The figures of a hybrid simulation: in both themes, also where a simulation ran away."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.figures import drawings, look, render
from ident.figures.hybrid_response import hybrid_response, rows
from ident.figures.hybrid_time import hybrid_time
from ident.figures.share_map import share_map_chart
from ident.figures.subjects import Simulated
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.linear_plant import linear_plant
from ident.hybrid.share_map import share_map
from tests.hybrid.cases import fitted, of_qian

FIT = fitted()
LOOSE = of_qian(3.0, damping=np.array([[100.0]]), gain=5.0)


@pytest.mark.full
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_figures_are_drawn_also_of_what_ran_away(theme):
    """Displacement, response and map of a stable and an unstable simulation side by side."""
    shown = {
        "as it is": simulate_hybrid(FIT, LOOSE),
        "mostly physical": simulate_hybrid(FIT, LOOSE.with_shares(0.7, 0.7)),
    }
    assert shown["as it is"].scores is not None
    assert shown["mostly physical"].scores is None
    for chart in (hybrid_time(shown, look(theme)), hybrid_response(shown, look(theme))):
        text = render(chart, "svg").decode()
        assert "ran away" in text
        assert "NaN" not in text
    case, alone = LOOSE, {"it": shown["mostly physical"]}
    assert [set(drawings(Simulated(of, case))) for of in (shown, alone)] == [
        {"displacement", "response"},
        {"displacement"},
    ]
    found = share_map(FIT, LOOSE, masses=[0.0, 0.5], stiffnesses=[0.0, 0.9])
    assert "unstable" in render(share_map_chart(found, LOOSE, "none", look(theme)), "svg").decode()


def test_the_response_is_that_of_the_machine():
    """The estimate from wanted to measured follows the machine's own response within 0.3 dB to 10 Hz."""
    case = replace(of_qian(20.0), gain=5.0)
    found = rows("a", simulate_hybrid(FIT, case))
    model = linear_plant(FIT, case.physical, case.gain, case.piston_area).model
    low = [row for row in found if 1.0 <= row["f"] <= 10.0]
    truth = model.frequency_response(np.array([row["f"] for row in low]))
    assert len(low) > 10
    assert np.allclose([row["a"] for row in low], 20 * np.log10(np.abs(truth)), atol=0.3)
