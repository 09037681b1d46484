"""Numbers of the criteria changed for a test."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from ident.diagnosis.criteria import CRITERIA


def vary(monkeypatch: pytest.MonkeyPatch, section: str, **numbers: Any) -> None:
    """Change numbers of one section until the test ends."""
    monkeypatch.setitem(vars(CRITERIA), section, replace(getattr(CRITERIA, section), **numbers))
