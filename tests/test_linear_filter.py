"""The filter by a difference equation, judged by SciPy; nothing of SciPy that takes long to load is loaded for it."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
import scipy.signal

from ident.linear_filter import linear_filter

OF_A_RECORD = """
import sys
import numpy as np
from ident.fit.settings import Settings
from ident.diagnosis.candidate_models import CandidateModels
from ident.matrix import Actuator, Matrix
from ident.run import Run

u = np.random.default_rng(0).standard_normal(2000)
run = Run("a", "", 1000.0, {"command": u, "displacement": np.cumsum(u)}, kind="other", use="fit")
models = CandidateModels.of(Matrix(Actuator("A", piston_area=1e-3), (run,)), Settings())
assert models.effects
slow = {"scipy.signal", "scipy.stats", "scipy.ndimage", "scipy.optimize"}
import ident
assert ident.identify and ident.diagnose
print(sorted(slow & set(sys.modules)))
"""


@pytest.mark.parametrize("poles", [[0.5], [0.99, -0.3], [0.9 + 0.3j, 0.9 - 0.3j, 0.5, 0.999]])
@pytest.mark.parametrize("zeros", [1, 5])
def test_the_numbers_are_those_of_scipy(poles, zeros):
    rng = np.random.default_rng([len(poles), zeros])
    b, a, u = rng.standard_normal(zeros), 2.0 * np.real(np.poly(poles)), rng.standard_normal(3000)
    expected = scipy.signal.lfilter(b, a, u)
    assert np.allclose(linear_filter(b, a, u), expected, rtol=0.0, atol=1e-11 * np.abs(expected).max())


def test_whether_a_record_rings_is_told_without_what_takes_a_second_to_load():
    """Each diagnosis asks it of its records, also the shortest: half of what that may take would be this import."""
    done = subprocess.run([sys.executable, "-c", OF_A_RECORD], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
