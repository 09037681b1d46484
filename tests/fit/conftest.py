"""Most of what is said of a fit is not about how it was found."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.conftest import short_searches

USUAL = {
    "test_criteria_of_search.py",
    "test_local_optima.py",
    "test_fifth_order.py",
    "test_far_bounds.py",
    "test_paper_search.py",
    "test_recovery.py",
    "test_wider_bounds.py",
}
"""Files about the search itself: what it finds, and where it ends."""


@pytest.fixture(scope="module", autouse=True)
def _short_searches(full: bool, request: pytest.FixtureRequest) -> Iterator[None]:
    """The usual searches are in the files above and in tests/acceptance."""
    with short_searches(full or request.path.name in USUAL):
        yield
