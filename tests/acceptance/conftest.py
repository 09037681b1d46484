"""The paper's matrix from the independent reference, for each kind of command."""

from __future__ import annotations

import pytest

from ident.matrix import Matrix
from tests.acceptance.matrices import LONG, SHORT, as_matrix, records_of
from tests.reference import qian_reference as reference


@pytest.fixture(params=["linear", "zoh"])
def hold(request: pytest.FixtureRequest) -> str:
    """What the command does between samples."""
    return str(request.param)


@pytest.fixture
def seconds(full: bool) -> float:
    """Length of a run: 30 s in the full form, 2 s in the short one."""
    return LONG if full else SHORT


@pytest.fixture
def records(seconds: float, hold: str) -> tuple[reference.Record, ...]:
    """The paper's 84 runs from the reference."""
    return records_of(seconds, hold)


@pytest.fixture
def matrix(records: tuple[reference.Record, ...], hold: str) -> Matrix:
    """The same runs as the program reads them."""
    return as_matrix(records, hold)
