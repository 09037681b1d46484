"""Rows of a comparison, as they are printed."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from ident.comparison import side_by_side
from ident.comparison.side_by_side import SideBySide


def test_a_large_difference_of_aic_is_written_without_an_exponent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(side_by_side, "same_samples", lambda *_: True)
    columns = [SimpleNamespace(error={}, words={}, name=f"{aic}", fit=SimpleNamespace(aic=aic)) for aic in (0.0, 4e5)]
    compared: Any = SimpleNamespace(columns=columns)
    assert list(SideBySide.error_rows(compared)) == [("AIC, above the least", "0", "400000")]
