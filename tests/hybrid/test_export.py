"""A controller as JSON, MAT and C: the same controller each time."""

from __future__ import annotations

import io
import json
import shutil
import subprocess

import numpy as np
import pytest
import scipy.io

from ident.hybrid.controller import SampledController
from ident.hybrid.export import as_header, as_mat
from tests.hybrid.designs import STATED, designed

SAMPLES = 10_000
PROGRAM = """
#include <stdio.h>
#include "controller.h"
int main(void)
{
    double d, y;
    servoident_controller c;
    servoident_reset(&c);
    while (scanf("%lf %lf", &d, &y) == 2)
        printf("%.17e\\n", servoident_step(&c, d, y));
    return 0;
}
"""


def inputs():
    """A wanted displacement of some millimetres, and one beside it that is measured."""
    rng = np.random.default_rng(3)
    wanted = 5e-3 * np.sin(2 * np.pi * 3 * np.arange(SAMPLES) / 4096)
    return np.column_stack([wanted, 0.98 * wanted + 1e-6 * rng.standard_normal(SAMPLES)])


def outputs(A, B, C, D):
    """u of x(k+1) = A x + B [d, y], u = C x + D [d, y], step by step."""
    x, found = np.zeros(len(A)), []
    for v in inputs():
        found.append((C @ x + D @ v)[0])
        x = A @ x + B @ v
    return np.array(found)


def of_json(controller):
    """What the controller of the JSON answers."""
    read = SampledController.from_json(json.loads(json.dumps(controller.to_json())))
    return outputs(read.A, read.B, read.C, read.D)


@pytest.mark.parametrize("structure", ["feedback", "two-degree"])
def test_the_mat_file_is_the_controller_of_the_json(structure):
    """The same command over 10,000 samples to 1e-9 of the largest, and the rate beside it."""
    controller = designed(STATED, structure).controller
    read = scipy.io.loadmat(io.BytesIO(as_mat(controller)))
    wanted = of_json(controller)
    found = outputs(read["A"], read["B"], read["C"], read["D"])
    assert np.abs(found - wanted).max() <= 1e-9 * np.abs(wanted).max()
    assert read["sample_rate"].item() == 4096
    assert read["Ts"].item() == pytest.approx(1 / 4096)


@pytest.mark.parametrize("structure", ["feedback", "two-degree"])
def test_the_compiled_header_is_the_controller_of_the_json(structure, tmp_path):
    """Without a warning of the compiler, and the same command over 10,000 samples to 1e-9 of the largest."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        pytest.skip("no C compiler here: the header cannot be compiled")
    controller = designed(STATED, structure).controller
    (tmp_path / "controller.h").write_text(as_header(controller))
    (tmp_path / "main.c").write_text(PROGRAM)
    strict = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-O2")
    subprocess.run([compiler, *strict, "main.c", "-o", "controller"], cwd=tmp_path, check=True)
    said = "\n".join(f"{d!r} {y!r}" for d, y in inputs().tolist())
    done = subprocess.run([tmp_path / "controller"], input=said, capture_output=True, text=True, check=True)
    found, wanted = np.array(done.stdout.split(), dtype=float), of_json(controller)
    assert len(found) == SAMPLES
    assert np.abs(found - wanted).max() <= 1e-9 * np.abs(wanted).max()


def test_a_name_cannot_break_out_of_the_headers_comment():
    """What a target's file calls it stays a comment."""
    controller = designed(STATED, "feedback").controller
    named = SampledController(
        controller.A, controller.B, controller.C, controller.D, controller.sample_rate, '*/ #include "γ"\n\\'
    )
    assert as_header(named).splitlines()[0] == '/* * / #include "-"-/'
