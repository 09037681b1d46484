"""Effects in words: what nobody described is named by what it does, and where."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.evidence.evidence import SPANS, BlockMean, Evidence
from ident.diagnosis.report import better_with_fewer
from ident.diagnosis.sentences import proposed_text, verdict_text, why_of_evidence
from ident.diagnosis.verification import Contradiction, noise_on_validation_data
from ident.effects import EFFECTS
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run, Specimen

LAST = [*SPANS][-1]


def matrix(actuator: Actuator, **labels: object) -> Matrix:
    u = np.random.default_rng(1).standard_normal((2, 600))
    channels, units = {"command": u[0], "displacement": u[1]}, {"command": "V", "displacement": "m"}
    return Matrix(actuator, (Run("one", "", 100.0, channels, units, **labels),))  # type: ignore[arg-type]


def family(of: Matrix) -> CandidateModels:
    return CandidateModels.of(of, Settings(model="open_valve"))


def test_a_part_that_nobody_described_is_named_by_what_it_does():
    bare = family(matrix(Actuator("ANY")))
    assert (
        bare.described("spool_stiction")
        == "spool stiction (the spool moves only above a breakaway signal, at the valve)"
    )
    assert bare.described("cubic_stiffness") == "cubic stiffness (stiffness that changes with position, at the load)"
    assert bare.described("dead_zone") == "dead zone"
    valve = family(matrix(Actuator("ANY", servo_valve="D765")))
    assert valve.described("spool_stiction") == "spool stiction"
    assert valve.described("cubic_stiffness") == bare.described("cubic_stiffness")
    loaded = family(matrix(Actuator("ANY"), specimen=Specimen(mass=20.0)))
    assert loaded.described("cubic_stiffness") == "cubic stiffness"


def test_an_effect_of_a_group_is_said_with_the_others_and_the_probability_of_the_group():
    groups, single = [("backlash", "spool_stiction")], {"spool_stiction": 0.6, "backlash": 0.36, "dead_zone": 0.97}
    text = verdict_text(
        ("spool_stiction", "dead_zone"),
        groups,
        (),
        False,
        {"fit": 0.01},
        0.2,
        probabilities=single,
        group_probabilities=[0.96],
    )
    assert "lacks spool stiction or backlash (one of them: probability 96 %) and dead zone (probability 97 %)" in text
    assert ": with spool stiction and dead zone the error falls" in text
    doubtful = {"dead_zone": 0.04, "nothing": 0.95, "unlisted": 0.01}
    text = verdict_text(("dead_zone",), (), (), False, {"fit": 0.19}, 0.2, probabilities=doubtful)
    assert "lacks" not in text
    assert "More probably this has another cause, or is chance." in text


def test_an_error_above_its_floor_is_drift_rather_than_something_unlisted_where_that_is_more_probable():
    for unlisted, said in ((0.09, "Drift and disturbances are a more probable cause"), (0.6, "Something remains that")):
        text = verdict_text((), (), (), True, {"fit": 0.2}, 0.2, probabilities={"nothing": 0.3, "unlisted": unlisted})
        assert said in text
        without = verdict_text(
            (), (), (), True, {"fit": 0.2}, None, probabilities={"nothing": 0.3, "unlisted": unlisted}
        )
        assert said in without
        assert "floor explains" not in without


def test_effects_that_are_nearly_as_probable_as_the_named_one_are_said():
    """Dry friction of two forms explains nearly as much: whoever reads one name alone would think that it is sure."""
    probable = {"presliding_friction": 0.11, "coulomb_friction": 0.1, "backlash": 0.09, "dead_zone": 0.05}
    text = verdict_text(
        ("presliding_friction",),
        [("presliding_friction", "backlash")],
        (),
        False,
        {"fit": 0.1},
        0.2,
        probabilities=probable | {"nothing": 0.2, "unlisted": 0.4},
    )
    assert "Nearly as probable: Coulomb friction (probability 10 %)." in text
    text = verdict_text(
        ("presliding_friction", "dead_zone"),
        (),
        (),
        False,
        {"fit": 0.1},
        0.2,
        probabilities={**probable, "dead_zone": 0.002, "free_play": 0.001},
    )
    assert "Nearly as probable: Coulomb friction (probability 10 %) and backlash (probability 9 %)." in text
    sure = probable | {"presliding_friction": 0.8}
    text = verdict_text(("presliding_friction",), (), (), False, {"fit": 0.1}, 0.2, probabilities=sure)
    assert "as probable" not in text


def test_where_no_more_effects_could_be_added_it_is_not_said_that_none_explains_the_rest():
    said = [verdict_text(("dead_zone",), (), (), True, {"fit": 0.1}, 0.2, limit=limit) for limit in (None, 1)]
    assert "no effect in the library explains" in said[0]
    assert "no effect in the library" not in said[1]
    assert "The search was limited to 1 effect in all (--max-effects). More effects may explain the rest." in said[1]


def test_what_validation_data_contradict_is_told_by_the_errors_on_both_data():
    against = [Contradiction("backlash", 0.0107, 0.0239, 52.1)]
    text = verdict_text(("backlash",), (), (), False, {"fit": 0.00499, "verify": 0.0239}, 0.0173, against=against)
    assert text == (
        "With backlash the error on validation data rises from 1.07 % to 2.39 % (52.1 standard errors): either it only "
        "imitates something else, or the machine was different in these runs. With backlash the error on estimation "
        "data falls from 1.73 % to 0.499 %."
    )


@pytest.mark.parametrize(
    ("in_band", "floor", "said"),
    [
        (False, 0.005, "The noise floor was measured only at frequencies above those of the command"),
        (False, None, "Record one run twice with the same command to learn"),
        (True, 0.005, ""),
    ],
)
def test_where_the_noise_floor_was_measured_is_said_where_it_is_not_that_of_the_whole_error(in_band, floor, said):
    text = verdict_text((), (), (), True, {"fit": 0.07}, 0.07, in_band=in_band, floor=floor)
    assert said in text
    assert ("Record one run twice" in text) is not in_band
    assert ("The noise floor was measured" in text) is (not in_band and floor is not None)


def test_where_no_command_was_repeated_it_is_said_whether_the_command_predicts_the_residual():
    probable = {"nothing": 0.9, "unlisted": 0.05}
    noise = verdict_text((), (), (), False, {"fit": 0.07}, 0.07, in_band=False, floor=0.05, by_prediction=True)
    assert noise == "Nothing seems to be missing: the command predicts nothing of the residual, 7.00 %."
    with_probability = verdict_text(
        (), (), (), False, {"fit": 0.07}, 0.07, in_band=False, floor=0.05, by_prediction=True, probabilities=probable
    )
    assert with_probability.startswith("Nothing seems to be missing (probability 90 %): the command predicts nothing")
    missing = verdict_text((), (), (), True, {"fit": 0.07}, 0.07, in_band=False, floor=0.05, by_prediction=True)
    assert "The command predicts a part of the residual, so the residual is not noise alone." in missing


@pytest.mark.parametrize(
    ("errors", "floors", "noise"),
    [
        ({"fit": 0.0123, "verify": 0.377}, {"fit": 0.0123, "verify": 0.0120}, 0.0120),
        ({"fit": 0.0123, "verify": 0.0265}, {"fit": 0.0123, "verify": 0.0100}, 0.0100),
        ({"fit": 0.0123, "verify": 0.0185}, {"fit": 0.0123, "verify": 0.0100}, None),
        ({"fit": 0.05, "verify": 0.07}, {"fit": 0.01, "verify": 0.01}, None),  # as far above its noise
        ({"fit": 0.01, "verify": 0.4}, {"fit": 0.01, "verify": None}, None),
    ],
)
def test_nothing_is_missing_on_estimation_data_alone_where_validation_data_have_more_than_noise(errors, floors, noise):
    """More than twice its noise, beyond what the estimation data have of theirs."""
    assert noise_on_validation_data(errors, floors) == noise
    text = verdict_text((), (), (), False, errors, errors["fit"], floor=floors["fit"], noise_there=noise)
    assert text.startswith("Nothing is missing: the error of")
    assert ("On validation data the error is" in text) is (noise is not None)
    for unlisted, said in ((0.3, noise is not None), (0.7, False)):
        probable = {"nothing": 1.0 - unlisted, "unlisted": unlisted}
        above = verdict_text(
            (), (), (), True, errors, errors["fit"], floor=floors["fit"], noise_there=noise, probabilities=probable
        )
        assert ("On validation data the error is" in above) is said


def test_what_is_by_chance_is_said_with_the_error_with_it():
    text = verdict_text(
        (),
        (),
        (),
        False,
        {"fit": 0.0123},
        0.0123,
        floor=0.012,
        probabilities={"nothing": 0.62},
        by_chance=(("lag",), 0.0121),
    )
    assert text.startswith(
        "Probably nothing is missing (probability 62 %). The error on estimation data falls from 1.23 % to 1.21 % with "
    )
    assert text.endswith("more probably this is chance.")


@pytest.mark.parametrize("against", [True, False])
def test_a_verdict_says_what_an_effect_does_once(against):
    models = family(matrix(Actuator("ANY")))
    rises = [Contradiction("cubic_stiffness", 0.1, 0.2, 3.0)] if against else []
    added = ("dead_zone", "cubic_stiffness", "spool_stiction")
    text = verdict_text(
        added,
        [("spool_stiction", "backlash")],
        (),
        False,
        {"fit": 0.01},
        0.2,
        against=rises,
        described=models.described,
    )
    assert text.count("stiffness that changes with position") == 1
    assert text.count("(the spool moves only above a breakaway signal, at the valve)") == 1
    assert text.count("spool stiction") == 2
    first = "cubic stiffness" if against else "cubic stiffness (stiffness that changes with position, at the load)"
    assert f"With dead zone, {first} and" in text or f"lacks dead zone, {first} and" in text


def test_a_stated_drive_is_a_description():
    closed = matrix(Actuator("ANY"))
    runs = tuple(replace(run, gain=4.0) for run in closed.runs)
    assert family(replace(closed, runs=runs)).described("supply_droop") == "supply droop"


@pytest.mark.parametrize(("last", "mended"), [(0.07, True), (0.25, False)])
def test_what_later_terms_bring_down_is_not_said_first(last, mended):
    """The first of two terms lets the verify error rise from 24 to 31 %; the second brings it to 7 %, or not."""
    against = Contradiction("proposed_1", 0.24, 0.31, 4.0)
    terms = [
        Proposal(place=("force",), equation="R = R + s * v", effect={}, error={"verify": 0.31}, contradicted=against),
        Proposal(place=("force",), equation="R = R + s * x", effect={}, error={"fit": 0.1, "verify": last}, terms=2),
    ]
    text = proposed_text(terms)
    alone = (
        "With R = R + s * v, and without the terms after it, the error on validation data rises from 24.0 % to 31.0 %."
    )
    assert text.startswith("The search proposes") is mended
    assert text.endswith(alone) is mended
    assert text.startswith("With R = R + s * v the error on validation data rises") is not mended


def found(share: float, losing: bool = False) -> Evidence:
    """An effect that takes a share of what is above the noise, and loses in one span of the records or in none."""
    sure, lost = BlockMean(share, 0.02, 20), BlockMean(-0.5, 0.01, 20)
    return Evidence(
        gain=20.0,
        without=20.0,
        most=100.0,
        distinct=50.0,
        before=0.01,
        after=0.008,
        noise=0.0001,
        difference=sure,
        share=sure,
        by_part=lambda: {LAST: lost if losing else sure},
        apart=0.001,
        resolved=1e-6,
    )


@pytest.mark.parametrize(
    ("evidence", "worth_adding", "said", "unsaid"),
    [
        (found(0.4), True, "It shows as", "chance"),
        (found(0.4), False, "no more than the best of all effects gains by chance", "It shows"),
        (found(0.03), False, "explains 3 ± 3.5 % of the error above the noise floor", "chance"),
        (found(0.4, losing=True), False, f"The error rises on the {LAST} of the records", "chance"),
    ],
)
def test_an_effect_says_why_it_helps_or_does_not(evidence, worth_adding, said, unsaid):
    text = why_of_evidence(evidence, EFFECTS[0], (0.0275, 0.0249), worth_adding, 0.02, best=False)
    assert said in text
    assert unsaid not in text


def test_a_smaller_error_on_verify_runs_on_the_way_is_told_with_what_was_added_since():
    """A measured motor: with the dead zone 6.41 % where 4.05 % were left without it, 1.6 standard errors."""

    def refit(verify: float | None) -> SimpleNamespace:
        return SimpleNamespace(errors={"fit": 0.1, "held_out": 0.1, "verify": verify})

    way = [(None, refit(0.217)), ("flow_saturation", refit(0.0405)), ("dead_zone", refit(0.0641))]
    fewer = better_with_fewer(way)
    assert fewer == (0.0405, ("dead_zone",))
    errors = {"fit": 0.0279, "verify": 0.0641}
    text = verdict_text(("flow_saturation", "dead_zone"), (), (), True, errors, 0.22, fewer=fewer)
    assert "to 2.79 % (6.41 % on validation data, 4.05 % without dead zone)." in text
    assert better_with_fewer([*way[:2], ("dead_zone", refit(0.044))]) is None
    assert better_with_fewer([(None, refit(None)), ("dead_zone", refit(None))]) is None
    assert better_with_fewer([(None, refit(0.03)), *way[1:]]) == (0.03, ("flow_saturation", "dead_zone"))
