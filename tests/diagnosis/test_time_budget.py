"""After the time limit no simulation begins, in any stage; told by events: a clock that jumps at the n-th batch."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from itertools import islice
from typing import Any

import numpy as np
import pytest

from ident.diagnosis.discovery.search import TermSearch
from ident.diagnosis.discovery.term_library import TermLibrary
from ident.diagnosis.result import Diagnosis
from ident.errors import TimeIsUp
from ident.fit.result import FitResult
from ident.fit.simulated_runs import every_run
from ident.matrix import Matrix
from ident.parallel import each
from ident.presets import preset
from ident.progress import Progress
from ident.simulation import recursion, simulate
from ident.time_budget import TimeBudget
from ident.workflows import diagnose, identify
from tests.blind.machines import Machine
from tests.conftest import rank_only
from tests.diagnosis.vary import vary
from tests.reference import qian_reference as linear

FEW = ("dead_zone", "command_delay")
LIMIT = 60.0
MODEL = preset("qian2014", ("dead_zone",))


@cache
def matrix() -> Matrix:
    """Five runs of half a second, with a dead zone, and something that the few effects do not hold."""
    hidden = {"dead_zone": 2.5e-4, "coulomb_friction": 60.0}
    return Machine(linear.Plant(), hidden, 0.01, small=True, seed=20).measured(seconds=0.25, every=6)


@dataclass
class Events:
    """The batches of simulations that were begun, each by its stage; at the `last` of them the time is over."""

    last: int | None = None
    now: float = 0.0
    stage: str = "fit"
    stages: list[str] = field(default_factory=list)
    late: int = 0
    counts: dict[str, tuple[int, int]] = field(default_factory=dict)

    def begun(self) -> None:
        self.late += self.now > LIMIT
        self.stages.append(self.stage)
        if len(self.stages) == self.last:
            self.now = 2 * LIMIT

    def report(self, progress: Progress) -> None:
        self.stage = progress.stage
        self.counts[self.stage] = progress.done, progress.total

    @property
    def budget(self) -> TimeBudget:
        return TimeBudget(LIMIT, lambda: self.now)


class Counted:
    """Work on one core, whose batches are counted where the compiled code is called."""

    def __init__(self) -> None:
        self.events = Events()

    def telling(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, which tells of each batch before it begins."""

        def called(*given: Any) -> Any:
            self.events.begun()
            return function(*given)

        return called

    def fit(self) -> tuple[FitResult, int]:
        """A fit, and the number of its batches."""
        self.events = Events()
        return identify(matrix()), len(self.events.stages)

    def diagnosis(
        self, last: int | None = None, propose: bool = True, fit: FitResult | None = None
    ) -> tuple[Diagnosis, Events]:
        """A diagnosis whose time is over at the `last` batch, and its batches."""
        self.events = events = Events(last)
        found = diagnose(matrix(), fit, most=1, propose=propose, report=events.report, budget=events.budget)
        return found, events


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Counted:
    """Diagnoses of few effects, and few terms."""
    work = Counted()
    monkeypatch.setattr("ident.parallel._idle", lambda: threading.Semaphore(0))
    rank_only(monkeypatch, FEW)

    # Of the search for terms a few steps: it is the same loop for many.
    every = TermLibrary.terms
    monkeypatch.setattr(TermLibrary, "terms", lambda of: islice(every(of), 60))
    vary(monkeypatch, "discovery", classes=1, of_a_kind=0)
    monkeypatch.setattr(TermSearch, "_drawn", lambda *_: None)

    kernels = recursion.advance
    monkeypatch.setattr(simulate, "advance_groups", work.telling(simulate.advance_groups))
    monkeypatch.setattr(recursion, "advance", lambda *of: work.telling(kernels(*of)))
    return work


def ends(stages: list[str], each_stage: int) -> list[int]:
    """Numbers of batches at which the time may be over: some of each stage, and the very last."""
    found = set()
    for stage in dict.fromkeys(stages):
        of = [number for number, one in enumerate(stages, 1) if one == stage]
        found |= {of[i] for i in np.linspace(0, len(of) - 1, each_stage).round().astype(int)}
    return sorted(found)


