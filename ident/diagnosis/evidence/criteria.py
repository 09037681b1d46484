"""The numbers by which two fitted models are compared."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class EvidenceCriteria:
    """The comparison of two fitted models: which data are distinct, which gain is chance, and which gain matters."""

    degrees_of_a_band: float = 30.0
    """[degrees of freedom] Most of the degrees of freedom of a band that count as distinct. Why: an unmodelled term
    repeats itself in every sample of a band, so that more samples say nothing new about it; 10 to 100 rank alike on the
    corpus of docs/decisions/evidence.md.
    Test: test_criteria_of_evidence.py::
    test_a_band_of_many_samples_has_thirty_distinct_degrees_of_freedom_and_all_bands_a_hundred"""
    degrees_in_all: float = 100.0
    """[degrees of freedom] Most of the degrees of freedom of all bands together that count as distinct. Why: an
    unmodelled term is not independent from band to band and run to run either; 30 to 300 are as well calibrated on the
    corpus, none at all is not.
    Test: test_criteria_of_evidence.py::
    test_a_band_of_many_samples_has_thirty_distinct_degrees_of_freedom_and_all_bands_a_hundred"""
    bands_of_an_octave: float = 4.0
    """[bands] Bands of an octave of a record that is not periodic. Why: finer than the peaks of a damped machine, wide
    enough that the energy of a band is steady.
    Test: test_criteria_of_evidence.py::test_bands_are_a_quarter_of_an_octave_wide_and_have_four_lines_at_least"""
    lines_of_a_band: int = 4
    """[spectral lines] Fewest spectral lines of a band. Why: the energy of a band of fewer than eight degrees of
    freedom scatters by more than half of itself.
    Test: test_criteria_of_evidence.py::test_bands_are_a_quarter_of_an_octave_wide_and_have_four_lines_at_least"""
    harmonics: int = 40
    """[harmonics] Most harmonics of a periodic test that have a band each; the others count with the noise. Why: dry
    friction under a sine has 1 % of its power beyond the fortieth.
    Test: test_criteria_of_evidence.py::test_a_periodic_test_has_forty_harmonics_at_most_and_eight_samples_for_each"""
    tolerance: float = 0.1
    """[1] Least level of the disturbance, over the mean level of the explainable energy. Why: without it the kinks of a
    useful model, in empty bands, outweigh the energy that it explains; 0.01 to 1 rank alike on the corpus of
    docs/decisions/evidence.md.
    Test: test_criteria_of_evidence.py::test_a_tenth_of_the_explainable_energy_is_added_to_the_disturbance"""
    floor_margin: float = 1.02
    """[1] Ratio of the error to its noise floor up to which it may be noise alone. Why: neither repeats nor spectra
    give a floor to better than 2 % (docs/diagnosis.md, Conclusion).
    Test: test_criteria_of_evidence.py::test_nothing_can_be_gained_within_two_per_cent_of_the_floor"""
    surrogates: int = 200
    """[residuals] Residuals with random phases, of which the largest gains give the bar. Why: the 95 % point of so many
    is known to three points of a per cent.
    Test: test_criteria_of_evidence.py::test_the_bar_is_of_two_hundred_surrogates"""
    chance: float = 0.05
    """[1] Probability that chance passes the bar, or that a difference exceeds its limit by chance; a less probable
    effect is not named as an alternative. Why: the custom of the field; it is corrected for the number of
    candidates, because the bar is for the largest gain.
    Test: test_criteria_of_evidence.py::test_the_worse_of_two_models_is_as_improbable_as_chance_at_twelve_nats"""
    correlation_times: float = 10.0
    """[correlation times] Length of a block. Why: means of blocks so long are independent to a tenth of their variance
    (Flegal and Jones 2010).
    Test: test_criteria_of_evidence.py::
    test_a_block_has_ten_correlation_times_and_of_a_short_record_as_many_as_make_twelve_blocks"""
    least_correlation_times: float = 4.0
    """[correlation times] Shortest length of a block. Why: means of blocks so long are independent to a quarter of
    their variance: the error is one eighth too small, and Student's value for more blocks falls by more than that.
    Test: test_criteria_of_evidence.py::
    test_a_block_has_ten_correlation_times_and_of_a_short_record_as_many_as_make_twelve_blocks"""
    enough_blocks: int = 12
    """[blocks] Number in a record up to which its blocks may be shorter than ten correlation times. Why: Student's
    value is 1.8 for twelve blocks, one tenth more than for many; it is 2.4 for four, whose scatter is hardly known.
    Test: test_criteria_of_evidence.py::
    test_a_block_has_ten_correlation_times_and_of_a_short_record_as_many_as_make_twelve_blocks"""
    whole_runs: int = 4
    """[runs] Least number for which whole runs are held out, and are the blocks. Why: a difference from run to run
    shows between runs only, the scatter of fewer than four runs is hardly known, and a fit of fewer without one of them
    is too poor.
    Test: test_criteria_of_evidence.py::test_a_record_has_four_blocks_to_sixty_four_and_of_four_runs_each_is_one"""
    least_blocks: int = 4
    """[blocks] Fewest blocks of all runs together. Why: with two Student's value is 6.3, and nothing matters.
    Test: test_criteria_of_evidence.py::test_a_record_has_four_blocks_to_sixty_four_and_of_four_runs_each_is_one"""
    most_blocks: int = 64
    """[blocks] Most blocks of a record. Why: student's critical value hardly falls beyond, and longer blocks are safer.
    Test: test_criteria_of_evidence.py::test_a_record_has_four_blocks_to_sixty_four_and_of_four_runs_each_is_one"""
    correlation_window: float = 5.0
    """[correlation times] Length over which the correlations of a series are summed to its correlation time. Why: the
    automatic window of Sokal (1997): a shorter sum lacks a part, a longer one adds noise.
    Test: test_criteria_of_evidence.py::test_the_correlations_of_a_series_are_summed_over_five_correlation_times"""
    samples_of_a_harmonic: int = 8
    """[samples] Least number in a record for each harmonic that has a band. Why: a harmonic has two degrees of freedom,
    and three quarters of all stay for the noise between the harmonics.
    Test: test_criteria_of_evidence.py::test_a_periodic_test_has_forty_harmonics_at_most_and_eight_samples_for_each"""
    dependent: float = 1e-09
    """[of the largest] Size of a direction, or of the unexplained part of a response, below which the others explain
    all of it. Why: rounding of products of ten thousand samples; its root for a norm.
    Test: test_criteria_of_evidence.py::
    test_a_response_of_which_the_sensitivities_leave_a_part_in_thirty_thousand_is_explained"""
    share: float = 0.01
    """[1] Share of the explainable power that matters: an effect takes more, no part of the data loses as much, the
    residual power of a dominated model is larger by as much. Why: less is not worth a parameter, however certain.
    Test: test_rule.py::test_a_hundredth_of_the_power_matters"""
    least_gain: float = 3.4
    """[nats] Gain that an effect has to make whatever the bar. Why: Jeffreys (1961) calls a likelihood thirty times as
    large very strong evidence; the probability of the effect follows from another number (learning_rate).
    Test: test_rule.py::
    test_a_gain_improves_that_is_worth_a_parameter_and_passes_the_bar_or_half_of_what_can_be_gained"""
    level: float = 3e-4
    """[of the standard deviation] Root mean square of the means of the runs that matters; smaller ones count as that in
    a score. Why: a smaller mean is of no use to anyone.
    Test: test_rule.py::test_means_of_three_in_ten_thousand_of_the_deviation_matter"""
    separation: float = 0.05
    """[1] Power of the difference of two outputs over the residual power of the better one above the noise. Why: an
    effect that both lack may have turned the order of two outputs so near to each other.
    Test: test_criteria_of_evidence.py::test_outputs_are_near_within_a_twentieth_of_the_unexplained_power"""
    resolution: float = 36.0
    """[noise variances] Energy of the difference of two outputs up to which white noise hides it. Why: outputs f, g are
    three standard deviations apart where |f − g|² = 36 σ²: |f − g| / (2 σ) is the deviation of the likelihood ratio.
    Test: test_criteria_of_evidence.py::test_noise_hides_a_difference_of_thirty_six_variances"""
    learning_rate: float = 0.24
    """[1] Factor of a gain in the logarithm of a model's weight. Why: fitted to the training seeds of
    docs/decisions/evidence.md and frozen.
    Test: test_criteria_of_evidence.py::test_the_worse_of_two_models_is_as_improbable_as_chance_at_twelve_nats"""
    effect_prior: float = 5.1
    """[1] Fall of the logarithm of a model's weight with each effect. Why: fitted to the training seeds of
    docs/decisions/evidence.md and frozen.
    Test: test_evidence.py::test_probabilities_are_frozen"""
    unlisted_share: float = 0.8
    """[1] Share of the gain still possible that something unlisted is credited with. Why: a listed effect predicts the
    waveform of the residual that it explains, something unlisted only its power. Trials with single effects do not
    determine the share. With a larger share several effects that explain all but the noise would lose to something
    unlisted.
    Test: test_evidence.py::test_several_effects_that_leave_only_noise_do_not_lose_to_something_unlisted"""
    reaches: float = 0.5
    """[1] Share of the largest possible gain that passes whatever the bar. Why: where a residual has few harmonics some
    candidate often matches a random phase, and the bar comes near to the largest possible gain; after half of that
    gain, in the logarithm, any further effect gains little.
    Test: test_rule.py::
    test_a_gain_improves_that_is_worth_a_parameter_and_passes_the_bar_or_half_of_what_can_be_gained"""
    model_error_samples: int = 20_000
    """[samples] Of all records together in the model of the error; longer ones are averaged, or cut into parts.
    Why: a share of one in a thousand shows in so many, and it takes a third of a second.
    Test: test_model_error.py::test_long_records_are_shortened_to_twenty_thousand_samples"""
    unlisted_prior: float = 6.5
    """[1] Fall of the logarithm of a model's weight with something unlisted. Why: fitted to the training seeds of
    docs/decisions/evidence.md, with true effects taken off the list.
    Test: test_evidence.py::test_probabilities_are_frozen"""
    unlisted_beside_listed: float = 2.5
    """[1] Amount by which this fall is smaller where a listed effect acts. Why: a model that lacks one effect often
    lacks another; fitted to the same seeds, with one of several true effects off the list.
    Test: test_evidence.py::test_probabilities_are_frozen"""

    def of_several(self, count: int) -> EvidenceCriteria:
        """These criteria with the chance of one question so small that it holds for `count` together (Šidák 1967)."""
        return replace(self, chance=1.0 - (1.0 - self.chance) ** (1.0 / max(count, 1)))


EVIDENCE_CRITERIA = EvidenceCriteria()
"""The criteria by which two models are compared."""
OF_SHOWN = replace(EVIDENCE_CRITERIA, least_gain=0.0)
"""The criteria for an effect that the records themselves show. Why: it is no longer one of many equally improbable."""
