"""What is said of a diagnosis is not about how the fit before it was found."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.conftest import short_searches

USUAL = {"test_structure_selection.py", "test_measured.py"}
"""Machines that are compared or were measured are searched as usual: one that is not found is not chosen."""


@pytest.fixture(scope="module", autouse=True)
def _short_searches(full: bool, request: pytest.FixtureRequest) -> Iterator[None]:
    """The usual searches are in tests/acceptance and tests/fit."""
    with short_searches(full or request.path.name in USUAL):
        yield
