"""The numbers that decide in the procedures and the fit of a bench, by what they read or find.

Below each number stand [its unit], its meaning (read: value, unit, meaning), the reason for it, and the test in
tests/bench that fails where the number moves by 30 %.
"""

from __future__ import annotations

from dataclasses import dataclass

from ident.fit.levenberg_marquardt import Way


@dataclass(frozen=True)
class BenchRecords:
    """What of a record is read, and in which steps its position is."""

    at_end: float = 0.02
    """[s] At the extreme reading, from which on the actuator or its transducer is at its end. Why: a turn is shorter.
    Test: test_criteria.py::test_an_actuator_is_at_its_end_where_it_stays_there_under_a_current"""
    end_margin: float = 0.6
    """[steps] From the extreme reading that still are at it. Why: a reading flickers by one step, half of it to either
    side.
    Test: test_criteria.py::test_an_actuator_is_at_its_end_where_it_stays_there_under_a_current"""
    far_current: float = 0.02
    """[rated currents] From the middle of the current, farther than which an actuator that is free moves. Why: a zero
    shift and half of a dead space.
    Test: test_criteria.py::test_an_actuator_is_at_its_end_where_it_stays_there_under_a_current"""
    shortest: int = 8
    """[samples] Least of a part of a record, and of a time at an end. Why: it has a mean and a slope of its own.
    Test: test_criteria.py::test_a_part_of_a_record_has_eight_samples"""
    fewest_means: int = 16
    """[means] Fewest of blocks of samples by which a record is reduced. Why: twice the least of a part.
    Test: test_criteria.py::test_a_record_is_reduced_to_sixteen_means_at_least"""
    brief: float = 4e-3
    """[s] Over which a current is looked at for jumps. Why: means over it hide what the play sees.
    Test: test_criteria.py::test_a_current_jumps_about_where_it_scatters_within_four_milliseconds"""
    rough: float = 5e-5
    """[rated currents] Deviation within that time from which on a current jumps about. Why: a saw-tooth of the slowest
    rate goes a tenth of it.
    Test: test_criteria.py::test_a_current_jumps_about_where_it_scatters_within_four_milliseconds"""
    off_grid: float = 0.1
    """[steps] From a whole number of them, up to which a reading is one of the same converter. Why: a text rounds by
    less.
    Test: test_criteria.py::test_readings_are_of_one_converter_within_a_tenth_of_a_step"""
    first_reach: float = 30.0
    """[steps] Over which their number is told by the smallest change. Why: rounded to two digits it is off by a
    sixtieth.
    Test: test_criteria.py::test_the_step_of_a_converter_is_refined_over_thirty_steps_and_ten_times_as_far_each_time"""
    further_reach: float = 10.0
    """[times] As far each time that the step is refined. Why: least squares have made it ten times as exact.
    Test: test_criteria.py::test_the_step_of_a_converter_is_refined_over_thirty_steps_and_ten_times_as_far_each_time"""
    changed: float = 1e-6
    """[steps] Below which a change is the rounding of a reading. Why: a text has six digits of a step and more.
    Test: test_criteria.py::test_a_reading_changes_by_more_than_a_millionth_of_a_step"""


@dataclass(frozen=True)
class Movements:
    """Where an output link moves, and where it rests."""

    flicker: float = 0.75
    """[steps] Half-width of the play that frees a position of its flicker. Why: more than half a step, less than one.
    Test: test_criteria.py::test_a_reading_that_flickers_by_a_step_does_not_move"""
    noise: float = 3.0
    """[deviations] Of the changes of a position that is not in steps, which stand for a step. Why: one change in 370 is
    larger by chance.
    Test: test_criteria.py::test_a_position_without_steps_moves_beyond_its_noise"""
    pause: float = 4.0
    """[times] The usual time between two steps, from which on a pause is a rest. Why: a movement is as fast again.
    Test: test_criteria.py::test_a_pause_of_four_times_the_usual_is_a_rest"""
    usual: float = 0.02
    """[s] Least that counts as the usual time. Why: a link that hunts between two steps rests in between.
    Test: test_criteria.py::test_the_usual_time_between_two_steps_is_a_fiftieth_of_a_second_at_least"""
    fewest: int = 3
    """[changes] Fewest of a record in which a link moves. Why: two have one distance, which is usual by itself.
    Test: test_criteria.py::test_a_link_moves_where_its_reading_changes_three_times"""


