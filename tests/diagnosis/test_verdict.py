"""The verdict is a function of the findings alone: each case worked out by hand from the rule on its page."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from ident.diagnosis.criteria import Criteria
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.evidence import BlockMean
from ident.diagnosis.evidence.probability import NOTHING, SetGains
from ident.diagnosis.evidence.separation import Separation
from ident.diagnosis.report import group_of
from ident.diagnosis.result import Alternative
from ident.diagnosis.verdict import Findings, Residual, conclude, is_noise
from ident.diagnosis.verification import VerifyChange

NOT_PREDICTED, PREDICTED = BlockMean(0.01, 0.02, 20), BlockMean(0.1, 0.02, 20)
NOISE, FAR = Residual(0.0101, 0.01, spread=0.001), Residual(0.02, 0.01, spread=0.001)
FALLS, RISES = VerifyChange("lead", 0.1, 0.09, 0.001), VerifyChange("lead", 0.1, 0.103, 0.001)
LEAD = Findings(added=("lead",), residual=NOISE, verify=(FALLS,))


@pytest.mark.parametrize(
    ("found", "standing", "unexplained"),
    [
        (LEAD, "found", False),
        (replace(LEAD, residual=FAR), "stand_in", True),
        (replace(LEAD, residual=None), "stand_in", True),  # nobody had time to ask
        (replace(LEAD, verify=(RISES,)), "contradicted", False),
        (replace(LEAD, verify=(replace(RISES, std_error=0.002),)), "found", False),  # 1.5 standard errors
        (replace(LEAD, verify=(VerifyChange("lead", 0.1, None),)), "contradicted", False),  # unstable with it
        (replace(LEAD, at_bound=("lead",)), "found", False),
        (replace(LEAD, at_bound=("lead",), residual=Residual(0.01, None, correlation=0.1)), "stand_in", False),
        (
            replace(
                LEAD,
                added=("lead", "lag"),
                dispensable=("lag",),
                at_bound=("lag",),
                residual=Residual(0.01, None, correlation=0.1),
            ),
            "found",
            False,
        ),
        (Findings(residual=NOISE), "nothing", False),
        (Findings(residual=FAR), "nothing", True),
        (replace(LEAD, dispensable=("lead",)), "nothing", False),
    ],
)
def test_how_a_verdict_stands(found, standing, unexplained):
    verdict = conclude(found)
    assert (verdict.standing, verdict.unexplained) == (standing, unexplained)


def test_the_numbers_that_decide_whether_the_residual_is_noise_stand_in_the_verdict():
    """The error and its limit, two per cent and three deviations above the floor; without repeats what is predicted."""
    test = conclude(replace(LEAD, residual=FAR)).noise_test
    assert (test.error, test.floor, test.predicted) == (0.02, 0.01, None)
    assert test.limit == pytest.approx((1.02 + 3 * 0.001) * 0.01)
    without = conclude(replace(LEAD, residual=Residual(0.02, None, correlation=0.7))).noise_test
    assert (without.correlation, without.limit, without.floor) == (0.7, 0.5, None)
    coloured = conclude(replace(LEAD, residual=replace(FAR, predicted=PREDICTED))).noise_test
    assert (coloured.predicted, coloured.floor) == (0.1, 0.01)
    assert coloured.predicted_limit == pytest.approx(
        0.01 + 0.02 * 1.729, rel=1e-3
    )  # Student's t of 19 degrees of freedom
    assert conclude(replace(LEAD, residual=None)).noise_test is None


def test_beyond_effects_whose_residual_is_noise_nothing_unlisted_is_probable():
    """The floor of the spectrum would leave a gain of 40 nats."""
    gains = SetGains({NOTHING: 0.0, frozenset({"lead"}): 60.0}, most=100.0)
    coloured = Residual(0.02, 0.01, predicted=NOT_PREDICTED)
    verdict = conclude(replace(LEAD, residual=coloured, set_gains=gains))
    assert verdict.standing == "found"
    assert verdict.probabilities["unlisted"] < 0.05
    missing = conclude(replace(LEAD, residual=replace(coloured, predicted=PREDICTED), set_gains=gains))
    assert missing.standing == "stand_in"
    assert missing.probabilities["unlisted"] > 0.9


def test_without_a_name_the_verdict_is_as_probable_as_that_no_listed_effect_acts():
    """Where the residual is noise, that nothing unlisted acts either."""
    gains = SetGains({NOTHING: 0.0, frozenset({"lead"}): 10.0}, most=20.0)
    nothing = replace(LEAD, added=(), set_gains=gains, residual=Residual(0.01, 0.01))
    verdict = conclude(nothing)
    assert verdict.probability == pytest.approx(verdict.probabilities["nothing"])
    above = conclude(replace(nothing, residual=Residual(0.02, 0.01)))
    assert above.unexplained
    assert above.probability == pytest.approx(1.0 - above.probabilities["lead"])


@pytest.mark.parametrize("gain", [1.0, 60.0])
@pytest.mark.parametrize("verify", [FALLS, RISES])
def test_no_effect_is_named_where_it_is_more_probable_than_not_that_nothing_is_missing(gain, verify):
    """A gain of a nat is worth less than an effect costs; validation data do not contradict what is not named."""
    sets = SetGains({NOTHING: 0.0, frozenset({"lead"}): gain}, most=gain)
    verdict = conclude(replace(LEAD, alternatives=(("lead", "lag"),), set_gains=sets, verify=(verify,)))
    by_chance = verdict.probabilities["nothing"] > 0.5
    assert by_chance is (gain == 1.0)
    assert verdict.effects == (() if by_chance else ("lead",))
    assert verdict.by_chance == verdict.unsupported == (("lead",) if by_chance else ())
    assert verdict.indistinguishable == (() if by_chance else (("lead", "lag"),))
    assert verdict.contradicted_by == (("lead",) if verify is RISES and not by_chance else ())
    assert verdict.contradictions == ((RISES.contradiction(),) if verdict.contradicted_by else ())
    assert (verdict.standing == "nothing") is by_chance


def test_what_only_a_dispensable_effect_was_contradicted_by_is_a_stand_in():
    """Two effects, and runs to verify that speak against one: beside confirmed terms that one is not needed."""
    two = replace(LEAD, added=("lead", "lag"), verify=(RISES,))
    assert conclude(two).contradicted_by == ("lead",)
    cleared = conclude(replace(two, dispensable=("lead",)))
    assert (cleared.effects, cleared.standing, cleared.contradicted_by) == (("lag",), "stand_in", ())
    assert cleared.stood_in == ("lead",)


SHOWS_NOTHING = VerifyChange("lag", 0.1, 0.0999, 0.001, shown=0.06)  # due if it acts: to 0.08


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (SHOWS_NOTHING, ("lead",)),
        (replace(SHOWS_NOTHING, after=0.097), ("lead", "lag")),  # it falls by three standard errors
        (replace(SHOWS_NOTHING, shown=0.02), ("lead", "lag")),  # due to 0.098: within chance of what came
        (replace(SHOWS_NOTHING, std_error=0.02), ("lead", "lag")),  # nobody knows
        (replace(SHOWS_NOTHING, after=0.103), ("lead", "lag")),  # contradicted, which is said of what is named
        (replace(SHOWS_NOTHING, before=0.05, after=0.0499, with_mean=(0.1, 0.097)), ("lead", "lag")),
        (
            replace(SHOWS_NOTHING, before=0.05, after=0.0499, with_mean=(0.1, 0.0999), std_error_without_mean=0.001),
            ("lead",),
        ),
        (
            replace(SHOWS_NOTHING, before=0.05, after=0.02, with_mean=(0.1, 0.0999), std_error_without_mean=0.001),
            ("lead", "lag"),
        ),
    ],
)
def test_what_was_added_last_is_not_named_where_validation_data_would_show_it_and_do_not(change, named):
    two = replace(LEAD, added=("lead", "lag"), verify=(FALLS, change), alternatives=(("lag", "delay"),))
    verdict = conclude(two)
    assert verdict.effects == named
    assert verdict.unconfirmed == (() if "lag" in named else ("lag",))
    assert verdict.indistinguishable == ((("lag", "delay"),) if "lag" in named else ())


def test_an_effect_of_which_validation_data_show_nothing_is_named_where_a_later_one_is():
    """Two that show themselves together: the first alone need not lower the error."""
    first = replace(SHOWS_NOTHING, effect="lead")
    assert conclude(replace(LEAD, added=("lead", "lag"), verify=(first, FALLS))).effects == ("lead", "lag")
    assert conclude(replace(LEAD, verify=(first,))).effects == ()


@pytest.mark.parametrize(
    ("residual", "noise"),
    [
        (Residual(0.01019, 0.01), True),  # 2 % above the floor
        (Residual(0.01021, 0.01), False),
        (Residual(0.0104, 0.01, spread=0.007), True),  # 2 % and three deviations
        (Residual(0.0124, 0.01, excess=0.25), True),
        (Residual(0.01, None, correlation=0.4), True),
        (Residual(0.01, None, correlation=0.6), False),
        (Residual(0.02, 0.01, predicted=NOT_PREDICTED), True),
        (Residual(0.02, 0.01, predicted=PREDICTED), False),
        (Residual(0.01, 0.01, predicted=PREDICTED), True),
    ],
)
def test_an_error_is_noise_up_to_its_floor_and_chance(residual, noise):
    assert is_noise(residual) is noise


def test_other_criteria_lead_to_another_verdict():
    assert (
        conclude(replace(LEAD, residual=FAR), Criteria(evidence=replace(EVIDENCE_CRITERIA, floor_margin=2.5))).standing
        == "found"
    )


def test_a_group_is_told_once_and_never_with_what_is_dispensable():
    """Lag and delay stand in a group each and in a pair: the pair says it all."""
    found = Findings(
        added=("lag", "delay", "play"),
        alternatives=(("lag", "lead"), ("delay",), ("play", "dead_zone")),
        lag_pairs=(("lag", "delay", "lead"),),
        residual=FAR,
    )
    assert conclude(found).indistinguishable == (("play", "dead_zone"), ("lag", "delay", "lead"))
    assert conclude(replace(found, dispensable=("play",))).indistinguishable == (("lag", "delay", "lead"),)


def test_a_stand_in_says_why():
    """Each reason by itself; where none holds, or a named effect is contradicted, there is none."""
    rises = replace(FALLS, effect="play", before=0.01, after=0.02)
    found = replace(LEAD, residual=Residual(0.01, None, correlation=0.4))
    for finding, reasons in (
        (replace(LEAD, residual=None), ("untested",)),
        (replace(LEAD, residual=FAR), ("unexplained",)),
        (replace(found, at_bound=("lead",)), ("at_bound",)),
        (replace(found, added=("lead", "play"), dispensable=("play",), verify=(rises,)), ("dispensable_contradicted",)),
        (found, ()),
        (replace(LEAD, residual=FAR, verify=(replace(rises, effect="lead"),)), ()),
    ):
        verdict = conclude(finding)
        assert verdict.because == reasons
        assert (verdict.standing == "stand_in") is bool(reasons)


def test_the_numbers_of_a_group_stand_beside_it_and_those_of_no_group_are_left_out():
    """Of an effect that is dispensable there is no group, and so there are no numbers."""
    near = Separation(1.0, 12.3, 1e-6, 1e-5, 1e-6, 0.0, 3e-4, 1e-7, 1e-6)
    both = tuple(Alternative(other, name, near) for name, other in (("lag", "lead"), ("play", "dead_zone")))
    found = Findings(
        added=("lag", "play"),
        alternatives=(("lag", "lead"), ("play", "dead_zone")),
        compared=both,
        residual=FAR,
    )
    assert conclude(found).alternatives == both
    assert conclude(replace(found, dispensable=("play",))).alternatives == both[:1]
    competing = replace(found, competing=both, dispensable=("play",))
    assert conclude(competing).competing == both[:1]  # of named effects alone


def test_two_lags_that_are_named_are_as_probable_as_both_together():
    """By hand: ln w = η G − κ k, and with something unlisted η λ (58 − G) − κ_u more, + δ with effects.

    The residual of the two is noise: nothing can be gained beyond their 58 nats, whatever the floor promises.
    """
    c = EVIDENCE_CRITERIA
    gains = SetGains({NOTHING: 0.0, frozenset({"lag"}): 40.0, frozenset({"lag", "delay"}): 58.0}, most=60.0)
    found = Findings(added=("lag", "delay"), lag_pairs=(("lag", "delay", "lead"),), residual=NOISE, set_gains=gains)
    alone = [math.exp(c.learning_rate * gain - c.effect_prior * count) for count, gain in enumerate((0.0, 40.0, 58.0))]
    charged = (c.unlisted_prior, *[c.unlisted_prior - c.unlisted_beside_listed] * 2)
    left = [
        math.exp(c.learning_rate * c.unlisted_share * most - charge)
        for most, charge in zip((58.0, 18.0, 0.0), charged, strict=True)
    ]
    unlisted = [w * more for w, more in zip(alone, left, strict=True)]
    both = (alone[2] + unlisted[2]) / (sum(alone) + sum(unlisted))
    verdict = conclude(found)
    assert verdict.probability == pytest.approx(both)
    assert verdict.group_probabilities == (pytest.approx(both),)


def test_a_candidate_is_grouped_as_the_verdict_groups_it():
    """At the first step Coulomb and presliding friction tie; the verdict tells them apart, and so does the list."""
    friction = Findings(added=("coulomb_friction",), residual=NOISE)
    assert group_of("presliding_friction", conclude(friction)) == ()
    together = ("coulomb_friction", "dead_zone")
    grouped = conclude(replace(friction, alternatives=(together,)))
    assert group_of("dead_zone", grouped) == group_of("coulomb_friction", grouped) == together
    assert group_of("presliding_friction", grouped) == ()


def test_two_lags_of_one_group_are_two_candidates():
    """Both are named: one card of the two would say that either is enough."""
    lags = Findings(added=("command_delay", "sensor_lag"), lag_pairs=(("command_delay", "sensor_lag", "loop_delay"),))
    assert group_of("command_delay", conclude(lags)) == ()
