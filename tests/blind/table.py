"""The table of the blind trials, made from their rows:  python -m tests.blind.table  writes docs/blind-trials.md."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from tests.blind.campaign import OUT, rows
from tests.blind.fresh_table import FRESH, fresh
from tests.blind.interval import interval
from tests.blind.lags_table import ROWS as LAGS
from tests.blind.lags_table import lag_rates
from tests.blind.noises import NOISES
from tests.blind.various_table import ROWS as VARIOUS
from tests.blind.various_table import rates

PAGE = OUT.with_suffix(".md")
LABS = OUT.with_name("blind-labs.jsonl")
PERIODIC = OUT.with_name("blind-periodic.jsonl")
Row = dict[str, Any]
GOALS = {"one full": 97, "one small": 90, "none full": 98, "none small": 98, "two full": 92, "two small": 92,
         "three full": 80, "three small": 80, "outside full": 90, "own full": 100, "label full": 95}  # fmt: skip
_WORDS = {
    "one": "one effect hidden",
    "none": "nothing hidden",
    "two": "two effects",
    "three": "three effects",
    "outside": "an effect that is not listed",
    "own": "the same, written as an equation",
    "label": "a wrong label on one run",
}


def rate(found: Sequence[Row]) -> str:
    """Hits, trials, rate with its interval; dashes where nothing was tried."""
    if not found:
        return "– | –"
    hits = sum(row["named"] for row in found)
    lower, upper = interval(hits, len(found))
    return f"{hits} of {len(found)} | {100 * hits / len(found):.1f} ({100 * lower:.0f}-{100 * upper:.0f})"


def summary(tried: Sequence[Row]) -> Iterable[str]:
    """One line a kind of trial and matrix."""
    columns = "hidden, matrix, named, rate in % (95 % interval), goal in %, mean group, strength off in % (median), "
    columns += "verify / floor (median), at most 1.05 in %"
    yield f"| {' | '.join(columns.split(', '))} |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for key, goal in GOALS.items():
        kind, matrix = key.split()
        found = [row for row in tried if row["kind"] == kind and row["matrix"] == matrix]
        if found:
            groups = np.mean([np.mean([len(group) for group in row["groups"]] or [1]) for row in found])
            misses = [
                abs(row["strengths"][n] / value - 1)
                for row in found
                if row["kind"] not in ("outside", "label")
                for n, value in row["hidden"].items()
                if n in row["strengths"]
            ]
            strength = f"{100 * np.median(misses):.2f}" if misses else "–"
            verify = [row["verify"] for row in found]
            ends = f"{np.median(verify):.3f} | {100 * np.mean(np.array(verify) <= 1.05):.1f}"
            yield f"| {_WORDS[kind]} | {matrix} | {rate(found)} | {goal} | {groups:.2f} | {strength} | {ends} |"


def levels(tried: Sequence[Row]) -> Iterable[str]:
    """One effect hidden, by noise and by how far the linear model is off."""
    yield "| matrix | noise | linear error / floor | named | rate in % (95 % interval) |"
    yield "|---|---|---|---|---|"
    singles = [row for row in tried if row["kind"] == "one"]
    for cell in sorted({(row["matrix"], row["noise"], row["level"]) for row in singles}):
        found = [row for row in singles if (row["matrix"], row["noise"], row["level"]) == cell]
        yield f"| {cell[0]} | {100 * cell[1]:g} % | {cell[2]:g} | {rate(found)} |"


def noises(tried: Sequence[Row]) -> Iterable[str]:
    """Noise of some kind, with nothing hidden, what was named or proposed, and with one effect."""
    columns = "noise, matrix, nothing hidden: nothing named, rate in %, nothing proposed, "
    columns += "one effect hidden: named, rate in %"
    yield f"| {' | '.join(columns.split(', '))} |"
    yield "|---|---|---|---|---|---|---|"
    for kind, matrix in product(NOISES, ("full", "small")):
        found = [row for row in tried if row.get("of") == kind and row["matrix"] == matrix]
        none, one = ([row for row in found if bool(row["hidden"]) is wanted] for wanted in (False, True))
        searched = [row for row in none if "proposed" in row]
        silent = f"{sum(not row['proposed'] for row in searched)} of {len(searched)}" if searched else "–"
        if found:
            yield f"| {kind.replace('_', '-')} | {matrix} | {rate(none)} | {silent} | {rate(one)} |"


def cluttered(tried: Sequence[Row]) -> Iterable[str]:
    """One strong effect among weak ones: it is named, and no name is in no class of what is hidden."""
    columns = "matrix, strong one named, rate in %, no other name, rate in %, verify ≤ 1.1 where the truth is 1.05"
    yield f"| {' | '.join(columns.split(', '))} |"
    yield "|---|---|---|---|---|---|"
    for matrix in ("full", "small"):
        found = [row for row in tried if (row["kind"], row["matrix"]) == ("clutter", matrix)]
        if found:
            reached = [row for row in found if row["oracle"] <= 1.05]
            at_floor = sum(row["verify"] <= 1.1 for row in reached)
            clean = rate([{"named": row["clean"]} for row in found])
            yield f"| {matrix} | {rate(found)} | {clean} | {at_floor} of {len(reached)} |"


def confusion(tried: Sequence[Row]) -> Iterable[str]:
    """What was named for each hidden effect."""
    yield "| hidden | named (trials) |"
    yield "|---|---|"
    singles = [row for row in tried if row["kind"] == "one"]
    for name in sorted({next(iter(row["hidden"])) for row in singles}):
        said = Counter(" + ".join(row["found"]) or "nothing" for row in singles if name in row["hidden"])
        yield f"| {name} | {', '.join(f'{what} ({count})' for what, count in said.most_common())} |"


def unreachable(everything: Sequence[Row]) -> Iterable[str]:
    """Cells in which the bounds of the catalogue do not allow the wanted error."""
    yield "| effect | matrix | noise | wanted / floor | largest / floor |"
    yield "|---|---|---|---|---|"
    for row in everything:
        if not row.get("reachable", True):
            name = next(iter(row["hidden"]))
            largest = row["linear_error"] / row["noise"]
            yield f"| {name} | {row['matrix']} | {100 * row['noise']:g} % | {row['level']:g} | {largest:.2f} |"


def labs(everything: Sequence[Row]) -> Iterable[str]:
    """Machines that nobody described, drawn from all structures: how often each thing was right."""
    yield "Each hundred of seeds was tried as the program stood then, each seed once with and once without an effect.\n"
    yield "| seeds | what | right | rate in % (95 % interval) | goal in % |"
    yield "|---|---|---|---|---|"
    for hundred in sorted({row["seed"] // 100 for row in everything}):
        tried = [row for row in everything if row["seed"] // 100 == hundred]
        seeds = f"{tried[0]['seed']} to {tried[-1]['seed']}"
        hidden, sound = [row for row in tried if row["counts"]], [row for row in tried if not row["hidden"]]
        for what, goal, right in (
            ("the structure, or a simpler one within half of the noise", 90, [row["right"] for row in tried]),
            ("the hidden effect named, of those worth 15 nats", 90, [row["named"] for row in hidden]),
            ("nothing found where nothing is hidden", 97, [row["standing"] != "found" for row in sound]),
        ):
            if right:
                yield f"| {seeds} | {what} | {rate([{'named': hit} for hit in right])} | {goal} |"
    for row in everything:
        said = f"seed {row['seed']}, {row['structure']}, {row['kind']}"
        if row["counts"] and not row["named"]:
            yield f"\nMissed: {said}: {row['hidden']}, told as {', '.join(row['effects']) or 'nothing'}."
        if not row["right"]:
            yield f"\nTaken for another machine: {said}, {row['hidden'] or 'nothing'} hidden: {row['model']}."


def periodic(everything: Sequence[Row]) -> Iterable[str]:
    """Periodic tests: how often what is named is among what the test allows, what was dropped, what was missed."""
    yield "| counts as | of | right | rate in % (95 % interval) | goal in % |"
    yield "|---|---|---|---|---|"
    for counts, goal, keys in (("hidden", 95, ("machine", "wave", "hidden")), ("nothing", 97, ("machine", "wave"))):
        found = [row for row in everything if "right" in row and row["counts"] == counts]
        yield f"| {counts} | all | {rate([{'named': row['right']} for row in found])} | {goal} |"
        for key in keys:
            for value in sorted({row[key] for row in found}):
                of = rate([{"named": row["right"]} for row in found if row[key] == value])
                yield f"| {counts} | {value or 'nothing hidden'} | {of} | |"
    drawn = [row for row in everything if row["kind"] == "hidden"]
    if drawn:
        out = Counter(row["counts"] for row in drawn)
        yield (
            f"\nOf {len(drawn)} tests with something hidden {out['hidden']} count as hidden, {out['nothing']} as "
            f"nothing, {out['dropped']} ({100 * out['dropped'] / len(drawn):.0f} %) were dropped before it ran."
        )
    for row in everything:
        if row.get("right") is False:
            yield (
                f"\nMissed: {row['kind']}, seed {row['seed']}, {row['machine']}, {row['wave']}, {row['samples']:g} "
                f"samples a period, {row['periods']} periods, {100 * row['noise']:.2g} % noise: "
                f"{row['hidden'] or 'nothing'} hidden, the test allows {', '.join(row['class']) or 'nothing'}; named "
                f"{', '.join(row['named']) or 'nothing'} ({row['why']})."
            )


def page(everything: Sequence[Row]) -> str:
    """The whole page."""
    tried = [row for row in everything if row.get("reachable", True) and not row.get("void")]
    parts: list[tuple[str, Callable[[Sequence[Row]], Iterable[str]], Sequence[Row]]] = [
        ("Fresh seeds of every kind", fresh, rows(FRESH)),
        ("Rates", summary, tried),
        ("One effect, by noise and size", levels, tried),
        ("Noise of other kinds", noises, tried),
        ("One strong effect among weak ones", cluttered, tried),
        ("What was named", confusion, tried),
        ("Unreachable", unreachable, everything),
        ("Machines that nobody described", labs, rows(LABS)),
        ("Periodic tests", periodic, rows(PERIODIC)),
        ("Machines of many kinds, missing inputs and oscillations", rates, rows(VARIOUS)),
        ("What follows like a lag", lag_rates, rows(LAGS)),
    ]
    head = (
        "# Blind trials\n\nWritten by `python -m tests.blind.table` from blind-trials.jsonl. Data come from the "
        "independent reference with parameters drawn anew for each trial; the seed of each stands in its row. `named`: "
        "the verdict is the hidden set, each effect itself or in a group of at most three. For an effect that is not "
        "listed: not a confident wrong name, unless the error is at the floor; written as an equation: it is named and "
        "the error falls to 1.1 times the floor. A row that is `void`, for the reason that stands there, is not "
        "counted. Machines that nobody described are drawn by `python -m tests.blind.any_trial` from all structures; "
        "their rows stand in blind-labs.jsonl. Periodic tests, dampers, specimens, drives, motors and position loops "
        "under sines, triangles and repeated steps, are drawn by `python -m tests.blind.periodic_trial`; their rows "
        "stand in blind-periodic.jsonl. What such a test allows is decided before the program runs: its own reference "
        "fits every effect of the catalogue, base and shape free, to the output without noise. The class is every "
        "effect that leaves d² ≤ 20, the sum of squares over the variance of the noise. A test counts as hidden where "
        "the base alone leaves d² ≥ 60 and 1.1 floors and the class holds at most three, as nothing where the base "
        "is in the class; others are dropped. A verdict is right where every name is in the class, or in a group that "
        "lies in the class and holds the truth. Fresh seeds of every kind are tried one of each in turn by `python -m "
        "tests.blind.fresh`; their rows stand in blind-fresh.jsonl. The rates that follow are older. Machines of many "
        "kinds, some of which lack an input or oscillate by themselves, are drawn by `python -m "
        "tests.blind.various_trial`; their rows stand in blind-various.jsonl. What a record shows is decided before "
        "the program runs: the machine without the effect, refitted, leaves d² ≥ 60 and 1.1 floors of a run that it "
        "never saw; the missing input sets out six times while all else has settled; the record holds ten periods. "
        "What follows its command like a lag is drawn by `python -m tests.blind.lags`: blind-lags.jsonl.\n"
    )
    return head + "\n".join(f"\n## {title}\n\n" + "\n".join(make(of)) + "\n" for title, make, of in parts)


def main(path: Path = OUT) -> None:
    """Write the page."""
    PAGE.write_text(page(rows(path)))


if __name__ == "__main__":
    main()
