"""Which effects stay where adding one makes another needless, and the other way round."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ident.diagnosis import addition
from ident.diagnosis.addition import Addition


class Judged:
    """Models of which only the held-out score of each set of effects is known, and what helps beyond chance."""

    effects = ("a", "b")

    def __init__(self, scores: dict[str, float], needed: set[str]) -> None:
        self.scores, self.needed = scores, needed

    def refit(self, effects, _start):
        """A refit that knows its effects and score."""
        score = self.scores["".join(sorted(effects))]
        held_out = SimpleNamespace(score=score, effects=set(effects))
        return SimpleNamespace(effects=tuple(effects), values={}, finite=True, held_out=held_out)

    def rank(self, _models, base, names, _report, _thorough):
        """An effect helps where the score falls."""
        refits = [self.refit((*base.effects, name), {}) for name in names]
        before = base.held_out.score
        return [SimpleNamespace(effect=r.effects[-1], refit=r, helps=r.held_out.score < before) for r in refits]

    def gain(self, less, more):
        """Whether the effect that is taken out was needed."""
        (out,) = more.effects - less.effects
        return SimpleNamespace(beyond_chance=out in self.needed, within_chance=False)


@pytest.fixture
def added(monkeypatch):
    """The effects that are added for given scores and needs."""

    def of(scores: dict[str, float], needed: set[str]) -> set[str]:
        judged = Judged(scores, needed)
        monkeypatch.setattr(addition, "rank", judged.rank)
        monkeypatch.setattr(addition, "gain", judged.gain)
        tried = Addition(judged, judged.refit((), {}), 2, lambda *_: None)  # type: ignore[arg-type]
        tried.steps = [tried.base]
        tried._forward()
        return set(tried.added)

    return of


def test_what_a_later_effect_makes_needless_is_taken_out(added):
    """a enters, b explains all of it; with a again nothing is gained, so that b alone stays."""
    scores = {"": 1.0, "a": 0.8, "b": 0.50, "ab": 0.51}
    assert added(scores, needed={"b"}) == {"b"}


def test_of_effects_that_enter_and_leave_in_a_circle_the_best_set_stays(added):
    """Each helps when it enters and seems needless once the other is there: both together are best, and stay."""
    scores = {"": 1.0, "a": 0.8, "b": 0.9, "ab": 0.5}
    assert added(scores, needed=set()) == {"a", "b"}