@dataclass(frozen=True)
class Comparison:
    """How a record is compared with a model."""

    static_rate: float = 250.0
    """[Hz] At which a static record is compared. Why: the loop of the pressure is crossed in tenths of a second.
    Test: test_criteria.py::test_a_record_is_compared_at_the_rate_that_its_kind_needs"""
    rough_rate: float = 1000.0
    """[Hz] The same of one whose current jumps about. Why: means hide what the play sees.
    Test: test_criteria.py::test_a_record_is_compared_at_the_rate_that_its_kind_needs"""
    least_rate: float = 125.0
    """[Hz] Least of any other record. Why: the lag is exact at any rate; eight milliseconds follow a level.
    Test: test_criteria.py::test_a_record_is_compared_at_the_rate_that_its_kind_needs"""
    samples_of_a_period: float = 80.0
    """[samples] Of a period of a sine. Why: where the play turns is then told to a hundredth of it.
    Test: test_criteria.py::test_a_record_is_compared_at_the_rate_that_its_kind_needs"""
    imperfect: float = 2e-3
    """[of the position's deviation] By which a model is off at best. Why: small signals are not drowned by the
    imperfections of the table at large ones.
    Test: test_criteria.py::test_a_position_counts_by_its_converter_and_two_thousandths_of_its_size"""
    finest: float = 1e-7
    """[m] Least deviation of a position. Why: no transducer of a bench is better.
    Test: test_criteria.py::test_a_position_counts_by_its_converter_and_two_thousandths_of_its_size"""
    settled: float = 0.25
    """[s] At the start of a record that its unknown past may have shaped. Why: ten lags of a slow actuator.
    Test: test_criteria.py::test_a_record_is_compared_from_where_its_past_is_over"""
    moved: float = 3.0
    """[steps] By which a link that moves is no accident. Why: two are a flicker and its noise.
    Test: test_criteria.py::test_a_record_is_compared_from_where_its_past_is_over"""
    moved_share: float = 1e-4
    """[of its way] The same of a position that is not in steps. Why: noise of a transducer.
    Test: test_criteria.py::test_a_record_is_compared_from_where_its_past_is_over"""
    periods: float = 2.2
    """[periods] Of a sine from which on its first is left out. Why: a whole one is left, though the last is cut.
    Test: test_criteria.py::test_a_record_is_compared_from_where_its_past_is_over"""
    parts: int = 3
    """[parts] Of a record, of which its past takes one at most. Why: of a record without a motion the rest tells.
    Test: test_criteria.py::test_a_record_is_compared_from_where_its_past_is_over"""
    least_reading: float = 0.1
    """[of a converter's deviation] Below which no weight counts on a reading. Why: a link that nearly stands when its
    reading changes would tell more than the rest of a record together, of a way that the model has to know to a
    thousandth of a step; 0.7 µm at 12 bits over 100 mm.
    Test: test_criteria.py::test_a_reading_counts_as_a_tenth_of_its_step_at_best"""
    around: int = 3
    """[samples] To either side within which the fastest counts. Why: a link that stops or starts is not timed by one.
    Test: test_criteria.py::test_a_reading_is_timed_by_the_fastest_of_seven_samples"""


@dataclass(frozen=True)
class BenchFits:
    """How far the values of a bench are refined."""

    steps: int = 12
    """[steps] Of a fit at most, where nothing else is said. Why: procedures begin near their optimum.
    Test: test_criteria_of_fits.py::test_a_fit_of_a_bench_ends_after_its_steps"""
    rough: Way = Way(converged=1e-5, longest=0.7, rough=1e-4)
    """[Way] Effort of any fit but the last two. Why: where the play turns, the sum of squares is not smooth; a value
    goes no farther than twofold in one step.
    Test: test_criteria_of_fits.py::test_a_fit_of_a_bench_ends_where_its_effort_ends"""
    but_one: Way = Way(converged=1e-6, longest=0.7, rough=1e-6)
    """[Way] Effort of the fit before the last one. Why: it only says how the records are weighed in that.
    Test: test_criteria_of_fits.py::test_a_fit_of_a_bench_ends_where_its_effort_ends"""
    last: Way = Way(converged=1e-10, longest=0.7, rough=1e-7)
    """[Way] Effort of the last fit, whose standard errors count. Why: of 10⁵ readings one is 1e-5 of the sum of
    squares; a thousandth of it, 1e-6 of that again, is what any other search for this optimum may differ by.
    Test: test_criteria_of_fits.py::test_a_fit_of_a_bench_ends_where_its_effort_ends"""
    whole: int = 8
    """[steps] Of a fit of all values, and of one with a delay. Why: it begins at what the procedures found.
    Test: test_criteria_of_fits.py::test_a_fit_of_a_bench_ends_after_its_steps"""
    polish: int = 60
    """[steps] From a member of a search. Why: from afar it takes more than 50.
    Test: test_criteria_of_fits.py::test_what_a_search_found_is_refined_in_sixty_steps"""
    folds: float = 1e-4
    """[relative difference of sums of squares] That folds make. Why: a part of a standard error.
    Test: test_criteria_of_fits.py::test_ends_in_folds_of_one_optimum_are_one"""
    farther: float = 1.01
    """[ratio of errors] To where the procedures lead, from which on a search went astray. Why: so far from the records
    is another optimum.
    Test: test_criteria_of_fits.py::test_a_search_that_ends_a_hundredth_farther_went_astray"""


