"""Searches are short here: what is tested is said of fits, and not of how they are found."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.conftest import short_searches


@pytest.fixture(scope="module", autouse=True)
def _short_searches(full: bool) -> Iterator[None]:
    with short_searches(full):
        yield
