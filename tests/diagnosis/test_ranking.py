"""In which order effects are tried and ranked: those that nobody promised anything of, and those that tie."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis.ambiguity import alternatives, competing, indistinguishable_group
from ident.diagnosis.candidate import Candidate, in_rank_order
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence.chance import bar
from ident.diagnosis.evidence.comparison import Residuals, common_disturbance
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.diagnosis.ranking import _confirmed, _contenders, _finalists, rank_each
from ident.diagnosis.screening import _without_first_state

MODELS: Any = SimpleNamespace(simplicity=lambda name: (1, name))
RUNS, N, NOISE = 6, 400, 0.01
BANDS = EnergyBands(tuple(Record(1.0, run, floor=NOISE**2) for run in range(RUNS)), (N,) * RUNS)


def refit(**left: float) -> Any:
    """A refit that leaves noise on six runs, and so much (of the output) of each of some patterns, by name."""
    random = np.random.default_rng(7)
    series = [NOISE * random.standard_normal(N) for _ in range(RUNS)]
    for name, size in left.items():
        of = np.random.default_rng(list(name.encode()))
        series = [r + size * of.standard_normal(N) for r in series]
    error = float(np.mean([np.std(r) for r in series]))
    held_out, residuals = SimpleNamespace(score=error, error=error), Residuals(tuple(series), BANDS)
    return SimpleNamespace(
        fitness=SimpleNamespace(horizon=None),
        held_out=held_out,
        error=error,
        effects=(),
        residuals_held_out=residuals,
        residuals_fitted=residuals,
    )


def candidate(effect: str, found: Any) -> Candidate:
    """An effect with its refit."""
    prediction: Any = SimpleNamespace(effect=effect)
    return Candidate(prediction, refit=found)


def group(first: Candidate, *others: Candidate) -> list[str]:
    """The names of what cannot be told from the first."""
    return [one.effect for one in indistinguishable_group(first.effect, first.refit, [first, *others])]  # type: ignore[arg-type]


def test_what_the_records_call_for_is_tried_whatever_is_predicted():
    """A record that rings has a spring tried, though a fit without it lies where no spring promises anything."""
    names = [f"effect_{number}" for number in range(20)] + ["spring"]
    models: Any = SimpleNamespace(is_called_for=lambda name: name == "spring")
    found = _contenders(models, [SimpleNamespace(effect=name) for name in names])  # type: ignore[arg-type,misc]
    assert [one.effect for one in found] == [*names[: CRITERIA.ranking.contenders], "spring"]


def test_what_nothing_replaced_is_in_its_group():
    """By rounding it stands first, and just beyond chance behind the best."""
    assert group(candidate("delay", refit(a=0.2)), candidate("lag", refit(b=0.1))) == ["delay", "lag"]


def test_the_numbers_of_a_group_are_those_that_decided_it():
    """Each is within its limit, and of the pair that the data do not tell apart."""
    first, other = (
        candidate("asymmetry", refit(missing=0.03, own=0.004)),
        candidate("leak", refit(missing=0.03, other=0.004)),
    )
    groups = {"asymmetry": indistinguishable_group("asymmetry", first.refit, [first, other])}  # type: ignore[arg-type]
    (found,) = alternatives(groups)
    assert (found.effect, found.instead_of, found.separation.by) == ("leak", "asymmetry", "")
    assert 0.0 < found.separation.apart == pytest.approx(2 * 0.004**2, rel=0.2)
    assert found.separation.apart < found.separation.apart_limit
    assert replace(found.separation, gain=-12.4).by == "gain"
    assert replace(found.separation, apart=2.0 * found.separation.apart_limit).by == "apart"
    assert replace(found.separation, means_apart=4e-4).by == "means_apart"
    assert replace(found.separation, difference=-2.0 * found.separation.difference_limit, hidden=0.0).by == "difference"


def test_a_rival_in_no_group_has_the_number_that_keeps_it_out():
    """As probable by its gain, and its output is farther from the other's than the noise hides."""
    here, other = refit(missing=0.03, own=0.02), refit(missing=0.03, other=0.02)
    here.effects, other.effects = ("lag", "asymmetry"), ("leak", "lag")
    (found,) = competing(here, [other], {"asymmetry": ()})
    assert (found.effect, found.instead_of, found.separation.by) == ("leak", "asymmetry", "apart")
    member: Any = SimpleNamespace(effect="leak")
    assert competing(here, [other], {"asymmetry": [member]}) == ()
    other.effects = ("leak", "play")
    assert competing(here, [other], {}) == ()


