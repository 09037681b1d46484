"""The verdict in three lines, of findings of every standing."""

from __future__ import annotations

from dataclasses import replace

from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Baseline, Diagnosis, NextRun, NoiseTest, Rung, Suspect, Verdict

STRENGTH = {"dead_zone.half_width": ParameterEstimate(8e-5, "m", 2e-7, "δ")}
FOUND = Diagnosis(
    baseline=Baseline(error={"fit": 0.12}),
    noise_floor={"fit": 0.005, "verify": 0.005},
    candidates=(),
    ladder=(
        Rung(error={"fit": 0.12, "held_out": 0.13, "verify": 0.11}),
        Rung(added="dead_zone", error={"fit": 0.005, "held_out": 0.0052, "verify": 0.0051}, parameters=STRENGTH),
    ),
    verdict=Verdict(effects=("dead_zone",), standing="found", probabilities={"dead_zone": 0.999}),
)


def lines(**verdict: object) -> tuple[str, str, str]:
    """Those of the findings above with another verdict."""
    return replace(FOUND, verdict=replace(FOUND.verdict, **verdict)).summary  # type: ignore[arg-type]


def test_what_was_found_is_named_with_its_size_and_probability_its_errors_and_the_next_step():
    assert FOUND.summary == (
        "Missing: dead zone (80.00 ± 0.20 µm, probability over 99 %).",
        "The error on validation data goes from 11.0 % to 0.510 %; the noise floor is 0.500 %.",
        "Next: add it to the model, and compare the fits.",
    )


def test_a_group_has_one_probability_and_the_run_that_tells_it_apart():
    group = ("dead_zone", "underlap")
    told = lines(indistinguishable=(group,), group_probabilities=(0.95,))
    assert told[0] == "Missing: dead zone or underlap (one of them: probability 95 %)."
    experiment = NextRun(amplitude=1e-3, signal="blwn", frequency=10.0, seconds=5.0, sample_rate=1000.0)
    grouped = replace(FOUND.verdict, indistinguishable=(group,), group_probabilities=(0.95,))
    assert (
        replace(FOUND, verdict=grouped, next_experiment=experiment).summary[2]
        == "Next: record the proposed run, which distinguishes dead zone and underlap. Then diagnose again."
    )


def test_of_a_stand_in_the_first_line_says_that_more_is_missing_and_the_last_where_to_look():
    partly = replace(FOUND, verdict=replace(FOUND.verdict, standing="stand_in", unexplained=True))
    assert partly.summary[0].endswith("Something else is missing, too: part of the error remains.")
    assert partly.summary[2] == "Next: add it. Then search for unknown terms."
    run = NextRun(amplitude=1e-3, signal="blwn", frequency=10.0, seconds=5.0, sample_rate=1000.0)
    assert replace(partly, next_experiment=run).summary[2] == "Next: add it. Then record the proposed run."
    named = {"dead_zone": 0.999, "unlisted": 0.1}
    alone = replace(partly, verdict=replace(partly.verdict, probabilities=named))
    assert alone.summary[0] == "Missing: dead zone (80.00 ± 0.20 µm, probability over 99 %)."
    limited = replace(partly, max_effects=1).summary[2]
    assert limited == "Next: search again with up to 2 effects in all (--max-effects 2)."


def test_what_is_less_probable_than_not_is_told_apart_from_what_is_missing():
    """It lowers the error, and is in the recommended model; but that the machine lacks it is not said."""
    said = {"dead_zone": 0.97, "lead": 0.05, "unlisted": 0.9}
    both = lines(effects=("dead_zone", "lead"), standing="stand_in", unexplained=True, probabilities=said)
    assert both[0] == (
        "Missing: dead zone (80.00 ± 0.20 µm, probability 97 %). The error also falls with lead (probability 5 %), but "
        "something else is probably the cause."
    )
    one = lines(standing="stand_in", unexplained=True, probabilities={"dead_zone": 0.3, "unlisted": 0.9})
    assert one[0] == (
        "The error falls with dead zone (80.00 ± 0.20 µm, probability 30 %), but something else may be the cause."
    )
    assert lines(probabilities={"dead_zone": 0.4, "unlisted": 0.1})[0].startswith("Missing: dead zone")
    chance = lines(probabilities={"dead_zone": 0.04, "nothing": 0.93, "unlisted": 0.01})
    assert chance[0] == (
        "Probably nothing is missing. The error falls with dead zone (80.00 ± 0.20 µm, probability 4 %), which may be "
        "chance."
    )
    assert chance[2] == "Next: search for unknown terms."
    group = ("dead_zone", "underlap")
    grouped = lines(indistinguishable=(group,), group_probabilities=(0.8,), probabilities={"dead_zone": 0.3})
    assert grouped[0] == "Missing: dead zone or underlap (one of them: probability 80 %)."


