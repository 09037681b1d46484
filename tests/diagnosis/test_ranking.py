"""In which order effects are tried and ranked: those that nobody promised anything of, and those that tie."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis.candidate import Candidate, in_rank_order, indistinguishable_group
from ident.diagnosis.cross_validation import CrossValidation
from ident.diagnosis.ranking import _finalists, rank_each

MODELS: Any = SimpleNamespace(simplicity=lambda name: (1, name))
RUNS, CHUNKS = 6, 8


def left(error: float, effect: str) -> CrossValidation:
    """What is left of runs of a power of one: as much of each chunk, but for a tenth that hangs on the effect."""
    random = np.random.default_rng(list(effect.encode()))
    squares = error**2 / CHUNKS * (1.0 + 0.1 * random.standard_normal((RUNS, CHUNKS)))
    return CrossValidation(squares, np.ones(RUNS), np.zeros(RUNS), 6000, 300.0)


def candidate(effect: str, held_out: float, between_runs: float | None) -> Candidate:
    """An effect that leaves so much of blocks, and of whole runs, that were left out."""
    refit: Any = SimpleNamespace(
        effects=(effect,), held_out=left(held_out, effect), error=held_out, hysteretic=frozenset(),
        between_runs=None if between_runs is None else left(between_runs, effect),
    )  # fmt: skip
    prediction: Any = SimpleNamespace(effect=effect)
    return Candidate(prediction, refit=refit)


@pytest.mark.parametrize(
    ("of_friction", "of_stop", "first"),
    [
        (0.30, 0.22, "stop"),  # told apart, though friction is listed first
        (0.22, 0.22, "friction"),  # as good: as listed
        (0.232, 0.22, "friction"),  # some per cent, however certain, tell no two optima apart
        (None, None, "friction"),  # a single run
    ],
)
def test_what_ties_on_blocks_is_told_apart_by_whole_runs(of_friction, of_stop, first):
    friction, stop = candidate("friction", 0.2, of_friction), candidate("stop", 0.2001, of_stop)
    in_order = [one.effect for one in in_rank_order(MODELS, [stop, friction])]
    assert in_order[0] == first
    named: Any = {"friction": friction, "stop": stop}[first]
    as_good = [one.effect for one in indistinguishable_group(first, named.refit, [friction, stop], 0.2)]
    assert as_good == (["stop"] if first == "stop" else ["friction", "stop"])


def test_what_nothing_replaced_is_in_its_group():
    """By rounding it stands first, and just beyond chance behind the best."""
    delay, lag = candidate("delay", 0.2, 0.2), candidate("lag", 0.1, 0.1)
    assert [one.effect for one in indistinguishable_group("delay", delay.refit, [delay, lag], 0.1)] == ["delay", "lag"]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("of_leak", "noise", "beside"),
    [
        (0.2015, 0.1, True),  # a hundredth more in power, beside three quarters that nothing explains
        (0.2015, 0.2, False),  # noise: told apart, and nothing is missing that could have decided it
        (0.206, 0.1, False),  # more than a twentieth of the rest
        (0.2015, None, False),  # it takes less than nine tenths of what the other takes
    ],
)
def test_what_is_missing_tells_no_two_effects_apart(of_leak, noise, beside):
    """They differ beyond chance, chunk by chunk, and by less than what neither of them explains."""

    def refit(error: float) -> Any:
        squares = np.full((RUNS, CHUNKS), error**2 / CHUNKS)
        held_out = CrossValidation(squares, np.ones(RUNS), np.zeros(RUNS), 60_000, 30_000.0)
        return SimpleNamespace(held_out=held_out, error=error, between_runs=None, effects=(), hysteretic=frozenset())

    without = refit(0.3 if noise else 0.204)
    asymmetry, leak = (
        Candidate(SimpleNamespace(effect=name), refit=refit(error), base=without)  # type: ignore[arg-type]
        for name, error in (("asymmetry", 0.2), ("leak", of_leak))
    )
    found = indistinguishable_group("asymmetry", asymmetry.refit, [asymmetry, leak], noise or 0.1)  # type: ignore[arg-type]
    assert ("leak" in [one.effect for one in found]) is beside


def test_what_is_better_on_blocks_comes_first_whatever_whole_runs_say():
    """Whether it does harm there is asked where it is added."""
    assert [one.effect for one in in_rank_order(MODELS, [candidate("a", 0.2, 0.2), candidate("b", 0.1, 0.3)])] == [
        "b",
        "a",
    ]


@pytest.mark.parametrize(("kept", "tried"), [(0.8, {"friction", "dead zone"}), (0.3, {"friction"})])
def test_where_the_boldest_promise_is_not_kept_more_is_tried(monkeypatch, kept, tried):
    """Friction promises to leave 0.3, and leaves so much; a dead zone promised 0.5, noise next to nothing."""
    promises = {"friction": 0.3, "dead zone": 0.5, "noise": 0.999}
    predictions = [
        SimpleNamespace(
            effect=name, remaining=share, reduction=1.0 - share, offset_likelihood_gain=0.0,
            after=SimpleNamespace(score=share, error=share), before=SimpleNamespace(offset=0.0),
        )
        for name, share in promises.items()
    ]  # fmt: skip
    asked: list[str] = []

    def refitted(_models: Any, _base: Any, prediction: Any, _aim: float, _strong: bool) -> Candidate:
        asked.append(prediction.effect)
        found: Any = SimpleNamespace(local=SimpleNamespace(error=kept if prediction.effect == "friction" else 0.4))
        return Candidate(prediction, found)

    for name, made in {
        "_predictions": lambda *_: predictions, "_tried": refitted, "_few": lambda *_: 12,
        "_confirmed": lambda _models, _base, one: one, "_multistart": lambda _models, _asked, _base, one: one,
    }.items():  # fmt: skip
        monkeypatch.setattr(f"ident.diagnosis.ranking.{name}", made)
    models: Any = SimpleNamespace(simplicity=lambda name: (1, name), trial_error=lambda _base: 1.0)
    base: Any = SimpleNamespace(effects=())
    rank_each(models, [(base, list(promises))], lambda _: None, thorough=False)
    assert set(asked) == tried


@pytest.mark.parametrize(("quick", "refitted"), [(True, 6), (False, 5)])
def test_what_leaves_as_much_as_the_last_finalist_is_one_in_a_small_matrix(monkeypatch, quick, refitted):
    """Else rounding would choose which of the two is refitted, and so may stand in a group: one leaves 1 % more."""
    monkeypatch.setattr("ident.diagnosis.ranking._is_quick", lambda *_: quick)
    trials = [
        Candidate(SimpleNamespace(effect=f"n{n}"), SimpleNamespace(local=SimpleNamespace(error=error)))  # type: ignore[arg-type]
        for n, error in enumerate([0.3, 0.32, 0.36, 0.38, 0.4, 0.404, 0.409])
    ]
    models: Any = SimpleNamespace(trial_error=lambda _base: 1.0)
    base: Any = None
    assert len(_finalists(models, base, trials, finalists_at_least=5)) == refitted
    nothing_more: Any = SimpleNamespace(trial_error=lambda _base: 0.404)
    assert len(_finalists(nothing_more, base, trials, finalists_at_least=5)) == 5