def test_after_the_limit_no_simulation_begins_in_any_stage(counted, full):
    """The fit, the ranking, the labels, lags and delays, the error budget, the next run and the terms.

    In the short form the time is over once in every ninth, in the full one twelve times in each. A fit that was made
    before is given to what comes after it.
    """
    whole, events = counted.diagnosis(propose=full)
    assert whole.complete
    assert whole.not_looked_at == ()
    assert events.late == 0
    stages = {*events.stages}
    for counted_stage in ("trying", "confirming", "starting again"):  # what is left of a stage is judged by its count
        done, total = events.counts[counted_stage]
        assert done == total > 0
    assert "preparing" in events.counts
    assert {"prepare", "polish", "predicting", "trying", "confirming", "labels", "error budget", "next run"} <= stages
    cuts = ends(events.stages, 12) if full else ends(events.stages, 1)[::9]
    if not full:  # the way to the terms is the same
        cuts.append(len(events.stages) + 20)
    fit, of_fit = counted.fit()
    for last in cuts:
        first = of_fit if last > of_fit else 0
        found, cut = counted.diagnosis(last - first, fit=fit if first else None)
        assert cut.late == 0, (last, cut.stage)
        assert len(cut.stages) == last - first
        assert not found.complete
        assert found.not_looked_at
        listed = f"Not examined: {', '.join(found.not_looked_at)}." in found.verdict.text
        assert listed == bool(found.ladder)  # where nothing was examined, that alone is said
        assert Diagnosis.from_json(found.to_json()).to_json() == found.to_json()
        assert found.to_json()["complete"] is False
        _holds_what_was_found(found, whole, cut.stages[-1])


def _holds_what_was_found(found: Diagnosis, whole: Diagnosis, stage: str) -> None:
    """By the stage in which the time was over: what came before it is there, and as it is without a limit."""
    if stage in ("error budget", "next run", "proposing"):
        assert found.candidates == whole.candidates
        assert found.ladder == whole.ladder
        assert found.verdict.effects == whole.verdict.effects == ("dead_zone",)
    if stage == "polish":
        assert found.candidates == ()
        assert found.baseline.error == {"fit": None, "held_out": None, "verify": None}
    if stage == "trying" and not found.verdict.effects:
        assert {one.effect for one in found.candidates} == {*FEW}
        assert found.verdict.unexplained
    if stage == "error budget":
        assert found.budget is None
        assert "There was no time for the error budget." in found.notes
    if stage in ("error budget", "next run"):
        assert found.next_experiment is None
        assert "There was no time for the next run." in found.notes
    if stage == "proposing":
        assert (found.budget, found.next_experiment) == (whole.budget, whole.next_experiment)
        assert found.not_looked_at == ("search for unknown terms",)


def test_work_outside_of_a_budget_is_not_limited():
    """A budget holds for what is begun within it, on every thread that helps, and for nothing else."""
    over = TimeBudget(1.0, iter([0.0, *[2.0] * 100]).__next__)
    with over.running(), pytest.raises(TimeIsUp):
        each(lambda item: item, range(3))
    assert each(lambda item: item, range(3)) == [0, 1, 2]


def test_a_long_batch_is_cut_into_short_ones_and_gives_the_same(monkeypatch):
    """So that it can be stopped: whatever its length and however many lanes, to the last bit."""
    values = {p.in_equations: p.value for p in MODEL.parameters}
    values["dead_zone__half_width"] = 1e-4
    together = _outputs(values)
    batches: list[tuple[int, int, int]] = []
    advance = simulate.advance_groups

    def told(code, wide, groups, *given):
        batches.append((wide * (groups[1] - groups[0]), *given[5:7]))
        return advance(code, wide, groups, *given)

    monkeypatch.setattr(simulate, "advance_groups", told)
    monkeypatch.setattr(simulate, "LONGEST_BATCH", 4_000)
    cut = _outputs(values)
    assert max(lanes * (last - first) for lanes, first, last in batches) <= 4_000
    assert all(np.array_equal(cut[run], together[run]) for run in together)


def _outputs(values):
    return every_run(MODEL, matrix()).outputs_at(values)
