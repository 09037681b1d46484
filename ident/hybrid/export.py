"""A controller as files: JSON to read again, MAT for MATLAB and Octave, a C header to compile into a rig."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from typing import Any

import numpy as np
import scipy.io
from numpy.typing import NDArray

from ident.hybrid.controller import SampledController

Array = NDArray[np.float64]


def as_mat(controller: SampledController) -> bytes:
    """A MAT file, version 5: A, B, C, D, sample_rate (Hz), Ts (s) and name, for ``ss(A, B, C, D, Ts)``."""
    held = {name: getattr(controller, name) for name in ("A", "B", "C", "D")}
    rate: dict[str, Any] = {"sample_rate": controller.sample_rate, "Ts": 1.0 / controller.sample_rate}
    file = io.BytesIO()
    scipy.io.savemat(file, {**held, **rate, "name": controller.name}, format="5")
    return file.getvalue()


def as_header(controller: SampledController) -> str:
    """A C header (C99 and C++) without a library: numbers, a state and one step a sample.

    Numbers have 17 digits, which is every bit of them.
    """
    tables = "\n".join(_table(name, getattr(controller, name)) for name in ("A", "B", "C", "D"))
    said = re.sub(r"[^ -~]", "-", controller.name).replace("*/", "* /").replace("\\", "/")
    return _HEADER.format(name=said, rate=_number(controller.sample_rate), order=controller.order, tables=tables)


def _table(name: str, matrix: Array) -> str:
    values: Iterable[float] = matrix.ravel() if matrix.size else [0.0]  # C has no array of nothing
    lines = ",\n    ".join(_number(value) for value in values)
    return f"static const double servoident_{name}[] = {{\n    {lines}\n}};"


def _number(value: float) -> str:
    return f"{value:.17e}"


_HEADER = """/* {name}
 *
 * x(k+1) = A x(k) + B [d(k), y(k)],  u(k) = C x(k) + D [d(k), y(k)]
 * d wanted, y measured displacement, u command of the actuator, all in m; call once every 1/SERVOIDENT_SAMPLE_RATE s:
 *
 *     servoident_controller c;
 *     servoident_reset(&c);
 *     u = servoident_step(&c, d, y);
 */
#ifndef SERVOIDENT_CONTROLLER_H
#define SERVOIDENT_CONTROLLER_H

#define SERVOIDENT_ORDER {order}
#define SERVOIDENT_SAMPLE_RATE {rate} /* Hz */

/* row by row */
{tables}

typedef struct {{
    double x[SERVOIDENT_ORDER + 1];
}} servoident_controller;

static void servoident_reset(servoident_controller *c)
{{
    int i;
    for (i = 0; i <= SERVOIDENT_ORDER; i++)
        c->x[i] = 0.0;
}}

static double servoident_step(servoident_controller *c, double d, double y)
{{
    double next[SERVOIDENT_ORDER + 1];
    double u = servoident_D[0] * d + servoident_D[1] * y;
    int i, j;
    for (i = 0; i < SERVOIDENT_ORDER; i++) {{
        u += servoident_C[i] * c->x[i];
        next[i] = servoident_B[2 * i] * d + servoident_B[2 * i + 1] * y;
        for (j = 0; j < SERVOIDENT_ORDER; j++)
            next[i] += servoident_A[i * SERVOIDENT_ORDER + j] * c->x[j];
    }}
    for (i = 0; i < SERVOIDENT_ORDER; i++)
        c->x[i] = next[i];
    return u;
}}

#endif
"""
