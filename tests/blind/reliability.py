"""How sure a verdict was against whether it was right: of what is said at p a share p has to be right.

python -m tests.blind.reliability FILE …      rows of trials that tell `probability` and `right`

For all trials and for each kind: the mean of p and the share that was right; z of Spiegelhalter (1986), which is a
standard normal where p is calibrated; the slope of the log-odds of being right over those of p (Cox 1958), 1 where it
is; and the area under the curve of p for right against wrong.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.blind.interval import interval

Array = NDArray[np.float64]
BINS = (0.0, 0.2, 0.5, 0.8, 0.95, 0.99, 1.0)
_LEAST = 1e-3  # log-odds of 0 and 1 have no end
_STEPS = 25
_COLUMNS = "kind, trials, mean p, share right, Spiegelhalter's z, slope, area under the curve"


def said(rows: Sequence[dict[str, Any]]) -> list[tuple[str, float, bool]]:
    """Kind, probability and whether it is right of each verdict that says how sure it is."""
    return [
        (row.get("trial") or ("periodic" if "periods" in row else row["kind"]), float(row["probability"]), row["right"])
        for row in rows
        if row.get("probability") is not None and isinstance(row.get("right"), bool)
    ]


def spiegelhalter(p: Array, right: Array) -> float:
    """Σ (y − p)(1 − 2p) / √Σ (1 − 2p)² p (1 − p)."""
    variance = float(np.sum((1 - 2 * p) ** 2 * p * (1 - p)))
    return float(np.sum((right - p) * (1 - 2 * p)) / np.sqrt(variance)) if variance > 0 else 0.0


def slope(p: Array, right: Array) -> float:
    """b of the logistic regression of being right on a + b logit p, by Newton's steps; nan where one is never seen."""
    if not 0 < right.sum() < len(right):
        return float("nan")
    X = np.column_stack([np.ones(len(p)), np.log(p / (1 - p))])
    ab = np.array([0.0, 1.0])
    for _ in range(_STEPS):
        fitted = 1 / (1 + np.exp(-np.clip(X @ ab, -30, 30)))
        H = X.T @ (X * (fitted * (1 - fitted))[:, None])
        ab = ab + np.clip(np.linalg.lstsq(H, X.T @ (right - fitted), rcond=None)[0], -1, 1)
    return float(ab[1])


def area(p: Array, right: Array) -> float:
    """The share of pairs, one right and one wrong, of which the right one was said more surely (Mann and Whitney)."""
    yes, no = p[right > 0], p[right == 0]
    if not len(yes) or not len(no):
        return float("nan")
    return float(np.mean((yes[:, None] > no) + 0.5 * (yes[:, None] == no)))


def table(stated: Sequence[tuple[str, float, bool]]) -> Iterator[str]:
    """Of what was said at so much how much is right, and the figures of all trials and of each kind."""
    p = np.clip(np.array([one[1] for one in stated]), _LEAST, 1 - _LEAST)
    right = np.array([one[2] for one in stated], dtype=np.float64)
    yield "| said | verdicts | mean p | right | rate in % (95 % interval) |"
    yield "|---|---|---|---|---|"
    for low, high in pairwise(BINS):
        inside = (p >= low) & (p < high) if high < 1 else p >= low
        if inside.any():
            hits, count = int(right[inside].sum()), int(inside.sum())
            lower, upper = interval(hits, count)
            yield (
                f"| {low:g} to {high:g} | {count} | {p[inside].mean():.2f} | {hits} of {count} | "
                f"{100 * hits / count:.1f} ({100 * lower:.0f}-{100 * upper:.0f}) |"
            )
    yield f"\n| {' | '.join(_COLUMNS.split(', '))} |"
    yield "|---|---|---|---|---|---|---|"
    for kind in ("all", *sorted({one[0] for one in stated})):
        of = np.array([kind in ("all", one[0]) for one in stated])
        q, y = p[of], right[of]
        figures = (f"{q.mean():.3f}", f"{y.mean():.3f}", *(f"{f(q, y):.2f}" for f in (spiegelhalter, slope, area)))
        yield f"| {kind} | {of.sum()} | {' | '.join(figures).replace('nan', '–')} |"


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path)
    rows = [json.loads(line) for file in parser.parse_args().files for line in file.read_text().splitlines()]
    print("\n".join(table(said(rows))))


if __name__ == "__main__":
    main()
