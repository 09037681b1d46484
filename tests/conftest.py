"""What several test folders share: the measured data, the long forms of slow tests."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--full", action="store_true", help="run the acceptance tests at full length (many minutes)")


@pytest.fixture(scope="session")
def full(request: pytest.FixtureRequest) -> bool:
    """True where the full forms were asked for, by ``--full`` or SERVOIDENT_FULL=1."""
    return bool(request.config.getoption("--full")) or os.environ.get("SERVOIDENT_FULL") == "1"


@pytest.fixture(scope="session")
def measured_data() -> Path:
    """The folder of measured data beside the checkout; tests that need it are skipped where it is absent."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"no measured data: {folder} does not exist")
    return folder