@dataclass(frozen=True)
class SpeedProcedure:
    """The speed characteristic from fixed levels and from a stroke."""

    even: float = 2e-3
    """[rated currents] Within which a level is one. Why: half of a last bit of a source of eight.
    Test: test_criteria_of_procedures.py::test_a_level_is_one_within_two_thousandths_of_the_rated_current"""
    shortest: float = 0.1
    """[s] Least of a level, once it has settled. Why: a line through fewer readings is as uncertain as one step.
    Test: test_criteria_of_procedures.py::test_a_level_lasts_a_tenth_of_a_second_after_six_lags"""
    lags: float = 6.0
    """[lags] In which a level settles. Why: 0.25 % of the step is left.
    Test: test_criteria_of_procedures.py::test_a_level_lasts_a_tenth_of_a_second_after_six_lags"""
    sure: float = 0.7
    """[of the speed] Left by friction from which on a level is a point of the characteristic. Why: the factor is known
    less the smaller it is.
    Test: test_criteria_of_procedures.py::test_a_level_is_a_point_where_friction_leaves_seven_tenths_of_the_speed"""
    floor: float = 0.2
    """[of the speed] Least that is left by friction on a curve. Why: a smaller factor is too uncertain to divide by.
    Test: test_criteria_of_procedures.py::test_a_speed_is_divided_by_a_fifth_at_least"""
    cutoff: float = 15.0
    """[Hz] Of the filters of a speed. Why: a stroke of seconds has less.
    Test: test_criteria_of_procedures.py::test_a_speed_is_smoothed_at_fifteen_hertz"""
    degree: int = 7
    """[degree] Of the Bézier curve through the levels. Why: as the paper's.
    Test: test_criteria_of_procedures.py::test_the_curve_through_the_levels_is_of_the_seventh_degree"""
    steps: int = 3
    """[steps] Of the fit of the table. Why: it begins at the levels.
    Test: test_criteria_of_procedures.py::test_a_table_is_fitted_in_three_steps"""
    places: int = 40
    """[places] To which the speeds of a stroke are thinned. Why: twice the nodes of a table and more.
    Test: test_criteria_of_procedures.py::test_a_stroke_is_thinned_to_forty_places"""
    fewest: int = 4
    """[samples] Fewest of such a place. Why: the median of fewer is one of them.
    Test: test_criteria_of_procedures.py::test_a_place_of_a_stroke_has_four_samples"""


