"""The lines of a kernel as machine code, against the same lines in plain Python, lane by lane."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ident.simulation.kernel.machine_code import LANES, advance

ROWS, STEPS = 8, 37
PLAIN = {name: getattr(math, name) for name in ("sqrt", "pow", "sin", "cos", "tanh")}


def by_hand(lines, fed, shown, b, records, at, first, last, every):
    """What the lines do, one lane after the other."""
    b, shown_values = b.copy(), []
    for k in range(first, last):
        for lane in range(LANES):
            names = {"b": b, "lane": lane, "k": k, **PLAIN}
            for row, array, column, columns in fed:
                b[row * LANES + lane] = records[array][(at[array][lane] + k + 1) * columns + column]
            for line in lines:
                exec(line, {"__builtins__": {}}, names)
        if k % every == 0:
            shown_values.append(b[shown * LANES : (shown + 1) * LANES].copy())
    return b, np.array(shown_values)


def with_machine(lines, fed, shown, b, records, at, first, last, every):
    b, count = b.copy(), last // every + 1
    out = np.full((count, 2 * LANES), np.nan)
    advance(tuple(lines), tuple(fed), shown)(
        b,
        records["commands"],
        records["forces"],
        at["commands"],
        at["forces"],
        first,
        last,
        every,
        out.ravel(),
        2 * LANES,
    )
    assert np.all(np.isnan(out[:, LANES:]))
    return b, out[~np.isnan(out[:, 0]), :LANES]


def given(seed):
    rng = np.random.default_rng(seed)
    b = rng.uniform(-1, 1, ROWS * LANES)
    records = {name: rng.standard_normal(3 * (STEPS + 20)) for name in ("commands", "forces")}
    at = {name: rng.integers(0, 10, LANES) for name in ("commands", "forces")}
    return b, records, at


def row(number: int) -> str:
    return f"b[{number * LANES} + lane]"


CASES = {
    "arithmetic": [f"x = {row(0)}", f"y = 0.5 * (x - {row(1)}) / (2.0 + x * x) + -x", f"{row(3)} = y + +x"],
    "choice": [
        f"x = {row(0)}",
        f"z = {row(2)}",
        f"{row(3)} = (x if x >= 0.0 else -x) * (1.0 if z > 0.1 else (-1.0 if "
        "z < -0.1 else 0.0)) + (2.0 if x != z else 3.0) + (x if x <= z else z) + (1.0 if x == x else 0.0)",
    ],
    "functions": [f"x = {row(0)}", "y = x * x", f"{row(3)} = sqrt(y) + pow(y, 1.7) + sin(x) + cos(3.0 * x) + tanh(x)"],
    "state": [
        f"x = {row(0)}",
        f"{row(0)} = 0.9 * x + 0.1 * {row(2)}",
        f"{row(3)} = {row(0)}",
        f"{row(0)} = {row(0)} * x",
    ],
    "many inputs": [f"{row(3)} = {row(2)} + 10.0 * {row(5)} + 100.0 * {row(6)}"],
    "time": [f"{row(3)} = {row(0)} * sin(0.1 * (k + 0.5)) + k"],
    "names again": [f"x = {row(0)}", "x = x + 1.0", f"{row(0)} = 0.5 * x", f"{row(3)} = x * {row(1)}"],
}

FED = {
    "state": [(2, "commands", 0, 1), (5, "forces", 0, 1)],
    "many inputs": [(2, "commands", 0, 1), (5, "forces", 2, 3), (6, "forces", 0, 3)],
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(("first", "last", "every"), [(0, STEPS, 1), (4, 33, 4), (5, 5, 1)])
def test_the_machine_does_what_the_lines_say(name, first, last, every):
    fed = FED.get(name, [(2, "commands", 0, 1)])
    job = (CASES[name], fed, 3, *given(7), first, last, every)
    for found, wanted in zip(with_machine(*job), by_hand(*job), strict=True):
        assert found.shape == wanted.shape or not wanted.size
        assert found.ravel() == pytest.approx(wanted.ravel(), rel=1e-13, abs=1e-14)


def test_the_same_lines_give_the_same_digits_wherever_memory_lies():
    job = (CASES["functions"], [(2, "commands", 0, 1)], 3, *given(8), 0, STEPS, 1)
    first = with_machine(*job)[1]
    kept = []
    for offset in range(1, 9):
        kept.append(np.empty(offset * 1000 + 1))
        assert np.array_equal(with_machine(*job)[1], first)


@pytest.mark.parametrize(
    "line",
    [
        "x = __import__('os')",
        "x = open",
        "x.y = 1.0",
        "x = [1.0]",
        "b[lane] = 1.0",
        "x = exp(1.0)",
        "import os",
        "x = 1.0 if (2.0 < 3.0 < 4.0) else 2.0",
        "x = y",
    ],
)
def test_nothing_else_is_a_line(line):
    with pytest.raises((TypeError, KeyError)):
        advance((line,), (), 0)
