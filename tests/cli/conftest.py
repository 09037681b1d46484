"""A small matrix and its fit, written by the program."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def matrix(servoident, tmp_path_factory) -> Path:
    """A simulated matrix of short runs, written by the program."""
    folder = tmp_path_factory.mktemp("simulated") / "matrix"
    done = servoident("simulate", folder, "--seconds", 0.5, "--seed", 3)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="session")
def fit_file(servoident, matrix, tmp_path_factory) -> Path:
    """The JSON of a fit of the simulated matrix."""
    file = tmp_path_factory.mktemp("fit") / "fit.json"
    done = servoident("fit", matrix, "--json", file, "--bounds", "tau=1 ms:6 ms", "--set", "m0=4.25")
    assert done.returncode == 0, done.stderr
    return file
