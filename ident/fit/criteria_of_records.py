"""The numbers by which a fit reads its records: what excites them, how they begin, and over which windows they hold."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Band:
    """The frequencies up to which the commands excite the machine."""

    power: float = 0.99
    """[of the power] Of every command below the edge of the band. Why: the rest may be the recorder's own noise, spread
    over all frequencies.
    Test: test_criteria_of_records.py::test_the_band_holds_all_but_a_hundredth_of_the_power_and_a_quarter_more"""
    margin: float = 1.25
    """[times that edge] Up to which the machine counts as excited. Why: a hundredth of the power lies beyond it.
    Test: test_criteria_of_records.py::test_the_band_holds_all_but_a_hundredth_of_the_power_and_a_quarter_more"""
    most: float = 0.9
    """[of the Nyquist frequency] Widest band. Why: beyond it a record shows what its filter left.
    Test: test_criteria_of_records.py::test_the_widest_band_is_nine_tenths_of_the_nyquist_frequency"""
    window: int = 16_384
    """[samples] Most of a window of the spectrum of a command. Why: it parts frequencies well below any band.
    Test: test_criteria_of_records.py::
    test_the_spectrum_of_a_command_is_that_of_a_quarter_of_it_between_256_and_16384"""
    shortest_window: int = 256
    """[samples] Least of such a window, or the whole record. Why: the band is then known to a hundredth of the Nyquist
    frequency.
    Test: test_criteria_of_records.py::
    test_the_spectrum_of_a_command_is_that_of_a_quarter_of_it_between_256_and_16384"""
    windows: int = 4
    """[windows] Of a record, without their overlap. Why: the power of each frequency is averaged over seven.
    Test: test_criteria_of_records.py::
    test_the_spectrum_of_a_command_is_that_of_a_quarter_of_it_between_256_and_16384"""


@dataclass(frozen=True)
class ReducedRecords:
    """The filters by which the record of a linear machine is reduced, and when its fast error is trusted.

    Frequencies are in units of the edge of the band. Found by scanning random models in the bounds of Table 2 of Qian
    et al. (2014): the error of representation is 2e-5 at Table 4 and below 1e-3 everywhere (docs/accuracy.md).
    """

    pair_damping: float = 0.12
    """[of the band] Damping of the filters that come in pairs. Why: with their spacing it resolves poles down to a
    damping of 0.06.
    Test: test_criteria_of_reduction.py::test_the_filters_stand_where_the_scan_of_models_placed_them"""
    pair_spacing: float = 0.07
    """[of the band] Between the frequencies of two pairs. Why: as for their damping.
    Test: test_criteria_of_reduction.py::test_the_filters_stand_where_the_scan_of_models_placed_them"""
    pair_reach: float = 1.5
    """[of the band] Up to which the pairs stand. Why: a pole beyond the band still shows within it.
    Test: test_criteria_of_reduction.py::test_the_filters_stand_where_the_scan_of_models_placed_them"""
    real: tuple[float, ...] = (0.03, 2.0, 5.0)
    """[of the band] Poles of the real filters. Why: one takes the slow end, two the fast one.
    Test: test_criteria_of_reduction.py::test_the_filters_stand_where_the_scan_of_models_placed_them"""
    nodes: int = 44
    """[frequencies] At which a model is evaluated to be represented. Why: with two values each they are twice as many
    as the filters' coefficients.
    Test: test_criteria_of_reduction.py::test_a_model_is_evaluated_at_44_frequencies_and_checked_at_four"""
    node_reach: float = 1.6
    """[of the band] Up to which these lie. Why: a little beyond the pairs.
    Test: test_criteria_of_reduction.py::test_a_model_is_evaluated_at_44_frequencies_and_checked_at_four"""
    checks: int = 4
    """[frequencies] Within the band, at which the representation is checked. Why: a misfit spreads over the whole band.
    Test: test_criteria_of_reduction.py::test_a_model_is_evaluated_at_44_frequencies_and_checked_at_four"""
    first_check: float = 0.4
    """[of the distance of two checks] Where the first of them lies. Why: not in the middle of two nodes.
    Test: test_criteria_of_reduction.py::test_a_model_is_evaluated_at_44_frequencies_and_checked_at_four"""
    beyond_band: float = 0.1
    """[weight] Of what a model does beyond the band. Why: a command shows a hundredth of its power there.
    Test: test_criteria_of_reduction.py::test_what_lies_beyond_the_band_counts_a_tenth"""
    rounding: float = 1e-13
    """[of the largest eigenvalue] Below which a combination of filtered commands is rounding. Why: a sum of products of
    many samples is as exact as that.
    Test: test_criteria_of_reduction.py::
    test_a_combination_of_filters_that_a_command_shows_by_rounding_alone_is_left_out"""
    felt: float = 1e-6
    """[of the strongest row] Below which a row of a reduced record is dropped. Why: no model of ordinary size can make
    it felt, and its share of the error is part of the rest; without it a search of a narrow command ends elsewhere.
    Test: test_criteria_of_reduction.py::test_a_row_of_a_reduced_record_is_dropped_below_a_millionth"""
    trusted: float = 0.05
    """[of the error] Doubt up to which a fast error is exact enough. Why: it moves the error by less than 0.13 %.
    Test: test_criteria_of_reduction.py::test_doubtful_vectors_are_evaluated_exactly_where_they_lead_or_are_few"""
    wrong: float = 0.2
    """[of the error] Doubt beyond which a fast error is evaluated exactly where such vectors are few. Why: it can be
    off by more than half a per cent.
    Test: test_criteria_of_reduction.py::test_doubtful_vectors_are_evaluated_exactly_where_they_lead_or_are_few"""
    shown: float = 0.1
    """[of a record's power] That the decays of all filters have to leave for a fast error to say anything. Why: seven
    measured records that begin in motion leave 0.39 to 1; of a cooler that is switched on they leave 0.000005, and its
    search ended at 52 % in place of 3.5 %.
    Test: test_criteria_of_reduction.py::test_a_record_that_is_a_decay_alone_is_evaluated_exactly"""
    leading: int = 20
    """[vectors] Of which the first is a leading one, evaluated exactly where it is doubtful. Why: the leading ones are
    the parents of the next generation, and each costs as much as many fast ones.
    Test: test_criteria_of_reduction.py::test_doubtful_vectors_are_evaluated_exactly_where_they_lead_or_are_few"""
    simulated: int = 400_000
    """[samples of all runs × vectors] That a generation simulates of its doubtful leading vectors. Why: a search of a
    record of few samples then sees most of them exactly, and all its generations take about a second more.
    Test: test_criteria_of_reduction.py::test_of_few_samples_more_of_the_doubtful_vectors_are_evaluated_exactly"""
    few_samples: int = 100_000
    """[samples] Of all runs up to which held commands are simulated for whole populations. Why: a search of more takes
    minutes.
    Test: test_criteria_of_reduction.py::test_records_of_steps_are_simulated_up_to_a_hundred_thousand_samples"""


@dataclass(frozen=True)
class FirstStates:
    """The states in which a record begins that starts moving, and the blocks of a record."""

    rounds: int = 20
    """[rounds] Of steps towards the best first states at most. Why: of a machine that is not linear in them a dozen
    may shrink before one helps.
    Test: test_criteria_of_first_states.py::test_first_states_are_followed_for_twenty_rounds_at_most"""
    followed: int = 3
    """[rounds] In which they are followed once more where a continued fit ends. Why: what a search stops at moves
    eq. (17) by some millionths.
    Test: test_criteria_of_first_states.py::test_a_continued_fit_follows_first_states_three_times"""
    settled: float = 1e-6
    """[of the residual's power] That better first states may still explain. Why: it moves no result.
    Test: test_criteria_of_first_states.py::test_first_states_hold_or_promise_much_by_what_they_explain"""
    much: float = 0.1
    """[of the residual's power] From which on better first states promise much. Why: such a step promises only as far
    as the model is straight.
    Test: test_criteria_of_first_states.py::test_first_states_hold_or_promise_much_by_what_they_explain"""
    damping: float = 1e-6
    """[of the products of the first states] Damping of the first step that is damped. Why: one that hardly changes the
    shape of the record stays.
    Test: test_criteria_of_first_states.py::test_a_damped_step_begins_with_a_millionth_and_is_damped_a_hundredfold"""
    less: float = 10.0
    """[times] By which the damping falls after a round that helped. Why: three such are as straight as it began.
    Test: test_criteria_of_first_states.py::test_a_damped_step_begins_with_a_millionth_and_is_damped_a_hundredfold"""
    more: float = 100.0
    """[times] By which the damping rises after a round that did not help. Why: after four nothing moves.
    Test: test_criteria_of_first_states.py::test_a_damped_step_begins_with_a_millionth_and_is_damped_a_hundredfold"""
    helps: float = 1e-3
    """[of the residual's power] By which it falls in a round that counts; and by which two ends are as good. Why: less
    is no reason for another simulation.
    Test: test_criteria_of_first_states.py::test_a_round_counts_that_explains_a_thousandth"""
    in_vain: int = 1
    """[rounds] That may not count where little is promised. Why: the next one seldom does.
    Test: test_criteria_of_first_states.py::test_so_many_rounds_may_be_in_vain"""
    in_vain_of_much: int = 4
    """[rounds] That may not count where much is promised. Why: the way leads over a place where the model is not
    straight.
    Test: test_criteria_of_first_states.py::test_so_many_rounds_may_be_in_vain"""
    reach: float = 1e-3
    """[of a state's size] By which a first state is moved for a sensitivity. Why: small for the model, large for
    rounding.
    Test: test_criteria_of_first_states.py::test_a_first_state_is_moved_by_a_thousandth_of_its_size"""
    of_effects: float = 3.0
    """[times the largest value that it takes in a run begun with none] Largest first state that is an effect's own.
    Why: a mass next to nothing behind a spring stretched without bounds would move each run by itself; after a
    resonance an effect may begin with more than a run gives it.
    Test: test_criteria_of_first_states.py::test_an_effect_begins_with_three_times_what_the_run_gives_it_at_most"""
    rounding: float = 1e-11
    """[of a record's deviation] Below which a moved first state does not show. Why: rounding of a simulation of many
    steps.
    Test: test_criteria_of_first_states.py::test_a_first_state_that_shows_by_rounding_alone_has_no_share"""
    begins: int = 16
    """[samples] That tell where a record begins, and fewest of a window. Why: a mean of fewer is as good as noise.
    Test: test_criteria_of_first_states.py::test_the_first_sixteen_samples_tell_where_a_record_begins"""
    bound: float = 1e3
    """[times all other samples] That these count. Why: what drifts later does not move where a record begins.
    Test: test_criteria_of_first_states.py::test_the_first_sixteen_samples_tell_where_a_record_begins"""
    blocks: int = 32
    """[blocks] Of a record, each one sample of the score. Why: long enough to hold the residual's own correlation.
    Test: test_criteria_of_first_states.py::test_a_record_has_32_blocks_of_sixteen_samples_and_more"""
    shortest_block: int = 16
    """[samples] Least of a block. Why: as for their number.
    Test: test_criteria_of_first_states.py::test_a_record_has_32_blocks_of_sixteen_samples_and_more"""
    escaped: float = 1e12
    """[of the record's power] In a residual beyond which the model has run away. Why: its first states would explain
    anything.
    Test: test_criteria_of_first_states.py::test_a_model_whose_residual_is_a_million_records_has_run_away"""


@dataclass(frozen=True)
class OffsetsOfTransducers:
    """The offset of a transducer, and which records tell it."""

    told: float = 1e-6
    """[of the samples] Fewer tell no mean, as where a first position does the same as an offset. Why: rounding.
    Test: test_criteria_of_offsets.py::test_an_offset_is_told_by_the_samples_that_no_first_state_explains"""
    alike: float = 0.01
    """[of the samples] Fewer tell the mean only where the offset is determined. Why: first states do nearly the same.
    Test: test_criteria_of_offsets.py::test_an_offset_is_told_by_the_samples_that_no_first_state_explains"""
    lets_go: float = 1e-4
    """[of the samples] The same of a speed, whose zero is in question and not its place. Why: a spring that lets go of
    less than a thirtieth over the record, which tells a mean of (1/30)²/12, stands for a force that lasts; the size of
    that mean is then chance, and the spring itself is not determined.
    Test: test_criteria_of_offsets.py::test_the_offset_of_a_speed_is_told_by_a_ten_thousandth_of_the_samples"""
    recognised: float = 3.0
    """[standard errors] Beyond which an offset is determined. Why: chance passes that once in 370 records.
    Test: test_criteria_of_offsets.py::test_an_offset_counts_beyond_three_standard_errors"""
    rounds: int = 200
    """[rounds] Of reweighting the means of runs. Why: each leaves a fraction of the last change.
    Test: test_criteria_of_offsets.py::test_the_means_of_runs_are_reweighted_until_nothing_changes"""
    still: float = 1e-13
    """[of the largest mean] By which the last round changes the offset. Why: rounding.
    Test: test_criteria_of_offsets.py::test_the_means_of_runs_are_reweighted_until_nothing_changes"""


@dataclass(frozen=True)
class WindowsOfRecords:
    """The windows over which a machine that integrates is fitted."""

    times: tuple[float, ...] = (1.0, 3.0, 10.0)
    """[times the slowest other time constant] Lengths of windows that are tried. Why: over one the machine answers,
    over ten it has forgotten how it began.
    Test: test_criteria_of_windows.py::test_windows_are_one_three_and_ten_times_the_slowest_time_constant"""
    parts: int = 4
    """[windows] Of a record at least. Why: of fewer the beginnings are a part of the fit.
    Test: test_criteria_of_windows.py::test_a_record_has_four_windows_at_least"""
    longer: float = 1.5
    """[times a horizon] From which on a window is a longer one. Why: one that is not is the same.
    Test: test_criteria_of_windows.py::test_a_longer_window_is_half_as_long_again"""
    least_gain: float = 1e-4
    """[1] Least gain of the filter of a level that wanders. Why: less than one in the samples of a record is none.
    Test: test_criteria_of_windows.py::test_a_level_that_wanders_is_followed_by_25_gains_from_a_ten_thousandth_on"""
    gains: int = 25
    """[gains] From the least to 1 that are tried. Why: the best of six a decade leaves at most 0.5 % more than the
    best of all.
    Test: test_criteria_of_windows.py::test_a_level_that_wanders_is_followed_by_25_gains_from_a_ten_thousandth_on"""
    briefest: float = 0.3
    """[samples] Briefest memory of the filter of a speed. Why: briefer, it follows every sample.
    Test: test_criteria_of_windows.py::test_a_speed_that_wanders_is_followed_by_25_memories_from_a_third_of_a_sample"""
    memories: int = 25
    """[memories] From the briefest to the record that are tried. Why: five a decade lie near any optimum.
    Test: test_criteria_of_windows.py::test_a_speed_that_wanders_is_followed_by_25_memories_from_a_third_of_a_sample"""


@dataclass(frozen=True)
class InverseDynamicsRegression:
    """The regression of a force on a motion."""

    cutoff: float = 20.0
    """[Hz] Cut-off of the low-pass. Why: the motion of a positioning system lies below it.
    Test: test_criteria_of_inverse_dynamics.py::test_force_and_motion_pass_a_low_pass_of_fourth_order_at_20_hz"""
    order: int = 4
    """[order] Of the low-pass, passed forward and back. Why: twice differentiated, noise still falls by 1/f⁶.
    Test: test_criteria_of_inverse_dynamics.py::test_force_and_motion_pass_a_low_pass_of_fourth_order_at_20_hz"""
    samples_of_a_period: int = 4
    """[samples] That remain of a period of the cut-off. Why: twice what it takes.
    Test: test_criteria_of_inverse_dynamics.py::test_four_samples_of_a_period_of_the_cut_off_remain"""
    still: float = 0.02
    """[of the run's largest speed] Below which a sample is left out. Why: dry friction is whatever balances the force.
    Test: test_criteria_of_inverse_dynamics.py::test_a_sample_slower_than_a_fiftieth_of_the_fastest_is_left_out"""
    fewest: int = 20
    """[samples] In motion that a run must have. Why: five for each coefficient.
    Test: test_criteria_of_inverse_dynamics.py::test_a_run_has_twenty_samples_in_motion"""
    perfect: float = 1e-6
    """[of the force] Least residual by which a run is weighed. Why: a perfect run must not have all the weight.
    Test: test_criteria_of_inverse_dynamics.py::test_a_perfect_run_has_not_all_the_weight"""
    separated: float = 1e-6
    """[of the largest column] By which the motion separates two coefficients. Why: differences have as many digits.
    Test: test_criteria_of_inverse_dynamics.py::test_a_motion_that_hardly_separates_two_coefficients_is_refused"""
    slack: float = 1e-6
    """[N/m] Spring of the model that is held at the coefficients. Why: the regression knows none, and zero is none
    either.
    Test: test_criteria_of_inverse_dynamics.py::test_the_model_of_a_regression_has_next_to_no_spring"""
