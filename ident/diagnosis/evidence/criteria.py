"""The numbers by which two fitted models are compared: name, value, unit, meaning, reason and test."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

_TESTS = "tests/diagnosis/test_evidence.py::"


def _number(value: Any, unit: str, meaning: str, reason: str, test: str) -> Any:
    """A field of :class:`EvidenceCriteria` with what has to be said of it."""
    return field(default=value, metadata={"unit": unit, "meaning": meaning, "reason": reason, "test": _TESTS + test})


class Criterion(NamedTuple):
    """A number that decides something, with its unit, meaning, reason and the test that fails where it is wrong."""

    name: str
    value: float
    unit: str
    meaning: str
    reason: str
    test: str


@dataclass(frozen=True)
class EvidenceCriteria:
    """Every number of the comparison of two fitted models."""

    # What is distinct ------------------------------------------------------------------------------------------------
    degrees_of_a_band: float = _number(
        30.0, "degrees of freedom", "most of the degrees of freedom of a band that count as distinct",
        "An unmodelled term repeats itself in every sample of a band, so that more samples say nothing new about it; "
        "10 to 100 rank alike on the corpus of docs/decisions/evidence.md.",
        "test_what_lies_in_a_few_lines_is_not_lost_among_those_of_a_long_record",
    )  # fmt: skip
    degrees_in_all: float = _number(
        100.0, "degrees of freedom", "most of the degrees of freedom of all bands together that count as distinct",
        "What no model has is not independent from band to band and run to run either; 30 to 300 are as well "
        "calibrated on the corpus, none at all is not.",
        "test_a_hundred_times_the_samples_are_no_hundred_times_the_evidence",
    )  # fmt: skip
    bands_of_an_octave: float = _number(
        4.0, "bands", "bands of an octave of a record that is not periodic",
        "Finer than the peaks of a damped machine, wide enough that the energy of a band is steady.",
        "test_bands_are_a_quarter_of_an_octave_and_have_eight_degrees_of_freedom_at_least",
    )  # fmt: skip
    lines_of_a_band: int = _number(
        4, "spectral lines", "fewest spectral lines of a band",
        "The energy of a band of fewer than eight degrees of freedom scatters by more than half of itself.",
        "test_bands_are_a_quarter_of_an_octave_and_have_eight_degrees_of_freedom_at_least",
    )  # fmt: skip
    harmonics: int = _number(
        40, "harmonics", "most harmonics of a periodic test that are told apart; the others count with the noise",
        "Dry friction under a sine has 1 % of its power beyond the fortieth.",
        "test_five_periods_and_a_hundred_give_the_same_evidence_against_a_wrong_model",
    )  # fmt: skip
    tolerance: float = _number(
        0.1, "1", "least level of the disturbance, over the mean level of what could be explained",
        "Without it the kinks of a useful model, in bands that hold nothing, outweigh what it explains; 0.01 to 1 rank "
        "alike on the corpus of docs/decisions/evidence.md.",
        "test_a_model_that_explains_most_gains_though_its_kinks_reach_into_empty_bands",
    )  # fmt: skip

    floor_margin: float = _number(
        1.02, "1", "error over its noise floor up to which it may be noise alone",
        "Neither repeats nor spectra tell a floor nearer than 2 % (docs/diagnosis.md, step 7).",
        "test_an_error_within_two_per_cent_of_the_floor_leaves_nothing_to_gain",
    )  # fmt: skip

    # What is chance --------------------------------------------------------------------------------------------------
    surrogates: int = _number(
        200, "residuals", "residuals with random phases, of which the largest gains give the bar",
        "The 95 % point of so many is known to three points of a per cent.",
        "test_the_bar_hardly_hangs_on_the_random_phases",
    )  # fmt: skip
    chance: float = _number(
        0.05, "1", "how often chance may pass the bar, or a difference its error",
        "The custom of the field; corrected for the number of candidates, as the bar is that of the largest gain.",
        "test_the_bar_is_passed_by_chance_as_often_as_it_says",
    )  # fmt: skip
    correlation_times: float = _number(
        10.0, "correlation times", "length of a block",
        "Means of blocks so long are independent to a tenth of their variance (Flegal and Jones 2010).",
        "test_the_error_of_a_difference_holds_for_correlated_residuals",
    )  # fmt: skip
    whole_runs: int = _number(
        4, "runs", "runs from which on whole runs are the blocks",
        "What differs from run to run shows between runs only; of fewer than four their scatter tells nothing.",
        "test_what_only_one_of_many_runs_asks_for_does_not_improve",
    )  # fmt: skip
    most_blocks: int = _number(
        64, "blocks", "most blocks of a record",
        "Student's critical value hardly falls beyond, and longer blocks are safer.",
        "test_the_error_of_a_difference_holds_for_correlated_residuals",
    )  # fmt: skip

    correlation_window: float = _number(
        5.0, "correlation times", "over which the correlations of a series are summed to its correlation time",
        "The automatic window of Sokal (1997): fewer leave out a part of the sum, more add noise.",
        "test_the_error_of_a_difference_holds_for_correlated_residuals",
    )  # fmt: skip
    samples_of_a_harmonic: int = _number(
        8, "samples", "of a record for each harmonic that is told apart",
        "A harmonic has two degrees of freedom: so three quarters of them stay for the noise between.",
        "test_five_periods_and_a_hundred_give_the_same_evidence_against_a_wrong_model",
    )  # fmt: skip
    dependent: float = _number(
        1e-9, "of the largest column", "what is left of a response below which the sensitivities explain all of it",
        "Rounding of products of ten thousand samples; its root for a norm.",
        "test_the_bar_is_passed_by_chance_as_often_as_it_says",
    )  # fmt: skip
    surrogates_at_once: int = _number(
        25, "residuals", "surrogates that lie in memory together",
        "Records may have a hundred thousand samples: 25 of them take 40 MB.",
        "test_the_bar_is_passed_by_chance_as_often_as_it_says",
    )  # fmt: skip

    # What matters ----------------------------------------------------------------------------------------------------
    share: float = _number(
        0.01, "1", "least share of the explainable power that an effect has to take",
        "Less is not worth a parameter, however certain.",
        "test_a_gain_of_less_than_a_hundredth_of_the_explainable_power_does_not_improve",
    )  # fmt: skip
    separation: float = _number(
        0.05, "1", "power between two outputs over the power that the better one leaves above the noise",
        "What is missing from both may have turned the order of two outputs so near to each other.",
        "test_two_models_that_leave_as_much_but_look_different_are_told_apart",
    )  # fmt: skip
    resolution: float = _number(
        36.0, "noise variances", "energy between two outputs that white noise does not tell apart",
        "Outputs f, g are three standard deviations apart where |f − g|² = 36 σ²: half of |f − g| over σ is the "
        "deviation of the likelihood ratio, taken from either side.",
        "test_two_models_whose_outputs_the_noise_hides_are_indistinguishable",
    )  # fmt: skip

    # How sure --------------------------------------------------------------------------------------------------------
    learning_rate: float = _number(
        0.88, "1", "factor of a gain in the logarithm of a model's weight",
        "Fitted to the training seeds of docs/decisions/evidence.md and frozen.",
        "test_probabilities_are_frozen",
    )  # fmt: skip
    effect_prior: float = _number(
        3.0, "1", "by how much the logarithm of a model's weight falls with each effect",
        "Fitted to the training seeds of docs/decisions/evidence.md and frozen.",
        "test_probabilities_are_frozen",
    )  # fmt: skip
    unlisted_share: float = _number(
        0.96, "1", "share of what is left to be gained that something unlisted is credited with",
        "Fitted to the training seeds of docs/decisions/evidence.md, with the true effects taken off the list.",
        "test_probabilities_are_frozen",
    )  # fmt: skip
    reaches: float = _number(
        0.5, "1", "share of the gain that can be reached, which passes whatever the bar",
        "Where a residual has few harmonics a random phase is often met by some candidate, and the bar comes near to "
        "all that can be gained; what gains half of that, in the logarithm, leaves little to anything else.",
        "test_what_reaches_the_noise_passes_where_one_harmonic_is_all_there_is",
    )  # fmt: skip
    unlisted_prior: float = _number(
        6.8, "1", "by how much the logarithm of a model's weight falls with something unlisted",
        "Fitted to the training seeds of docs/decisions/evidence.md, with the true effects taken off the list.",
        "test_probabilities_are_frozen",
    )  # fmt: skip

    def listed(self) -> Iterator[Criterion]:
        """Every number with what is to be said of it, in the order above."""
        for number in fields(self):
            of = number.metadata
            yield Criterion(
                number.name, float(getattr(self, number.name)), of["unit"], of["meaning"], of["reason"], of["test"]
            )


EVIDENCE_CRITERIA = EvidenceCriteria()
