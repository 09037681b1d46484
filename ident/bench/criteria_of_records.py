"""The numbers by which records of a bench are read, and compared with a model."""

from __future__ import annotations

from dataclasses import dataclass


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
    """[s] Over which a current is looked at for jumps. Why: means over it hide how the play moves.
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
    """[steps] Over which their number follows from the smallest change. Why: rounded to two digits it is off by a
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
    """[Hz] The same of one whose current jumps about. Why: means hide how the play moves.
    Test: test_criteria.py::test_a_record_is_compared_at_the_rate_that_its_kind_needs"""
    fine_rate: float = 500.0
    """[Hz] At which all records are compared where an effect is sought. Why: a mean over more samples looks like a lag,
    and effects differ from one another by parts of a millisecond.
    Test: test_criteria.py::test_an_effect_is_sought_in_records_of_500_hertz"""
    least_rate: float = 125.0
    """[Hz] Least of any other record. Why: the lag is exact at any rate; eight milliseconds follow a level.
    Test: test_criteria.py::test_a_record_is_compared_at_the_rate_that_its_kind_needs"""
    samples_of_a_period: float = 80.0
    """[samples] Of a period of a sine. Why: the instant at which the play turns is then known to a hundredth of it.
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
    """[periods] Of a sine from which on its first is left out. Why: a whole one remains, though the last is cut.
    Test: test_criteria.py::test_a_record_is_compared_from_where_its_past_is_over"""
    parts: int = 3
    """[parts] Of a record, of which its past takes one at most. Why: a record without a motion is compared, too.
    Test: test_criteria.py::test_a_record_is_compared_from_where_its_past_is_over"""
    least_reading: float = 0.1
    """[of a converter's deviation] Below which no weight counts on a reading. Why: a link that nearly stands when its
    reading changes would weigh more than the rest of a record together, of a way that the model has to know to a
    thousandth of a step; 0.7 µm at 12 bits over 100 mm.
    Test: test_criteria.py::test_a_reading_counts_as_a_tenth_of_its_step_at_best"""
    around: int = 3
    """[samples] To either side within which the fastest counts. Why: a link that stops or starts is not timed by one.
    Test: test_criteria.py::test_a_reading_is_timed_by_the_fastest_of_seven_samples"""