def test_nothing_something_unlisted_and_what_is_contradicted_are_said():
    nothing = replace(
        FOUND, ladder=FOUND.ladder[:1], verdict=Verdict(standing="nothing", probabilities={"nothing": 0.97})
    )
    assert nothing.summary[0] == "Nothing is missing (probability 97 %)."
    assert nothing.summary[1] == "The error on validation data is 11.0 %; the noise floor is 0.500 %."
    assert nothing.summary[2] == "Next: use the model as it is."
    more = replace(nothing, verdict=Verdict(unexplained=True, probabilities={"nothing": 0.89, "unlisted": 0.09}))
    assert more.summary[0] == (
        "Probably nothing is missing (probability 89 %), though the error is larger than its noise floor explains."
    )
    no_floor = replace(more, verdict=replace(more.verdict, noise_test=NoiseTest(0.11, 0.5, correlation=0.8)))
    assert no_floor.summary[0] == "Probably nothing is missing (probability 89 %), though the residual is correlated."
    unlisted = replace(nothing, verdict=Verdict(unexplained=True, probabilities={"unlisted": 0.9}))
    assert unlisted.summary[0] == "Missing: something that no effect in the library explains (probability 90 %)."
    against = lines(standing="contradicted", contradicted_by=("dead_zone",))
    assert against[0].startswith("Not confirmed: dead zone (")
    later = lines(standing="contradicted", effects=("dead_zone", "underlap"), contradicted_by=("underlap",))
    assert later[0].startswith("The error falls with dead zone (80.00 ± 0.20 µm). Not confirmed: underlap. Estimation")
    assert against[2].startswith("Next: do not add dead zone yet. Compare the fit with it and the fit without it")


def test_what_is_by_chance_is_said_and_the_model_without_it_is_recommended():
    of_all = {"nothing": 0.7, "dead_zone": 0.2, "unlisted": 0.1}
    verdict = Verdict(standing="nothing", by_chance=("dead_zone",), probabilities=of_all)
    found = replace(FOUND, verdict=verdict)
    assert found.summary == (
        "Probably nothing is missing. The error falls with dead zone (probability 20 %), which may be chance.",
        "The error on validation data is 11.0 %; the noise floor is 0.500 %.",
        "Next: use the model as it is.",
    )
    assert [rung.added for rung in found.confirmed_ladder] == [None]


def test_nothing_is_not_the_headline_of_a_model_that_fails_on_validation_data_alone():
    verdict = Verdict(standing="nothing", probabilities={"nothing": 0.8, "unlisted": 0.1})
    errors = {"fit": 0.006, "held_out": 0.006, "verify": 0.11}
    found = replace(FOUND, ladder=(Rung(error=errors),), verdict=verdict)
    assert found.summary[0].startswith(
        "No effect is confirmed, but the error on validation data is far above its noise"
    )
    assert found.summary[2].startswith("Next: compare the conditions of the validation runs with those of the")
    above = replace(found, verdict=replace(verdict, unexplained=True))
    assert (above.summary[0], above.summary[2]) == (found.summary[0], found.summary[2])
    unlisted = replace(above, verdict=replace(above.verdict, probabilities={"unlisted": 0.9}))
    assert unlisted.summary[0].startswith("Missing: something that no effect in the library explains")


def test_a_wrong_label_and_a_search_that_was_stopped_come_first():
    assert lines(suspects=(Suspect("run-3"),))[2] == (
        "Next: correct the label of run-3 in matrix.yaml, then diagnose again: dead zone may still be missing."
    )
    unnamed = replace(FOUND, verdict=Verdict(suspects=(Suspect("A"),), unexplained=True))
    assert unnamed.summary[0].startswith("The label of run A looks wrong")
    mass = Suspect("A", "mass", stated=0.87, found=2.671, unit="kg")
    assert lines(suspects=(mass,))[2] == (
        "Next: correct the mass of run A in matrix.yaml, then diagnose again: dead zone may still be missing. "
        "The mass is stated as 0.8700 kg; the data say 2.671 kg."
    )
    alone = replace(FOUND, verdict=Verdict(suspects=(mass,), unexplained=True))
    assert alone.summary[2] == (
        "Next: correct the mass of run A in matrix.yaml, then diagnose again. It is stated as 0.8700 kg; the data say "
        "2.671 kg."
    )
    stopped = replace(FOUND, complete=False, verdict=Verdict())
    assert stopped.summary[::2] == (
        "Nothing was examined: there was no time for it.",
        "Next: search again with more time (--time, in s).",
    )


def test_where_nothing_was_fitted_no_empty_table_and_no_error_is_shown():
    stopped = Diagnosis(
        candidates=(), verdict=Verdict(text="No time."), complete=False, baseline=Baseline({"fit": None})
    )
    assert stopped.summary[1] == "The error of the model is not known."
    assert all(isinstance(said, str) for said in stopped.listings())
    shown = [one.header[0] for one in FOUND.listings() if not isinstance(one, str)]
    assert shown == ["error (eq. 17)", "added"]


def test_a_diagnosis_of_an_earlier_version_has_them_without_probabilities():
    assert lines(probabilities={})[0] == "Missing: dead zone (80.00 ± 0.20 µm)."