@pytest.mark.parametrize(
    ("own", "of_leak", "found"),
    [
        (0.0, {"missing": 0.03}, ["asymmetry", "leak"]),  # the same output
        (0.004, {"missing": 0.03, "other": 0.004}, ["asymmetry", "leak"]),  # so near that what both lack decides it
        (0.02, {"missing": 0.03, "other": 0.02}, ["asymmetry"]),  # farther apart than a twentieth of that in power
        (0.0, {"another": 0.03}, ["asymmetry"]),  # as much is left, of another pattern
        (0.0, {"missing": 0.03, "other": 0.01}, ["asymmetry"]),  # near, and worse beyond chance
    ],
)
def test_what_is_missing_tells_no_two_effects_apart(own, of_leak, found):
    """Their outputs are nearer to each other than what neither of them explains could have made them."""
    assert group(candidate("asymmetry", refit(missing=0.03, own=own)), candidate("leak", refit(**of_leak))) == found


@pytest.mark.parametrize(("other", "first"), [(0.001, "a"), (0.02, "b")])
def test_what_ties_stands_as_it_is_listed(other, first):
    """A little more is left by the effect that is listed first, of which the data leave open whether it is right."""
    ranked = in_rank_order(MODELS, [candidate("b", refit(missing=0.03)), candidate("a", refit(missing=0.03, x=other))])
    assert ranked[0].effect == first


def test_the_order_is_that_of_the_held_out_error():
    """But for what ties, which stands as it is listed."""
    ranked = in_rank_order(MODELS, [candidate("a", refit(x=0.2)), candidate("b", refit(y=0.1))])
    assert [one.effect for one in ranked] == ["b", "a"]


@pytest.mark.parametrize(("kept", "tried"), [(0.8, {"friction", "dead zone"}), (0.3, {"friction"})])
def test_where_the_boldest_promise_is_not_kept_more_is_tried(monkeypatch, kept, tried):
    """Friction promises to leave 0.3, and leaves so much; a dead zone promised 0.5, noise next to nothing."""
    promises = {"friction": 0.3, "dead zone": 0.5, "noise": 0.999}
    predictions = [
        SimpleNamespace(
            effect=name,
            remaining=share,
            reduction=1.0 - share,
            offset_likelihood_gain=0.0,
            after=SimpleNamespace(score=share, error=share),
            before=SimpleNamespace(offset=0.0),
        )
        for name, share in promises.items()
    ]
    asked: list[str] = []

    def refitted(_models: Any, _base: Any, prediction: Any, _aim: float, _strong: bool) -> Candidate:
        asked.append(prediction.effect)
        found: Any = SimpleNamespace(local=SimpleNamespace(error=kept if prediction.effect == "friction" else 0.4))
        return Candidate(prediction, found)

    for name, made in {
        "_predictions": lambda *_: predictions,
        "_tried": refitted,
        "_few": lambda *_: 12,
        "_confirmed": lambda _models, _base, one, _best: one,
        "_multistart": lambda _models, _asked, _base, one: one,
    }.items():
        monkeypatch.setattr(f"ident.diagnosis.ranking.{name}", made)
    models: Any = SimpleNamespace(simplicity=lambda name: (1, name), trial_error=lambda _base: 1.0)
    base: Any = SimpleNamespace(effects=())
    rank_each(models, [(base, list(promises))], lambda _: None, thorough=False)
    assert set(asked) == tried


