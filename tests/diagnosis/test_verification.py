"""What was named is called found only where the error is at the floor and no run to verify speaks against it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.diagnosis import challenges
from ident.diagnosis.recommended import recommended
from ident.diagnosis.result import Diagnosis
from ident.diagnosis.sentences import _shows_nothing
from ident.diagnosis.verdict import contradiction, shows_nothing
from ident.diagnosis.verification import Contradiction, VerifyChange, verify_change
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.run import Run
from ident.words.percent import percent
from ident.workflows import diagnose
from tests.conftest import of_few_effects
from tests.presets.test_machines import motor


def residual(seed: int, size: float, memory: float = 0.95) -> np.ndarray:
    """Coloured noise of a standard deviation."""
    noise = lfilter([1.0], [1.0, -memory], np.random.default_rng(seed).standard_normal(4000))
    return size * noise / noise.std()


def run_of(seed: int) -> Run:
    output = np.random.default_rng([seed, 1]).standard_normal(4000)
    return Run(f"r{seed}", "", 100.0, {"command": output, "displacement": output})


def judged(*of) -> Contradiction | None:
    """Whether the residuals of some runs with an effect contradict it."""
    return contradiction(verify_change(*of))


def test_an_error_that_rises_beyond_chance_is_a_contradiction_and_one_that_falls_is_not():
    runs = [run_of(1), run_of(2)]
    before = [residual(i, 0.1) for i in (3, 4)]
    worse, better = [1.5 * r for r in before], [0.8 * r for r in before]
    found = judged("lead", runs, before, worse)
    assert found is not None
    assert (found.before, found.after) == pytest.approx((0.1, 0.15), rel=0.05)
    assert found.deviations > 2
    assert judged("lead", runs, before, better) is None


def test_a_run_that_cannot_be_followed_with_an_effect_is_a_contradiction_and_one_that_never_could_is_not():
    runs, before = [run_of(1), run_of(2)], [residual(i, 0.1) for i in (3, 4)]
    lost = [before[0], before[1] * np.nan]
    found = judged("lead", runs, before, lost)
    grown = judged("lead", runs, before, [before[0], before[1] * 1e104])  # a number, and yet no error
    assert grown is not None
    assert (grown.after, grown.unstable) == (None, (runs[1].id,))
    assert found is not None
    assert (found.after, found.deviations) == (None, None)
    assert found.before == pytest.approx(0.1, rel=0.05)
    assert str(found.message("lead")) == (
        f"With lead the model is unstable on run {runs[1].id}; without, the error on validation data is "
        f"{percent(found.before)}. Either it only imitates something else, or the "
        "machine was different in these runs."
    )
    assert judged("lead", runs, lost, before) is None
    assert judged("lead", runs, lost, lost) is None


def test_chance_contradicts_seldom():
    """Residuals of one size that know nothing of each other: two standard errors, on one side."""
    runs = [run_of(1)]
    count = sum(
        judged("lead", runs, [residual(2 * i, 0.1)], [residual(2 * i + 1, 0.1)]) is not None for i in range(200)
    )
    assert count <= 12


def test_what_acts_in_runs_to_verify_lowers_their_error_as_is_due_and_what_does_not_shows_nothing():
    """A part of the output that the effect makes, in noise: there as fitted, not at all, and half of it."""
    runs, made, noise = [run_of(1)], residual(1, 0.08), residual(2, 0.1)
    acts, not_there, half = (
        verify_change("lead", runs, [noise + share * made], [noise + (share - 1.0) * made]) for share in (1.0, 0.0, 0.5)
    )
    assert acts.shown == pytest.approx(0.08, rel=0.02)
    assert acts.due == pytest.approx(-acts.rise, rel=0.2)
    assert [shows_nothing(one) for one in (acts, not_there, half)] == [False, False, True]
    assert contradiction(not_there) is not None


@pytest.mark.parametrize(
    ("shown", "said"), [(0.4, "would be 30.0 % if it acted"), (0.6, "changes the output by 60.0 %")]
)
def test_no_error_is_foretold_by_an_effect_that_changes_the_output_by_more_than_the_error(shown, said):
    """It was said to be 0.00 % if the effect acted."""
    change = VerifyChange("lead", 0.5, 0.52, 0.05, shown=shown)
    assert said in str(_shows_nothing("lead", change))


@pytest.mark.parametrize("shown", [0.4, 0.6])
def test_a_fall_within_chance_is_not_called_none(shown):
    """Half of the power went, within two standard errors of a few blocks: *nothing of it*, it was said."""
    change = VerifyChange("lead", 0.5, 0.36, 0.1, shown=shown)
    said = str(_shows_nothing("lead", change))
    assert "falls further, but not beyond chance on validation data: it is 50.0 % there without it and 36.0 %" in said


def test_what_acts_seldom_shows_nothing():
    runs = [run_of(1)]
    found = [
        verify_change(
            "lead",
            runs,
            [residual(2 * i, 0.1) + (made := residual(2 * i + 1, size))],
            [residual(2 * i, 0.1) + 0.1 * made],
        )
        for i in range(60)
        for size in (0.03, 0.1)
    ]
    assert sum(map(shows_nothing, found)) <= 2


@pytest.fixture(scope="module")
def other(full):
    """A motor with a dead zone is fitted; the runs to verify are of one without."""
    fitted, whole = motor(8, half_width=1.5), motor(9)
    runs = (fitted.of_use("fit")[0], whole.of_use("verify")[0])
    with of_few_effects(full):
        return diagnose(replace(fitted, runs=runs), settings=Settings(model="motor"), most=1)


def test_what_the_runs_to_verify_speak_against_is_contradicted_and_said_first(other):
    assert other.verdict.effects == ("dead_zone",)
    assert other.verdict.standing == "contradicted"
    assert other.verdict.contradicted_by == ("dead_zone",)
    assert other.verdict.text.startswith("With dead zone the error on validation data rises from ")
    assert "The model lacks" not in other.verdict.text


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_verify_changes_nothing_that_was_found(other):
    matrix = motor(8, half_width=1.5)
    alone = diagnose(replace(matrix, runs=matrix.of_use("fit")), settings=Settings(model="motor"), most=1)
    assert alone.verdict.standing == "found"
    assert alone.verdict.effects == other.verdict.effects
    assert alone.ladder[-1].parameters == other.ladder[-1].parameters
    assert [c.effect for c in alone.candidates] == [c.effect for c in other.candidates]


def test_the_standing_is_read_back_and_an_unknown_one_is_refused(other):
    written = other.to_json()
    assert Diagnosis.from_json(written).verdict.standing == "contradicted"
    assert Diagnosis.from_json({**written, "verdict": {"effects": []}}).verdict.standing is None  # of an older version
    with pytest.raises(Unusable, match="is none of found, stand_in, contradicted, nothing"):
        Diagnosis.from_json({**written, "verdict": {**written["verdict"], "standing": "sure"}})


@pytest.mark.usefixtures("few_effects")
def test_what_validation_data_show_nothing_of_is_said_and_not_named():
    """With a narrower dead zone the other motor is followed as badly with that of the fitted run as without."""
    fitted, other = motor(8, half_width=1.5), motor(9, half_width=1.1)
    matrix = replace(fitted, runs=(fitted.of_use("fit")[0], other.of_use("verify")[0]))
    found = diagnose(matrix, settings=Settings(model="motor"), most=1)
    assert (found.verdict.effects, found.verdict.unconfirmed) == ((), ("dead_zone",))
    assert [rung.added for rung in found.ladder] == [None, "dead_zone"]
    assert (recommended(found).added, [rung.added for rung in found.confirmed_ladder]) == ((), [None])
    assert "falls further, but not beyond chance on validation data: it is" in found.verdict.text
    assert found.summary[0].startswith("Not confirmed: dead zone")
    assert found.summary[2].startswith("Next: compare the conditions of the validation runs")
    assert Diagnosis.from_json(found.to_json()).verdict == found.verdict


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_with_nothing_missing_nothing_stands():
    found = diagnose(motor(10), settings=Settings(model="motor"), most=1)
    assert (found.verdict.effects, found.verdict.standing) == ((), "nothing")


class Ladder:
    """Three models: the fitted one, with a constant force, and with friction as well; what each change does."""

    def __init__(self, alone: float, given_friction: float, together: float) -> None:
        self.base, self.force, self.both = (
            SimpleNamespace(effects=effects, stable=True, values={})
            for effects in ((), ("static_load",), ("static_load", "friction"))
        )
        self.friction = SimpleNamespace(effects=("friction",), stable=True, values={})
        self.changes = {
            ((), ("static_load",)): alone,
            (("static_load",), ("static_load", "friction")): 0.1,
            (("friction",), ("static_load", "friction")): given_friction,
            ((), ("static_load", "friction")): together,
        }

    def refit(self, effects: tuple[str, ...], _start: object) -> SimpleNamespace:
        """The model of some effects."""
        assert effects == ("friction",)
        return self.friction

    def verified_change(self, effect: str, less: SimpleNamespace, more: SimpleNamespace) -> VerifyChange:
        """The change of an error of 0.4 by an effect, to a hundredth."""
        return VerifyChange(effect, 0.4, self.changes[less.effects, more.effects], 0.01)

    @property
    def steps(self) -> list:
        return [(None, self.base), ("static_load", self.force), ("friction", self.both)]


@pytest.mark.parametrize(
    ("alone", "given_friction", "together", "after"),
    [(0.5, 0.2, 0.3, 0.2), (0.5, 0.6, 0.3, 0.5), (0.3, 0.6, 0.3, 0.3), (0.5, 0.2, 0.39, 0.5)],
)
def test_an_effect_that_validation_data_confirm_only_given_the_others_is_confirmed(
    monkeypatch, alone, given_friction, together, after
):
    """A constant force alone may make up for friction, and harms other data. Given the friction it does not.

    Where both together change nothing, one only undoes what the other does.
    """
    ladder = Ladder(alone, given_friction, together)
    monkeypatch.setattr(challenges, "verified_change", ladder.verified_change)
    force, friction = challenges._verify_changes(ladder, ladder.steps)
    assert (force.effect, force.after) == ("static_load", after)
    assert friction.after == 0.1
