"""A small matrix and the program as its users run it."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from app.cli.program import main


@dataclass(frozen=True)
class Outcome:
    """What a command left behind."""

    returncode: int
    stdout: str
    stderr: str


Program = Callable[..., Outcome]


@pytest.fixture(scope="session")
def servoident(tmp_path_factory) -> Iterator[Program]:
    """The command line, run in this process (a new one would spend seconds on imports)."""
    own = pytest.MonkeyPatch()
    for name in ("XDG_STATE_HOME", "XDG_DATA_HOME"):
        own.setenv(name, str(tmp_path_factory.mktemp("state")))
    for name in ("SERVOIDENT_DATA", "SERVOIDENT_TOKEN", "SERVOIDENT_SERVER", "SERVOIDENT_DATABASE"):
        own.delenv(name, raising=False)

    def run(*arguments: object) -> Outcome:
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main([str(argument) for argument in arguments])
        return Outcome(ended.value.code, out.getvalue(), err.getvalue())

    yield run
    own.undo()


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
