"""What was approved with this version's equations is found again; what mutations change is not.

The mutations are in `tests/mutations/regress.py`;
`tests/stored/regression.json` was kept by `tests/stored/keep_regression.py`.
"""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from app.regress.recheck import recheck
from ident.progress import silent
from tests.conftest import ROOT
from tests.rounding import generic
from tests.stored.keep_regression import CASES, stored

TOLERANCE = 1e-3


@pytest.mark.parametrize("case", CASES)
def test_an_approved_fit_is_found_again(case: str) -> None:
    """Its error computed again and its runs fitted from scratch: nothing moves."""
    found = recheck(case, case, stored()[case], CASES[case].matrix(), TOLERANCE, silent)
    assert not found.failure
    assert [(change.quantity, change.before, change.after) for change in found.moved] == []


@pytest.mark.parametrize("cores", [1, 2])
def test_it_is_found_on_any_processor_with_any_number_of_threads(full: bool, cores: int) -> None:
    """With numba kept to a generic processor, on one core and on two."""
    if not full:
        pytest.skip("every kernel is compiled anew: run with --full")
    if len(os.sched_getaffinity(0)) < cores:
        pytest.skip(f"this machine has fewer than {cores} cores")
    pinned = f"os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:{cores}])"
    code = f"import os, sys, pytest; {pinned}; sys.exit(pytest.main(sys.argv[1:]))"
    wanted = ["-q", "-k", "found_again", "tests/app/test_unchanged.py"]
    command, environment = [sys.executable, "-c", code, *wanted], os.environ | generic()
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-3000:]
