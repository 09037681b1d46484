"""Every number that decides how much of a record is noise, by the way in which the noise is found.

Below each number stand [its unit], its meaning (read: value, unit, meaning), the reason for it, and the test in
tests/noise that fails where the number moves by 30 %.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Innovations:
    """The prediction of a residual from its own past, and how long the residual remembers."""

    order: int = 32
    """[samples] Of the past from which the next sample is predicted. Why: a resonance at a tenth of the sample rate,
    and a drift with it, need a few; more than that costs a parameter each.
    Test: test_criteria.py::test_a_sample_is_predicted_from_the_32_before_it_or_a_tenth_of_the_record"""
    samples_of_a_coefficient: int = 10
    """[samples] Of a record for each sample of the past. Why: a coefficient is then known to a third of its size.
    Test: test_criteria.py::test_a_sample_is_predicted_from_the_32_before_it_or_a_tenth_of_the_record"""
    lags: float = 0.25
    """[of the record] Longest lag at which a correlation counts. Why: a quarter of the record holds each lag four times
    (Box and Jenkins 1976).
    Test: test_criteria.py::test_a_residual_that_repeats_itself_after_less_than_a_quarter_of_the_record_tells_less"""


@dataclass(frozen=True)
class SpectralFloor:
    """The noise that a spectrum shows where the command has no power."""

    clear: float = 1.6
    """[of the band edge] From which on the spectrum is free of the command. Why: beyond it a Hann window lets less than
    1e-6 of the power of the band through.
    Test: test_criteria.py::test_a_spectrum_shows_the_noise_where_a_fifth_of_it_is_free_of_the_command"""
    free: float = 0.2
    """[of the Nyquist frequency] Least part that is free of the command. Why: the mean over fewer frequencies scatters,
    and the filter ahead of a recorder takes the last ones.
    Test: test_criteria.py::test_a_spectrum_shows_the_noise_where_a_fifth_of_it_is_free_of_the_command"""
    end: float = 0.98
    """[of the Nyquist frequency] Up to which the spectrum is averaged. Why: of the last line half of the power is
    missing, and a Hann window spreads it over its neighbours.
    Test: test_criteria.py::test_the_last_two_per_cent_of_the_spectrum_show_no_noise"""
    shortest: int = 256
    """[samples] Fewest of a record, or of a third of one, that tell its noise. Why: a deviation of so many samples is
    known to 5 %.
    Test: test_criteria.py::test_a_record_of_fewer_than_256_samples_tells_no_noise"""
    window: int = 8192
    """[samples] Most of a window of the spectrum. Why: a long record is averaged over many windows, and each is long
    enough to part the command's band from what lies beyond it.
    Test: test_criteria.py::test_a_long_record_has_the_mean_power_of_windows_of_8192_samples"""
    fewest: int = 3
    """[records] Fewest of which the sizes tell whether the noise grows with them. Why: of two any law is true.
    Test: test_criteria.py::
    test_whether_noise_grows_with_a_record_is_told_of_three_records_that_differ_by_two_per_cent"""
    spread: float = 0.02
    """[standard deviation of logarithms] Least spread of the sizes of such records. Why: the floor of a record scatters
    by as much.
    Test: test_criteria.py::
    test_whether_noise_grows_with_a_record_is_told_of_three_records_that_differ_by_two_per_cent"""


@dataclass(frozen=True)
class PeriodicNoise:
    """The noise of a record of a periodic command."""

    periods: int = 4
    """[periods] Fewest of a command that is periodic. Why: fewer do not show what repeats.
    Test: test_criteria.py::test_a_command_is_periodic_from_four_periods_and_four_samples_a_period_on"""
    samples_of_a_period: int = 4
    """[samples] Fewest of a period. Why: with fewer the neighbours of a sample, sorted by phase, are far from it.
    Test: test_criteria.py::test_a_command_is_periodic_from_four_periods_and_four_samples_a_period_on"""
    highest_line: float = 0.5
    """[of the power] Least share of the highest line of a periodic command. Why: of repeated steps the fundamental has
    0.8, of noise no line has half.
    Test: test_criteria.py::test_the_highest_line_of_a_periodic_command_has_half_of_its_power"""
    not_repeated: float = 0.05
    """[standard deviation] Most of a periodic command that its periods may not repeat. Why: a recorder adds less.
    Test: test_criteria.py::test_a_periodic_command_is_repeated_but_for_a_twentieth"""
    parts: int = 3
    """[parts] Of a record, each judged by itself; the median is taken. Why: the first part may hold a start.
    Test: test_criteria.py::test_a_start_in_the_first_third_of_a_periodic_record_is_no_noise"""
    efficiency: float = 0.25
    """[independent samples a sample] That the estimate is worth. Why: it is a median, of residuals that have two of
    three samples in common; of 600 records of white noise it was 0.21 (512 samples) and 0.27 (4096).
    Test: test_criteria.py::test_a_periodic_record_tells_its_noise_as_well_as_a_quarter_of_its_samples"""


@dataclass(frozen=True)
class OwnPeriods:
    """The noise of a record whose command is made of many frequencies and repeats itself."""

    settled: float = 1.0
    """[periods] Of the same command before the first that is compared. Why: a start dies away in it, as a period is
    chosen longer than the machine's memory.
    Test: test_criteria.py::test_a_multisine_repeats_itself_from_three_periods_on"""
    samples_of_a_period: int = 16
    """[samples] Fewest of a period. Why: what a machine does within fewer is no answer that could be compared.
    Test: test_criteria.py::test_a_period_of_its_own_has_sixteen_samples"""
    unlike: float = 0.5
    """[of the autocorrelation at lag 0] To which it falls within a period. Why: what changes slowly is like itself a
    few samples later.
    Test: test_criteria.py::test_a_command_that_changes_slowly_does_not_repeat_itself_a_sample_later"""
    alike: float = 0.99
    """[of the autocorrelation at lag 0] That it has after a period. Why: a recorder's noise takes less; sample by
    sample the periods must then agree as two runs do.
    Test: test_criteria.py::test_a_noisy_multisine_repeats_itself"""


@dataclass(frozen=True)
class Repeats:
    """When two runs repeat one measurement."""

    exact: float = 1e-3
    """[of the standard deviation] RMS difference of two inputs up to which they are one. Why: 10 bits round by as much.
    Test: test_criteria.py::test_two_inputs_are_one_within_a_thousandth_or_three_times_their_noise"""
    noises: float = 3.0
    """[of the noise of each] RMS difference of two recorded inputs up to which they are one. Why: the noise of two
    makes 1.4 of it, and noise behind a filter is underestimated by a half.
    Test: test_criteria.py::test_two_inputs_are_one_within_a_thousandth_or_three_times_their_noise"""
    most_noise: float = 0.05
    """[of the standard deviation] Most noise of a recorded input. Why: above it a random input cannot be told from its
    noise.
    Test: test_criteria.py::test_an_input_with_more_noise_than_a_twentieth_repeats_no_other"""
    shift: int = 5
    """[samples] By which one record may begin later than another, and by which their lengths may differ. Why: triggers
    come late by a few samples.
    Test: test_criteria.py::test_a_trigger_is_late_by_five_samples_at_most_or_a_twentieth_of_the_record"""
    shift_of_a_record: float = 0.05
    """[of the record] Most that such a shift may take. Why: of a short record more would be left out than compared.
    Test: test_criteria.py::test_a_trigger_is_late_by_five_samples_at_most_or_a_twentieth_of_the_record"""
    less_by_a_shift: float = 0.9
    """[of the RMS difference without a shift] That may remain with one. Why: of 3000 pairs of noise
    alone none of 1000 samples has less with the best of eleven shifts, of 300 samples one in 25.
    Test: test_criteria.py::test_a_shift_that_takes_less_than_a_tenth_of_the_difference_is_none"""
    settled: float = 0.1
    """[of the record] From its first sample on, in which the states die away that it begins with. Why: a record is ten
    times as long as the machine's memory.
    Test: test_criteria.py::test_repeats_are_compared_behind_the_first_tenth"""
    same_start: float = 0.05
    """[of the way of a step] Between two outputs that begin at one place. Why: a machine that stands returns within so
    much to its place.
    Test: test_criteria.py::test_steps_repeat_each_other_from_starts_within_a_twentieth_of_their_way"""


@dataclass(frozen=True)
class Criteria:
    """Every number that decides how much of a record is noise."""

    innovations: Innovations = Innovations()
    spectral_floor: SpectralFloor = SpectralFloor()
    periodic_noise: PeriodicNoise = PeriodicNoise()
    own_periods: OwnPeriods = OwnPeriods()
    repeats: Repeats = Repeats()


NOISE_CRITERIA = Criteria()
