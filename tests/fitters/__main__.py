"""`python -m tests.fitters`: compare the methods of a search by their own answers, and renew docs/accuracy.md.

Data are those of the independent references. Seeds 0 to 4 on Qian's actuator, 0 on Kononykhin's.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from tests.acceptance.matrices import SHORT, as_matrix, records_of
from tests.bench.sets import as_matrix as bench_matrix
from tests.bench.sets import true_model
from tests.fitters.own_answer import OwnAnswer, of_bench, of_qian
from tests.reference import kononykhin_reference, qian_reference

PAGE = Path(__file__).resolve().parents[2] / "docs" / "accuracy.md"
SEEDS = 5
QIAN = ("ga", "paper-ga", "differential-evolution", "cma-es")
BENCH = ("gradient", *QIAN)
BENCH_SEED = 3
"""Of the actuator and its records."""
_COMPARED = ("T", "B", "kp", "dPfr")


def qian_rows() -> Iterator[tuple[str, list[OwnAnswer]]]:
    """A row a method: the paper's 63 runs of 2 s with 0.5 % noise."""
    matrix = as_matrix(records_of(SHORT, "linear"), "linear")
    plant = qian_reference.Plant()
    truth = {name: getattr(plant, name) for name in ("Z0", "tau", "m0", "c0", "Ka", "Cl")}
    for method in QIAN:
        yield method, [of_qian(matrix, method, seed, truth) for seed in range(SEEDS)]


def bench_rows() -> Iterator[tuple[str, list[OwnAnswer]]]:
    """A row a method: the short set of an actuator about the middle."""
    truth = kononykhin_reference.scattered(BENCH_SEED)
    matrix = bench_matrix(truth, kononykhin_reference.full_set(truth, BENCH_SEED, short=True))
    known = true_model(truth).values()
    for method in BENCH:
        yield method, [of_bench(matrix, method, 0, {name: known[name] for name in _COMPARED})]


def table(rows: Sequence[tuple[str, list[OwnAnswer]]]) -> str:
    """Medians over the seeds; the time as a multiple of that of `ga`."""
    usual = next(np.median([one.seconds for one in found]) for method, found in rows if method == "ga")
    lines = [
        "| method | error of its own answer | worst parameter off by | evaluations | time, `ga` = 1 |",
        "|---|---|---|---|---|",
    ]
    for method, found in rows:

        def of(value: Callable[[OwnAnswer], float], found: list[OwnAnswer] = found) -> float:
            return float(np.median([value(one) for one in found]))

        lines.append(
            f"| `{method}` | {100 * of(lambda one: one.error):.3g} % | {100 * of(lambda one: one.off):.2g} % | "
            f"{of(lambda one: one.evaluations):,.0f} | {of(lambda one: one.seconds) / usual:.2g} |"
        )
    return "\n".join(lines)


def renewed(page: str, name: str, text: str) -> str:
    """The page with a table in the place of that between its marks."""
    begin, end = f"<!-- {name} -->\n", f"\n<!-- end of {name} -->"
    found = re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: begin + text + end, page, flags=re.DOTALL)
    if begin not in found:
        raise ValueError(f"the page has no marks of {name}")
    return found


def main() -> None:
    """Measure, print, and write the page."""
    for name, rows in (("fitters of qian2014", qian_rows), ("fitters of kononykhin", bench_rows)):
        text = table(list(rows()))
        print(text, flush=True)
        PAGE.write_text(renewed(PAGE.read_text(encoding="utf-8"), name, text), encoding="utf-8")


if __name__ == "__main__":
    main()
