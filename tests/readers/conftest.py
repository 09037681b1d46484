"""A small matrix, and every file type that it may come in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.matrix_folder import WRITERS, MatrixFolder


@pytest.fixture
def matrix(tmp_path: Path) -> MatrixFolder:
    return MatrixFolder(tmp_path / "matrix")


@pytest.fixture
def columns(matrix: MatrixFolder) -> dict[str, NDArray[np.float64]]:
    """What the small matrix records."""
    return matrix.columns


@pytest.fixture(params=sorted(WRITERS))
def kind(request: pytest.FixtureRequest) -> str:
    """Each file type in turn."""
    return str(request.param)