@pytest.mark.parametrize(("quick", "refitted"), [(True, 6), (False, 5)])
def test_what_leaves_as_much_as_the_last_finalist_is_one_in_a_small_matrix(quick, refitted):
    """Else rounding would choose which of the two is refitted, and so may stand in a group: one leaves 1 % more."""
    trials = [
        Candidate(SimpleNamespace(effect=f"n{n}"), SimpleNamespace(local=SimpleNamespace(error=error)))  # type: ignore[arg-type]
        for n, error in enumerate([0.3, 0.32, 0.36, 0.38, 0.4, 0.404, 0.409])
    ]
    models: Any = SimpleNamespace(trial_error=lambda _base: 1.0, is_quick=lambda _base: quick)
    base: Any = None
    assert len(_finalists(models, base, trials, finalists_at_least=5)) == refitted
    nothing_more: Any = SimpleNamespace(trial_error=lambda _base: 0.404, is_quick=lambda _base: quick)
    assert len(_finalists(nothing_more, base, trials, finalists_at_least=5)) == 5


@pytest.mark.parametrize(("error", "way"), [(0.314, CRITERIA.estimation.full), (0.316, CRITERIA.estimation.coarse)])
def test_a_finalist_that_is_far_behind_is_not_refined_as_the_best_is(error, way):
    """The best left 0.3 on trial, and what leaves a twentieth more is behind."""
    asked: list[Any] = []
    models: Any = SimpleNamespace(
        refit=lambda _effects, _start, way: asked.append(way) or SimpleNamespace(finite=False)
    )
    trial: Any = SimpleNamespace(local=SimpleNamespace(error=error), values={})
    base: Any = SimpleNamespace(effects=())
    _confirmed(models, base, Candidate(SimpleNamespace(effect="friction"), trial), 0.3)  # type: ignore[arg-type]
    assert asked == [way]


def test_a_gain_by_chance_is_known_where_one_run_begins_in_motion_and_another_at_rest():
    """The first states of the one are its own: the bar of both together was none."""
    rng = np.random.default_rng(3)
    at_rest, moving = rng.standard_normal((4, 64)), rng.standard_normal((6, 64))
    responses = rng.standard_normal((2, 64, 3))
    parts = [_without_first_state(Z, of, 2) for Z, of in zip((at_rest, moving), responses, strict=True)]
    assert np.array_equal(parts[0][0], at_rest[-1])
    assert np.array_equal(parts[0][1], at_rest[:3].T)
    assert np.array_equal(parts[0][2], responses[0])
    for part in parts[1]:
        assert moving[2:4] @ part == pytest.approx(0.0, abs=1e-9)
    residuals, free, candidates = zip(*parts, strict=True)
    bands = EnergyBands((Record(1.0, "a"), Record(1.0, "b")), (64, 64))
    assert bar(residuals, free, candidates, common_disturbance([Residuals(residuals, bands)])) > 0


def diverging() -> Any:
    """A refit that is sound on what it was fitted to and diverges on a stretch that was held out."""
    sound = refit()
    series = (np.full(N, 1e200), *sound.residuals_held_out.series[1:])
    sound.held_out, sound.residuals_held_out = SimpleNamespace(score=np.inf, error=np.inf), Residuals(series, BANDS)
    return sound


def test_what_diverges_on_held_out_data_is_no_result_and_ends_no_ranking():
    """Neither of an effect, nor of the model that it is added to: then any effect with a finite error is worth it."""
    sound, bad = refit(missing=0.1), diverging()
    for one in (sound, bad):
        one.finite, one.local, one.values = True, SimpleNamespace(error=0.1), {}
    models: Any = SimpleNamespace(refit=lambda *_, **_way: bad, is_shown=lambda _name: False)
    trial = Candidate(SimpleNamespace(effect="a"), trial=bad)  # type: ignore[arg-type]
    assert _confirmed(models, sound, trial, 0.1).refit is None
    added = Candidate(SimpleNamespace(effect="a")).refitted(models, bad, sound)  # type: ignore[arg-type]
    assert (added.worth_adding, added.evidence) == (True, None)