@dataclass(frozen=True)
class TimeConstants:
    """The time constant T and a pure delay."""

    first: float = 0.02
    """[s] Where the search for T begins. Why: between a fast valve and a large one.
    Test: test_criteria_of_procedures.py::test_the_search_for_the_time_constant_begins_at_twenty_milliseconds"""
    near: int = 5
    """[steps] Of the fit of T, B and a delay to the sines alone. Why: it only says whether there is a delay.
    Test: test_criteria_of_procedures.py::test_a_delay_is_looked_for_in_the_sines_in_five_steps"""
    change: float = 1e-4
    """[logarithm] Of T, below which SciPy's search ends. Why: a hundredth of its standard error.
    Test: test_criteria_of_procedures.py::test_the_search_of_the_library_ends_within_a_ten_thousandth"""
    gain: float = 1e-6
    """[of the sum of squares] Below which SciPy's search ends. Why: as for T.
    Test: test_criteria_of_procedures.py::test_the_search_of_the_library_ends_within_a_ten_thousandth"""
    evaluations: int = 30
    """[evaluations] Of SciPy's search at most. Why: one value takes ten.
    Test: test_criteria_of_procedures.py::test_the_search_of_the_library_ends_within_a_ten_thousandth"""
    smallest: float = 1e-4
    """[s] Least T that is searched. Why: a tenth of a sample at 1 kHz.
    Test: test_criteria_of_procedures.py::test_a_time_constant_lies_between_a_ten_thousandth_and_one_second"""
    steps: int = 25
    """[steps] Of the gradient descent at most. Why: from three times T it takes less than twenty.
    Test: test_criteria_of_procedures.py::test_the_descent_begins_with_a_third_and_ends_below_a_thousandth"""
    first_step: float = 0.3
    """[logarithm] First step of the descent. Why: a third of T.
    Test: test_criteria_of_procedures.py::test_the_descent_begins_with_a_third_and_ends_below_a_thousandth"""
    longer: float = 1.2
    """[times] As long is a step after one that helped. Why: it is long enough after a few.
    Test: test_criteria_of_procedures.py::test_the_descent_begins_with_a_third_and_ends_below_a_thousandth"""
    shorter: float = 0.35
    """[times] As long is a step after one that failed. Why: three of them are a twentieth.
    Test: test_criteria_of_procedures.py::test_the_descent_begins_with_a_third_and_ends_below_a_thousandth"""
    last_step: float = 1e-3
    """[logarithm] Below which the descent ends, and over which a slope is taken. Why: a thousandth of T.
    Test: test_criteria_of_procedures.py::test_the_descent_begins_with_a_third_and_ends_below_a_thousandth"""
    told: float = 4.0
    """[standard deviations] From which on a delay is said to be there. Why: one in 16 000 by chance, and it doubts the
    model.
    Test: test_criteria_of_procedures.py::test_a_delay_is_said_from_four_deviations_and_a_fiftieth_of_the_lag_on"""
    seen: float = 0.02
    """[of T] From which on it is said. Why: less does not matter.
    Test: test_criteria_of_procedures.py::test_a_delay_is_said_from_four_deviations_and_a_fiftieth_of_the_lag_on"""


@dataclass(frozen=True)
class StaticProcedure:
    """Where the fit of a static record begins."""

    rate: float = 50.0
    """[Hz] Of the records for the choice among starts. Why: a saw-tooth lasts seconds.
    Test: test_criteria_of_procedures.py::test_starts_of_a_static_fit_are_chosen_at_fifty_hertz"""
    rough_rate: float = 250.0
    """[Hz] The same where the current jumps about. Why: means hide what the play sees.
    Test: test_criteria_of_procedures.py::test_starts_of_a_static_fit_are_chosen_at_fifty_hertz"""
    narrower: tuple[float, ...] = (1.0, 0.5, 0.25)
    """[times] The width at which movements began that the dead space may be, where the current jumps about. Why: such a
    current goes far beyond it.
    Test: test_criteria_of_procedures.py::test_a_static_fit_begins_with_shares_of_the_dead_space"""
    shares: tuple[float, ...] = (0.3, 0.6, 0.85)
    """[of the dead space] That hysteresis may be. Why: a little, most, and nearly all of it.
    Test: test_criteria_of_procedures.py::test_a_static_fit_begins_with_shares_of_the_dead_space"""
    steps: int = 4
    """[steps] Of each of these fits, and of that of the procedure. Why: it begins near its optimum.
    Test: test_criteria_of_procedures.py::test_a_static_fit_has_four_steps"""
    least_width: float = 1e-5
    """[rated currents] Least dead space to begin with. Why: a logarithm of it is searched.
    Test: test_criteria_of_procedures.py::test_a_dead_space_to_begin_with_is_not_zero"""


@dataclass(frozen=True)
class Criteria:
    """The numbers that decide on a bench, by procedure."""

    records: BenchRecords = BenchRecords()
    movements: Movements = Movements()
    comparison: Comparison = Comparison()
    fits: BenchFits = BenchFits()
    static: StaticProcedure = StaticProcedure()
    speed: SpeedProcedure = SpeedProcedure()
    time_constants: TimeConstants = TimeConstants()


BENCH_CRITERIA = Criteria()
