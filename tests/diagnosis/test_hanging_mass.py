"""A mass behind a spring that rings beyond the frequencies of the command is named, and its spring found."""

from __future__ import annotations

import pytest

from ident.fit.settings import Settings
from ident.workflows import diagnose, identify
from tests.blind.various import Various
from tests.conftest import rank_only

FEW = ("elastic_load", "elastic_coupling")
LIGHT = {"population": 24.0, "generations": 8.0, "elite": 4.0}


@pytest.mark.full
def test_a_spring_whose_resonance_lies_beyond_the_command_is_found(monkeypatch):
    """Straight commands excite up to 24.5 rad/s; the load swings at 27.5 rad/s. SciPy integrates the machine."""
    rank_only(monkeypatch, FEW)
    coupled = Various.drawn(168283, hidden=True)
    assert (coupled.kind, coupled.hidden) == ("coupled", "elastic_load")
    records = coupled.measured()
    found = diagnose(records, identify(records, Settings(model="motor", options=LIGHT)), propose=False)
    assert found.verdict.effects == ("elastic_load",)
    assert found.ladder[-1].error["fit"] < 1.05 * coupled.noise
    frequency = found.ladder[-1].parameters["elastic_load.frequency"].value
    assert frequency == pytest.approx(2.5 * coupled.quick * 100.0, rel=0.02)
