"""A small matrix and its fit, written by the program."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from tests.conftest import short_searches


@pytest.fixture(scope="session")
def matrix(servoident, tmp_path_factory) -> Path:
    """A simulated matrix of short runs, written by the program."""
    folder = tmp_path_factory.mktemp("simulated") / "matrix"
    done = servoident("simulate", folder, "--seconds", 0.5, "--seed", 3)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="session")
def few(matrix, tmp_path_factory) -> Path:
    """Every seventh run of it: enough for what is done with a fit."""
    folder = tmp_path_factory.mktemp("few") / "matrix"
    shutil.copytree(matrix, folder)
    description = yaml.safe_load((folder / "matrix.yaml").read_text())
    description["runs"] = description["runs"][::7]
    (folder / "matrix.yaml").write_text(yaml.safe_dump(description, allow_unicode=True))
    return folder


@pytest.fixture(scope="session")
def fit_file(servoident, few, tmp_path_factory) -> Path:
    """The JSON of a fit of these."""
    file = tmp_path_factory.mktemp("fit") / "fit.json"
    done = servoident("fit", few, "--json", file, "--bounds", "tau=1 ms:6 ms", "--set", "m0=4.25")
    assert done.returncode == 0, done.stderr
    return file


@pytest.fixture(scope="module", autouse=True)
def _short_searches(full: bool) -> Iterator[None]:
    """What is tested is said of fits, and not of how they are found."""
    with short_searches(full):
        yield
