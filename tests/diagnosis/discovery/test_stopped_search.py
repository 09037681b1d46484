"""Terms of a search that the time ended are proposed in the place of effects only where they leave less."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from ident.diagnosis.discovery import discover
from ident.diagnosis.discovery.discovery_result import DiscoveryResult


@pytest.mark.parametrize("ended", ["within the first search", "before the second"])
@pytest.mark.parametrize(("left", "proposed"), [(0.28, False), (0.03, True)])
def test_terms_that_leave_more_than_the_selected_effects_are_not_proposed(monkeypatch, ended, left, proposed):
    """The effects leave 4 % of the held-out data, the model without them 115 %: 28 % is no better model."""
    term: Any = SimpleNamespace(error={"fit": left, "held_out": left})
    found = DiscoveryResult(proposals=(term,), refit=SimpleNamespace(), complete=ended == "before the second")
    monkeypatch.setattr(discover, "_search", lambda *_: found)
    monkeypatch.setattr(DiscoveryResult, "instead", lambda self, *_: self)
    if found.complete:
        monkeypatch.setattr(discover, "in_time", lambda _: None)
    base, fitted = (SimpleNamespace(error=error, held_out=SimpleNamespace(error=error)) for error in (1.15, 0.04))
    selection: Any = SimpleNamespace(base=base, fitted=fitted, added=("backlash",))
    models: Any = SimpleNamespace(is_noise=lambda _: False)
    told = discover.terms_of(models, selection, SimpleNamespace())  # type: ignore[arg-type]
    assert (bool(told.proposals), told.complete) == (proposed, False)
