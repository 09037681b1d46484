"""The bundle of Vega is made once for a user: another service serves what the first one kept."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from app.pages import vega


def test_the_bundle_is_made_once_and_again_for_another_version(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made: list[str] = []
    maker = SimpleNamespace(javascript_bundle=lambda snippet: made.append(snippet) or f"made {len(made)}")
    monkeypatch.setattr(vega, "vl_convert", maker)
    monkeypatch.setattr(vega, "cache_folder", lambda: tmp_path)
    anew = vega.bundle.__wrapped__
    assert [anew(), anew()] == [b"made 1"] * 2
    monkeypatch.setattr(vega, "distribution", lambda _: "another")
    assert anew() == b"made 2"


def test_where_nothing_can_be_kept_it_is_made(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(vega, "vl_convert", SimpleNamespace(javascript_bundle=lambda _: "made"))
    monkeypatch.setattr(vega, "cache_folder", lambda: tmp_path / "none")
    assert vega.bundle.__wrapped__() == b"made"
