"""What benchmarks measured, for what is reckoned from it: benchmarks/figures.json."""

from __future__ import annotations

import json
from pathlib import Path

FILE = Path(__file__).with_name("figures.json")


def known() -> dict[str, float]:
    """Every figure by its name, in SI."""
    found: dict[str, float] = json.loads(FILE.read_text(encoding="utf-8"))
    return found


def note(**figures: float) -> None:
    """Keep figures in the place of earlier ones of these names."""
    before = known() if FILE.exists() else {}
    FILE.write_text(json.dumps({**before, **figures}, indent=2, sort_keys=True) + "\n", encoding="utf-8")
