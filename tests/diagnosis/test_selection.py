"""Which effects stay where adding one makes another needless, and the other way round."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, dataclass, replace
from inspect import getsource
from types import SimpleNamespace
from typing import Any

import pytest

from ident.diagnosis import ambiguity, candidate, moves, refitted_sets, selection_loop
from ident.diagnosis.moves import Moves
from ident.diagnosis.selection import Selection
from ident.diagnosis.selection_loop import add_and_exchange, select
from ident.errors import TimeIsUp


class Refit(SimpleNamespace):
    """A refit, which is itself alone, as a fitted model is."""

    __eq__ = object.__eq__
    __hash__ = object.__hash__


@dataclass(frozen=True)
class Judgement:
    """A candidate: its refit, where it came that far, and whether it helps."""

    effect: str
    refit: Any
    worth_adding: bool
    base: Any = None
    worsens_part: bool = False
    prediction: Any = None

    @property
    def score(self):
        """What it is sorted by."""
        return self.refit.held_out.score if self.refit else 0.0

    @property
    def stage(self):
        """How far it came."""
        return 0 if self.refit else 2

    def refitted(self, _models, _base, refit):
        """It helps, since its refit was met on the way."""
        return replace(self, refit=refit, worth_adding=True)


class Judged:
    """Models of which only the held-out score of each set of effects is known, and what helps beyond chance."""

    effects = ("a", "b", "c")
    floor = 0.1
    freed = spring = shown = worsening = together = probable = ""

    def __init__(self, scores: dict[str, float], needed: set[str], far: str, late: str, off: str) -> None:
        self.off = off
        self.met: dict[frozenset[str], Any] = {}  # one optimum for each set of effects
        self.scores, self.needed = {"abc": 2.0, "ac": 2.0, "bc": 2.0, "c": 2.0} | scores, needed
        self.far, self.late = far, late  # effects found only from strong ones; only beside another

    def refit(self, effects, _start):
        """A refit that knows its effects and score."""
        score = self.scores["".join(sorted(effects))]
        held_out = SimpleNamespace(score=score, effects=set(effects))
        values = dict.fromkeys(effects, 1.0)
        here = self.met.setdefault(frozenset(effects), SimpleNamespace(error=score))
        found = Refit(
            effects=tuple(effects),
            values=values,
            finite=True,
            held_out=held_out,
            local=here,
            error=score,
        )
        found.reordered = lambda order: Refit(**{**vars(found), "effects": order})
        return found

    def pair_trial(self, first, second, _aim):
        """The same with the last effects of two."""
        return self.refit((*first.effects, second.effects[-1]), {})

    def converged(self, refit):
        """It stays."""
        return refit

    def is_short(self, _refit):
        """No: they are long."""
        return False

    def representing(self, _fitted):
        """Its records show everything from their beginnings on."""
        return self

    def trial_error(self, refit):
        """Its score again."""
        return refit.held_out.score

    def at_floor(self, refit):
        """Whether nothing is left."""
        return self.floor is not None and refit.held_out.score <= self.floor

    def residual_above_noise(self, refit):
        """Whether more than noise is left, which may be known where the floor is not."""
        return refit.held_out.score > 0.1

    def global_starts(self, effects):
        """An effect that no start near the fit leads to is found from anywhere."""
        return [self.refit(effects, {})]

    def leading(self, refits, _aim):
        """All of them go on."""
        return list(refits)

    def may_be_dispensable(self, _refit, effect):
        """Whether an effect that is off led to where it is not needed."""
        return effect in self.off

    def simplicity(self, effect):
        """Of two that are as good the first."""
        return (1, self.effects.index(effect))

    def strength(self, effect):
        """An effect has one parameter of its own name."""
        return effect

    def rank(self, _models, base, names, _report, _thorough=True, strong=False, **_listener):
        """An effect helps where the score falls."""

        def judged(name):
            if (name in self.far and not strong) or (name in self.late and not base.effects):
                return Judgement(name, None, worth_adding=False)
            refit = self.refit((*base.effects, name), {})
            together = {"b", "c"} <= set(refit.effects)
            falls = refit.held_out.score < base.held_out.score and not together
            worsens = name in self.worsening and not base.effects
            return Judgement(name, refit, worth_adding=falls and not worsens, worsens_part=falls and worsens)

        return moves.in_rank_order(self, map(judged, names))

    def rank_each(self, models, bases, report, thorough, **_incumbent):
        """Each for itself."""
        return [self.rank(models, base, names, report, thorough, strong=False) for base, names in bases]

    def deepened(self, _models, _base, ranking, _report):
        """Nothing is found elsewhere."""
        return ranking

    def indistinguishable(self, _best, _other):
        """Each differs from the others beyond chance."""
        return False

    def dominated(self, _worse, _best):
        """None is worse than another by what matters."""
        return False

    def worth_adding(self, _models, less, more):
        """Whether an effect that only one of them has was needed, or the other does better by far."""
        less, more = less.held_out, more.held_out
        return bool((more.effects - less.effects) & self.needed) or more.score < 0.3 * less.score

    def both_probable(self, first, second):
        """Whether neither leaves a tenth more."""
        return 0.9 < first.held_out.score / second.held_out.score < 1.1

    def better(self, one, other):
        """Whether of two with as many effects the other leaves less."""
        return other.held_out.score < one.held_out.score

    def with_free_widths(self, _models, _base, _best, names):
        """The effect that does better with its widths free, where there is one."""
        return self.refit((self.freed,), {}) if self.freed in names else None

    def joint_refit(self, _models, _base, _predictions, _most):
        """What remains of all effects at once, where anything does."""
        return self.refit(self.together, {}) if self.together else None

    def with_shapes_of(self, _models, _refit, _name):
        """The same models: what is free shows in their scores alone."""
        return self

    def springs(self, _models, _base, names):
        """Those that take the place of a spring."""
        return [name for name in names if name == self.spring]

    def most_probable(self, fitted, _groups):
        """The effect that is more probable than the first alone."""
        return self.refit((self.probable,), {}) if self.probable and fitted.effects == ("a",) else None

    def is_shown(self, effect):
        """Whether the records show it by themselves."""
        return effect == self.shown

    def stand_in(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """For what a search asks of real refits."""
        ranked = ("rank", "rank_each", "deepened", "joint_refit", "with_free_widths", "with_shapes_of", "springs")
        judged = ("worth_adding", "better")
        equal = (candidate, ("indistinguishable", "dominated")), (ambiguity, ("indistinguishable",))
        for module, names in ((moves, ranked + judged), *equal, (refitted_sets, ("both_probable",))):
            for name in names:
                monkeypatch.setattr(module, name, getattr(self, name))
        monkeypatch.setattr(refitted_sets.RefittedSets, "most_probable", self.most_probable)


def selected(judged: Judged) -> Selection:
    """What a search over such models selects, two effects at most."""
    search = Moves(judged, judged.refit((), {}), 2, lambda *_: None)  # type: ignore[arg-type]
    return select(search, search.latest)


@pytest.fixture
def searched(monkeypatch):
    """The additions for given scores and needs."""

    def of(scores: dict[str, float], needed: set[str], far: str = "", late: str = "", off: str = "") -> Selection:
        judged = Judged(scores, needed, far, late, off)
        judged.stand_in(monkeypatch)
        return selected(judged)

    return of


@pytest.fixture
def added(searched):
    """The effects that are added."""
    return lambda *given, **more: set(searched(*given, **more).added)


def test_what_a_later_effect_makes_needless_is_taken_out(added):
    """a enters, b explains all of it; with a again nothing is gained, so that b alone stays."""
    scores = {"": 1.0, "a": 0.8, "b": 0.50, "ab": 0.51}
    assert added(scores, needed={"b"}) == {"b"}


def test_of_effects_that_enter_and_leave_in_a_circle_the_best_set_stays(added):
    """Each helps when it enters and seems needless once the other is there: both together are best, and stay."""
    scores = {"": 1.0, "a": 0.8, "b": 0.9, "ab": 0.5}
    assert added(scores, needed=set()) == {"a", "b"}


def test_two_that_only_together_explain_the_data_are_found_where_a_third_came_first(added):
    """a alone does best, as a delay does for two lags, and leads nowhere; b and c together leave nothing."""
    scores = {"": 1.0, "a": 0.5, "b": 0.7, "c": 0.7, "ab": 0.6, "ac": 0.6, "bc": 0.05}
    assert added(scores, needed={"a", "b", "c"}) == {"b", "c"}


def test_two_of_which_neither_helps_beside_what_stands_for_both_are_found(added):
    """a does best, as one lag does for two, and b a little worse; c, which shows beside b alone, leaves nothing."""
    scores = {"": 1.0, "a": 0.5, "b": 0.52, "c": 0.9, "ab": 0.5, "ac": 0.5, "bc": 0.05}
    assert added(scores, needed={"a", "b", "c"}, late="c") == {"b", "c"}
    assert added({**scores, "b": 0.7}, needed={"a", "b", "c"}, late="c") == {"a"}  # b is improbable beside a


def test_pairs_are_tried_where_an_effect_only_led_to_a_better_optimum_of_the_given_model(monkeypatch):
    """The path then begins with two models without an effect, and no effect was tried with all others."""
    scores = {"": 1.0, "a": 0.5, "b": 0.7, "c": 0.7, "ab": 0.6, "ac": 0.6, "bc": 0.05}
    judged = Judged(scores, needed={"a", "b", "c"}, far="", late="", off="")
    judged.stand_in(monkeypatch)
    search = Moves(judged, judged.refit((), {}), 2, lambda *_: None)  # type: ignore[arg-type]
    ranked = search.first_ranking(search.latest)
    found = search.pair_search(replace(ranked, path=(search.base, judged.refit((), {}))))
    assert found is not None
    assert set(found.added) == {"b", "c"}


@pytest.mark.parametrize(("left", "found"), [(0.05, {"b", "c"}), (0.2, {"a"})])
def test_effects_that_are_found_only_all_at_once_have_to_explain_everything(added, monkeypatch, left, found):
    """a stands for b and c, of which no search has a refit; what is found at once is taken where it leaves noise."""
    monkeypatch.setattr(Judged, "together", "bc")
    scores = {"": 1.0, "a": 0.5, "b": 0.9, "c": 0.9, "ab": 0.5, "ac": 0.5, "bc": left}
    monkeypatch.setattr(Judged, "pair_trial", lambda self, *_: self.refit(("a",), {}))
    assert added(scores, needed={"a", "b", "c"}, far="bc", late="bc") == found


def test_an_effect_that_worsens_a_part_of_the_data_is_added_with_the_one_that_mends_it(monkeypatch):
    """a explains most and makes one condition worse, as long as b is missing there; c helps with neither."""
    judged = Judged({"": 1.0, "a": 0.4, "b": 0.99, "c": 1.0, "ab": 0.05, "ac": 0.4}, {"a", "b"}, "", "b", "")
    judged.stand_in(monkeypatch)
    assert selected(judged).added == ("a", "b")
    judged = Judged(judged.scores, {"a", "b"}, "", "b", "")
    judged.worsening = "a"
    judged.stand_in(monkeypatch)
    assert selected(judged).added == ("a", "b")


def test_at_the_noise_an_effect_stands_in_the_place_of_another_that_is_a_little_worse(added):
    """A lag came first where a delay is the truth: the error falls by little then, but beyond chance."""
    scores = {"": 1.0, "a": 0.5, "b": 0.9, "ab": 0.5, "ac": 0.09, "bc": 0.08}
    assert added(scores, needed={"a", "c"}) == {"b", "c"}


def test_an_effect_that_shows_only_from_far_is_found_where_the_noise_is_not_reached(added):
    """a helps at once and leaves much; b, whose refit from its promise ends where it began, leaves nothing."""
    scores = {"": 1.0, "a": 0.7, "b": 0.5, "ab": 0.05}
    assert added(scores, needed={"a", "b"}, far="b") == {"a", "b"}
    assert added({**scores, "a": 0.1}, needed={"a", "b"}, far="b") == {"a"}  # the noise is reached without


def test_an_effect_that_was_met_on_the_way_is_ranked_by_what_was_met(searched):
    """b, which the first ranking had no refit of, is all that stays: it stands first, not a."""
    scores = {"": 1.0, "a": 0.7, "b": 0.05, "c": 0.8, "ab": 0.05}
    found = searched(scores, needed={"b"}, far="b")
    assert found.added == ("b",)
    assert [candidate.effect for candidate in found.ranking] == ["b", "a", "c"]
    assert found.ranking[0].refit is found.fitted


def test_what_is_found_elsewhere_counts_in_the_probabilities(monkeypatch):
    """b, begun again from other strengths, comes as near as a: a group of the two is as probable as both."""
    judged = Judged(
        {"": 1.0, "a": 0.1, "b": 0.7, "c": 0.8, "ab": 0.1, "ac": 0.1}, needed={"a"}, far="", late="", off=""
    )
    judged.stand_in(monkeypatch)

    def deepened(_models, _base, ranking, _report):
        judged.scores["b"] = 0.1
        judged.met.clear()
        return [replace(one, refit=judged.refit((one.effect,), {})) for one in ranking]

    monkeypatch.setattr(moves, "deepened", deepened)
    found = selected(judged)
    assert found.refitted_sets.best[frozenset("b")].held_out.score == 0.1


def test_the_most_probable_of_two_effects_that_leave_nearly_as_much_is_named(monkeypatch):
    """a leaves a little less than b, not beyond chance, and b is more probable: b is named, in a group with a."""
    judged = Judged({"": 1.0, "a": 0.09, "b": 0.091, "c": 0.8, "ab": 0.09}, needed={"a", "b"}, far="", late="", off="")
    judged.stand_in(monkeypatch)
    assert selected(judged).added == ("a",)
    monkeypatch.setattr(Judged, "probable", "b")
    found = selected(judged)
    assert found.added == ("b",)
    assert found.complete
    assert "b" in {one.effect for one in found.alternatives["b"]}
    judged.needed, judged.scores["b"] = {"a"}, 0.5
    assert selected(judged).added == ("a",)


def test_a_group_holds_what_cannot_be_told_from_the_best_or_from_the_named_effect(monkeypatch):
    """c is the best by chance and can be told from b, as a, which is named, cannot: the data leave all three open."""
    judged = Judged({"": 1.0, "a": 0.09, "b": 0.092, "c": 0.088}, needed=set(), far="", late="", off="")
    judged.stand_in(monkeypatch)
    apart = {"b", "c"}
    monkeypatch.setattr(ambiguity, "indistinguishable", lambda one, other: {*one.effects, *other.effects} != apart)
    a, b, c = (Judgement(name, judged.refit((name,), {}), worth_adding=True) for name in "abc")
    group = ambiguity.indistinguishable_group("a", a.refit, [a, b, c])
    assert [one.effect for one in group] == ["a", "b", "c"]


def test_what_a_replacement_makes_needless_is_taken_out(added):
    """c, which showed only beside b, takes the place of a; with it b gains nothing."""
    scores = {"": 1.0, "a": 0.7, "b": 0.8, "c": 0.05, "ab": 0.2, "bc": 0.05}
    assert added(scores, needed=set(), late="c") == {"c"}


def test_nothing_is_tried_two_at_a_time_where_one_leaves_nothing(added):
    """The noise is reached with one effect: what two would reach is of no interest."""
    scores = {"": 1.0, "a": 0.1, "b": 0.7, "c": 0.7, "ab": 0.2, "ac": 0.2, "bc": 0.01}
    assert added(scores, needed={"a"}) == {"a"}


def test_an_effect_that_is_off_and_leads_nowhere_better_without_it_is_added_as_any_other(added):
    """What it gained cannot be had without it: it is not taken for the way to a better optimum."""
    scores = {"": 1.0, "a": 0.2, "b": 0.9, "ab": 0.2}
    assert added(scores, needed={"a"}, off="a") == {"a"}


def test_one_effect_from_anywhere_takes_the_place_of_the_first(added):
    """b, which no start near the fit leads to, explains alone what a did not."""
    scores = {"": 1.0, "a": 0.7, "b": 0.05, "c": 0.8, "ab": 0.05}
    assert added(scores, needed={"b"}, far="b") == {"b"}


@pytest.mark.parametrize(("left", "added_then"), [(0.2, {"c"}), (0.7, {"a"})])
def test_a_search_that_begins_with_free_widths_is_kept_where_it_ends_better(added, monkeypatch, left, added_then):
    """With its usual width the third effect leads nowhere; the first leaves half, which is no noise."""
    monkeypatch.setattr(Judged, "freed", "c")
    scores = {"": 1.0, "a": 0.5, "b": 0.9, "c": left, "ab": 0.5, "ac": left, "bc": left}
    assert added(scores, needed=set("abc")) == added_then


def test_one_effect_with_another_width_takes_the_place_of_two_that_explain_as_much(added, monkeypatch):
    """Two effects reach the noise; a third alone does so, too, with its width free."""
    monkeypatch.setattr(Judged, "freed", "c")
    scores = {"": 1.0, "a": 0.5, "b": 0.9, "c": 0.05, "ab": 0.05, "ac": 0.05, "bc": 0.05}
    assert added(scores, needed={"a", "b"}) == {"c"}


def test_what_takes_the_place_of_a_spring_is_tried_with_its_shapes_free_before_others_are_added(added, monkeypatch):
    """With its usual shapes it leads nowhere, and with b added to a nothing would lead back."""
    monkeypatch.setattr(Judged, "freed", "c")
    monkeypatch.setattr(Judged, "spring", "c")
    scores = {"": 1.0, "a": 0.5, "b": 0.9, "c": 0.05, "ab": 0.05, "ac": 0.05, "bc": 0.05}
    found = added(scores, needed={"a", "b"})
    assert found == {"c"}


def test_what_the_records_show_comes_before_what_explains_more_and_stays(added, monkeypatch):
    """a leaves less at first; b, which the records show, is first, and stays where a alone would do as well."""
    scores = {"": 1.0, "a": 0.5, "b": 0.6, "c": 0.9, "ab": 0.5}
    assert added(scores, needed=set()) == {"a"}
    monkeypatch.setattr(Judged, "shown", "b")
    assert added(scores, needed=set()) == {"a", "b"}


def test_the_last_effect_goes_where_its_rung_refitted_does_better_without_it(monkeypatch):
    """Four effects were added one by one; without the last, refitted from where the search ended, less is left."""
    scores = {"": 1.0, "a": 0.9, "ab": 0.7, "abc": 0.4, "abcd": 0.5} | dict.fromkeys(("bcd", "acd", "abd"), 2.0)
    judged = Judged(scores | {"b": 2.0, "d": 2.0}, needed={"b", "c"}, far="", late="", off="")
    judged.effects = (*judged.effects, "d")
    judged.stand_in(monkeypatch)
    search = Moves(judged, judged.refit((), {}), 0, lambda *_: None)  # type: ignore[arg-type]
    ranked = search.first_ranking(search.latest)
    begun = replace(ranked, path=(*ranked.path, judged.refit("abcd", {})), alternatives={"d": []})
    found = select(search, begun)
    assert (found.added, found.ladder()[-1][1].held_out.score) == (("a", "b", "c"), 0.4)
    assert "d" not in found.alternatives


def test_the_loop_is_read_at_a_glance_and_a_selection_is_never_changed():
    """Forty lines for the search over named moves; what a move makes is another selection."""
    lines = [line for function in (select, add_and_exchange) for line in getsource(function).splitlines()]
    assert len(lines) <= 50
    assert len(getsource(select).splitlines()) <= 40
    judged = Judged({"": 1.0}, needed=set(), far="", late="", off="")
    with pytest.raises(FrozenInstanceError):
        Moves(judged, judged.refit((), {}), 2, lambda *_: None).latest.path = ()  # type: ignore[arg-type, misc]


@pytest.mark.parametrize(
    ("of_start", "of_best", "is_taken"), [(1.0, 2.0, True), (1.0, 1.0, False), (1.0, None, True), (5.0, None, False)]
)
def test_a_model_that_was_fitted_before_is_taken_where_it_improves_on_the_best_of_the_ranking(
    monkeypatch, of_start, of_best, is_taken
):
    """Of two that are as good the ranking has the simpler one first; errors, that of the base is 5."""
    monkeypatch.setattr(moves, "worth_adding", lambda _models, before, after: after.error < 0.9 * before.error)
    start, best = SimpleNamespace(error=of_start, finite=True), None
    if of_best is not None:
        best = SimpleNamespace(refit=SimpleNamespace(error=of_best))
    search: Any = SimpleNamespace(models=None, start=start, step=lambda _selection, fitted: fitted)
    selection: Any = SimpleNamespace(fitted=SimpleNamespace(error=5.0))
    assert Moves._from_start(search, selection, best) is (start if is_taken else None)


def test_a_selected_set_is_extended_by_strong_effects_before_other_sets_are_looked_at(monkeypatch):
    """Else another set that is extended first takes the place of a better one."""
    called: list[str] = []
    begun = SimpleNamespace(changes=0)
    monkeypatch.setattr(selection_loop, "add_and_exchange", lambda _moves, selection: selection)

    def over(_selection: Any) -> None:
        raise TimeIsUp

    farther = ("exchange_pass", "joint_refit", "strong_starts", "runner_up", "pair_search", "global_multistart")
    found = SimpleNamespace(
        above_floor=lambda _: True,
        may_lack_width=over,
        latest=begun,
        with_what_was_met=lambda latest: latest,
        **{name: lambda _, name=name: called.append(name) for name in farther},
    )
    assert select(found, begun) is begun  # type: ignore[arg-type]
    assert called.index("strong_starts") < called.index("runner_up")
    assert sorted(called) == sorted(farther)
