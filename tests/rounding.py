"""Data as another processor would round them: what a fit finds must not hang on the last bits.

With SERVOIDENT_ROUNDING=1 (or another number) every fit, analysis and diagnosis of the tests gets its data so, and
with GENERIC in the environment the compiled code and the libraries do as on a processor without AVX-512:

    python -m tests.rounding tests/fit tests/bench     # the tests of these folders in both ways; arguments go to pytest
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ident.matrix import Matrix
from ident.run import Run

VARIABLE = "SERVOIDENT_ROUNDING"
SIZE = 1e-12  # relative: a rounding is 1e-16, and what a sum of many loses a few thousand of them


def moved(samples: np.ndarray, seed: int) -> np.ndarray:
    """Samples each moved by a share of 1e-12 of itself; the same for the same seed."""
    return np.asarray(samples * (1.0 + SIZE * np.random.default_rng(seed).standard_normal(len(samples))))


def perturbed_run(run: Run, seed: int) -> Run:
    """The run with every sample moved."""
    return replace(run, channels={name: moved(samples, seed) for name, samples in run.channels.items()})


def perturbed(matrix: Matrix, seed: int) -> Matrix:
    """The matrix with every sample moved."""
    return replace(matrix, runs=tuple(perturbed_run(run, seed) for run in matrix.runs))


def generic() -> dict[str, str]:
    """An environment in which no library uses what only some processors have, by the names that this NumPy knows."""
    from numpy._core._multiarray_umath import __cpu_dispatch__ as known

    wide = [name for name in known if name == "X86_V4" or name.startswith("AVX512")]
    return {"NUMBA_CPU_NAME": "generic", "OPENBLAS_CORETYPE": "Haswell", "NPY_DISABLE_CPU_FEATURES": " ".join(wide)}


@contextmanager
def rounded_otherwise() -> Iterator[None]:
    """For the length of a block every fit, analysis and diagnosis sees moved samples, where the variable is set."""
    seed = os.environ.get(VARIABLE)
    patch = pytest.MonkeyPatch()
    if seed:
        _move_all(patch, int(seed))
    yield
    patch.undo()


def _move_all(patch: pytest.MonkeyPatch, seed: int) -> None:
    from ident.bench import records
    from ident.diagnosis.candidate_models import CandidateModels
    from ident.fit.identification import Identification

    make, begin, of = records._record, Identification.__init__, CandidateModels.of.__func__

    def of_moved(cls: Any, matrix: Matrix, *rest: Any, **named: Any) -> Any:
        return of(cls, perturbed(matrix, seed), *rest, **named)

    def begin_moved(self: Any, matrix: Matrix, *rest: Any, **named: Any) -> None:
        begin(self, perturbed(matrix, seed), *rest, **named)

    patch.setattr(records, "_record", lambda run, rated: make(perturbed_run(run, seed), rated))
    patch.setattr(Identification, "__init__", begin_moved)
    patch.setattr(CandidateModels, "of", classmethod(of_moved))


if __name__ == "__main__":
    ways = {"perturbed data": {VARIABLE: "1"}, "generic processor": generic(), "one thread": {"OMP_NUM_THREADS": "1"}}
    failed = 0
    for name, settings in ways.items():
        print(f"{name}: {settings}", flush=True)
        command = [sys.executable, "-m", "pytest", *sys.argv[1:]]
        failed |= subprocess.run(command, env={**os.environ, **settings}, check=False).returncode
    sys.exit(failed)
