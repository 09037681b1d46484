"""The numbers by which the procedures of a bench find their quantities, and its position loop is judged."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class StaticProcedure:
    """Where the fit of a static record begins."""

    rate: float = 50.0
    """[Hz] Of the records for the choice among starts. Why: a saw-tooth lasts seconds.
    Test: test_criteria_of_procedures.py::test_starts_of_a_static_fit_are_chosen_at_fifty_hertz"""
    rough_rate: float = 250.0
    """[Hz] The same where the current jumps about. Why: means hide how the play moves.
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
class FrequencyProcedure:
    """A sine fitted to each period of a record."""

    samples_of_a_period: float = 200.0
    """[samples] To which a period is reduced. Why: a mean over one of them lacks 4e-5 of a sine.
    Test: test_criteria_of_procedures.py::test_a_period_of_a_sine_is_reduced_to_two_hundred_samples"""
    lacking: float = 0.01
    """[periods] By which the last of a record may be too short. Why: two of its samples, and a frequency that was found
    and not stated.
    Test: test_criteria_of_procedures.py::test_a_period_counts_that_lacks_a_hundredth"""


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
    """[lags] In which a level settles. Why: it is then within 0.25 % of the step.
    Test: test_criteria_of_procedures.py::test_a_level_lasts_a_tenth_of_a_second_after_six_lags"""
    sure: float = 0.7
    """[of the speed] Least factor of friction at which a level is a point of the characteristic. Why: the factor is
    known less the smaller it is.
    Test: test_criteria_of_procedures.py::test_a_level_is_a_point_where_friction_leaves_seven_tenths_of_the_speed"""
    floor: float = 0.2
    """[of the speed] Least factor of friction by which a curve is divided. Why: a smaller factor is too uncertain.
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
    currents: int = 201
    """[currents] Over the range at which gains, nonlinearity and asymmetry are read off a table. Why: a sheet
    reads each per cent of the rated current; over all currents the nonlinearity is larger by 1 % of itself.
    Test: test_criteria_of_procedures.py::test_a_table_is_read_at_two_hundred_and_one_currents"""


@dataclass(frozen=True)
class TimeConstants:
    """The time constant T and a pure delay."""

    first: float = 0.02
    """[s] Where the search for T begins. Why: between a fast valve and a large one.
    Test: test_criteria_of_procedures.py::test_the_search_for_the_time_constant_begins_at_twenty_milliseconds"""
    near: int = 5
    """[steps] Of the fit of T, B and a delay to the sines alone. Why: it only shows whether there is a delay.
    Test: test_criteria_of_procedures.py::test_a_delay_is_looked_for_in_the_sines_in_five_steps"""
    change: float = 1e-4
    """[logarithm] Of T, below which SciPy's search ends. Why: a hundredth of its standard error.
    Test: test_criteria_of_procedures.py::test_the_search_of_the_library_ends_within_a_ten_thousandth"""
    gain: float = 1e-6
    """[of the sum of squares] Below which SciPy's search ends. Why: as for T.
    Test: test_criteria_of_procedures.py::test_the_search_of_the_library_ends_within_a_ten_thousandth"""
    evaluations: int = 30
    """[evaluations] Of SciPy's search at most. Why: one value takes seven.
    Test: test_criteria_of_procedures.py::test_the_search_of_the_library_ends_within_a_ten_thousandth"""
    smallest: float = 1e-4
    """[s] Least T that is searched. Why: a tenth of a sample at 1 kHz.
    Test: test_criteria_of_procedures.py::test_a_time_constant_lies_between_a_ten_thousandth_and_one_second"""
    steps: int = 25
    """[steps] Of the gradient descent at most. Why: from three times T and from a third it takes 13.
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
    delay_deviations: float = 4.0
    """[standard deviations] From which on a delay is significant. Why: one in 16 000 by chance, and it doubts the
    model.
    Test: test_criteria_of_procedures.py::test_a_delay_is_said_from_four_deviations_and_a_fiftieth_of_the_lag_on"""
    delay_of_lag: float = 0.02
    """[of T] Least delay that is reported. Why: a shorter one does not matter.
    Test: test_criteria_of_procedures.py::test_a_delay_is_said_from_four_deviations_and_a_fiftieth_of_the_lag_on"""


@dataclass(frozen=True)
class PositionLoopMargins:
    """At which amplitudes and frequencies the loop around an actuator is judged."""

    multiples: tuple[float, ...] = (1.5, 3.0, 10.0)
    """[of the dead space] Amplitudes at the play where none are stated. Why: within twice the dead space most of an
    amplitude is lost in it, and beyond ten times next to nothing.
    Test: test_criteria_of_procedures.py::test_a_loop_is_judged_from_a_half_beyond_the_dead_space_to_ten_times"""
    lowest: float = 0.01
    """[Hz] Frequency from which on the loop is looked at. Why: a loop that crosses below takes minutes to settle.
    Test: test_criteria_of_procedures.py::test_a_loop_is_looked_at_from_a_hundredth_of_a_hertz_on"""
    highest: float = 100.0
    """[of 1/(2πT)] Frequency up to which a loop is looked at that is not sampled. Why: the lag has turned by 89° there.
    Test: test_criteria_of_procedures.py::test_an_analogue_loop_is_looked_at_up_to_a_hundred_times_its_lag"""
