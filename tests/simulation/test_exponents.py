"""Exponents in the code of a kernel: those that are products or roots; a search for another one compiles nothing."""

from __future__ import annotations

import numpy as np
import pytest

from ident.presets import preset
from ident.simulation.kernel import exponents_in_code, kernel

CHAIN = preset("qian2014", ("specimen_hysteresis",)).chain
EXPONENT = "specimen_hysteresis__exponent"


@pytest.mark.parametrize(
    ("values", "in_code"), [(2.0, True), ([2.0, 2.0], True), (2.5, False), ([2.0, 2.0 + 1e-9], False)]
)
def test_an_exponent_stands_in_the_code_where_it_is_written_out_and_the_same_in_all_lanes(values, in_code):
    assert exponents_in_code(CHAIN, {EXPONENT: np.array(values)}) == ({(EXPONENT, 2.0)} if in_code else set())


def test_all_other_exponents_share_a_kernel():
    lines = [
        kernel(CHAIN, "displacement", exponents_in_code(CHAIN, {EXPONENT: np.array([n])})).lines
        for n in (2.5, 2.6, 3.0)
    ]
    assert lines[0] == lines[1]
    assert lines[0] != lines[2]
    assert any("pow(" in line for line in lines[0])
    assert not any("pow(" in line for line in lines[2])
