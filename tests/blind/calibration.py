"""Probabilities against the truth: the numbers fitted to trials, and judged on others.

python -m tests.blind.calibration --fit FILE …      rows of trials to fit to
python -m tests.blind.calibration FILE …            rows of trials to judge by the numbers as they are

A trial tells for each effect that was refitted, for "nothing" and for "unlisted", how probable it was said to be, and
whether it is true. Each trial with something hidden is one more with the truth taken off the list: then something
unlisted acts. One with several hidden effects is one more with each of them off the list, and the others on it. What
is said is judged by its mean against the share that is right, and by Spiegelhalter's z.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.diagnosis.evidence.probability import NOTHING, SetGains, probabilities

NUMBERS = ("learning_rate", "effect_prior", "unlisted_share", "unlisted_prior", "unlisted_beside_listed")
"""Those that are fitted."""
_OFF, _PART = "off the list", "one of several off the list"
OFF_THE_LIST = 0.25
"""Weight of a trial with its truth, or one of its effects, off the list: so something unlisted acts in one of five."""
_LEAST = 1e-4  # a probability in a score: a program that said 0 of what is true would score without end
BINS = (0.0, 0.01, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99, 1.0)


@dataclass(frozen=True)
class Case:
    """What was refitted in a trial, and what is true: the hidden effects, and whether something unlisted acts."""

    kind: str
    sets: SetGains
    hidden: frozenset[str]
    unlisted: bool

    def stated(self, criteria: EvidenceCriteria) -> list[tuple[str, float, bool]]:
        """Each statement with its probability, and whether it is true."""
        found = probabilities(self.sets, criteria)
        names = [(name, p, name in self.hidden) for name, p in found.effects.items()]
        nothing = not self.hidden and not self.unlisted
        return [*names, ("nothing", found.nothing, nothing), ("unlisted", found.unlisted, self.unlisted)]

    def without_truth(self) -> Case | None:
        """The same with the hidden effects off the list."""
        left = {of: gain for of, gain in self.sets.gains.items() if not of & self.hidden}
        if not self.hidden or len(left) < 2:
            return None
        return replace(self, sets=SetGains(left, self.sets.most), hidden=frozenset(), unlisted=True)

    def without_one_effect(self) -> Iterator[Case]:
        """The same with one of several hidden effects off the list, each in turn."""
        for gone in sorted(self.hidden) if len(self.hidden) > 1 else ():
            left = {of: gain for of, gain in self.sets.gains.items() if gone not in of}
            if len(left) > 1:
                yield replace(self, sets=SetGains(left, self.sets.most), hidden=self.hidden - {gone}, unlisted=True)


def case(row: dict[str, Any]) -> Case | None:
    """A row of any kind of trial; None of one that says nothing, or was not reachable."""
    if "effect_sets" not in row or not row["effect_sets"] or not row.get("reachable", True):
        return None
    if row.get("counts") in ("dropped", False) and row.get("hidden"):
        return None
    gains = {frozenset(effects): nats for effects, nats in row["effect_sets"]}
    kind = row.get("trial") or ("periodic" if "periods" in row else row.get("kind", "machine"))
    off_the_list = kind in ("outside", "unlisted", "left out") or bool(row.get("outside"))
    return Case(kind, SetGains({NOTHING: 0.0} | gains, row["most_nats"]), _hidden(kind, row), off_the_list)


def _hidden(kind: str, row: dict[str, Any]) -> frozenset[str]:
    """The effects of the list that act in a trial: none where a label is wrong, or what acts is on no list."""
    hidden = row["hidden"]
    if kind in ("outside", "unlisted", "left out", "label") or row.get("counts") == "nothing":
        return frozenset()
    return frozenset(hidden) if isinstance(hidden, dict) else frozenset({hidden} - {"", "nothing", None})


def cases(files: Iterable[Path]) -> Iterator[Case]:
    """Those of files of rows, and each without its truth."""
    for file in files:
        for line in file.read_text(encoding="utf-8").splitlines():
            found = case(json.loads(line))
            if found is None:
                continue
            yield found
            if (other := found.without_truth()) is not None:
                yield replace(other, kind=_OFF)
            yield from (replace(other, kind=_PART) for other in found.without_one_effect())


def score(given: Sequence[Case], criteria: EvidenceCriteria) -> float:
    """Weighted mean over cases of −ln p of what is true, all statements together: less is better."""
    total, weights = 0.0, 0.0
    for one in given:
        weight = OFF_THE_LIST if one.kind in (_OFF, _PART) else 1.0
        weights += weight
        for _, p, true in one.stated(criteria):
            said = float(np.clip(p, _LEAST, 1 - _LEAST))
            total -= weight * float(np.log(said if true else 1 - said))
    return total / weights


def fitted(given: Sequence[Case]) -> EvidenceCriteria:
    """The numbers with the least score."""

    def at(point: np.ndarray) -> EvidenceCriteria:
        return replace(EVIDENCE_CRITERIA, **dict(zip(NUMBERS, map(float, np.exp(point)), strict=True)))

    start = np.log([getattr(EVIDENCE_CRITERIA, name) for name in NUMBERS])
    end = minimize(lambda point: score(given, at(point)), start, method="Nelder-Mead", options={"xatol": 0.01})
    return at(end.x)


def table(given: Sequence[Case], criteria: EvidenceCriteria) -> str:
    """How probable what was said was, and how much of it is true; by kind."""
    stated = [(one.kind, name, p, true) for one in given for name, p, true in one.stated(criteria)]
    lines = ["| said | statements | right |", "| --- | --- | --- |"]
    p, true = np.array([s[2] for s in stated]), np.array([s[3] for s in stated])
    for low, high in pairwise(BINS):
        inside = (p >= low) & ((p < high) | (high == 1.0))
        if inside.any():
            lines.append(f"| {low:g} to {high:g} | {inside.sum()} | {100 * true[inside].mean():.1f} % |")
    lines += [
        "",
        "| kind | cases | mean p | share right | z | Spiegelhalter's z |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for kind in ("all", *sorted({s[0] for s in stated})):
        of = np.array([kind in ("all", s[0]) for s in stated])
        q, y = np.clip(p[of], _LEAST, 1 - _LEAST), true[of]
        z = float(np.sum(y - q) / np.sqrt(np.sum(q * (1 - q))))
        weights = 1 - 2 * q
        spiegelhalter = float(np.sum((y - q) * weights) / np.sqrt(np.sum(weights**2 * q * (1 - q))))
        count = len(given) if kind == "all" else sum(one.kind == kind for one in given)
        lines.append(f"| {kind} | {count} | {q.mean():.3f} | {y.mean():.3f} | {z:.1f} | {spiegelhalter:.1f} |")
    lines += ["", f"Score {score(given, criteria):.3f} nats a case."]
    return "\n".join(lines)


def main() -> None:
    """Fit or judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--fit", action="store_true")
    options = parser.parse_args()
    given = list(cases(options.files))
    criteria = fitted(given) if options.fit else EVIDENCE_CRITERIA
    print(", ".join(f"{name} = {getattr(criteria, name):.3g}" for name in NUMBERS))
    print(table(given, criteria))


if __name__ == "__main__":
    main()
