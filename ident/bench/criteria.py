"""The numbers that decide in the procedures and the fit of a bench, by what they read or find.

Below each number stand [its unit], its meaning (read: value, unit, meaning), the reason for it, and the test in
tests/bench that fails where the number moves by 30 %.
"""

from __future__ import annotations

from dataclasses import dataclass

from ident.bench.criteria_of_procedures import (
    FrequencyProcedure,
    PositionLoopMargins,
    SpeedProcedure,
    StaticProcedure,
    TimeConstants,
)
from ident.bench.criteria_of_records import BenchRecords, Comparison, Movements
from ident.fit.levenberg_marquardt import Way


@dataclass(frozen=True)
class BenchSimulation:
    """Into how many steps a sample is divided."""

    turning: int = 8
    """[parts] Of a sample in which the play turns. Why: the way is off by the square of a part; with four it is off by
    1.6 nm near the supply pressure, not by 0.5.
    Test: test_criteria_of_simulation.py::test_a_sample_is_divided_by_how_the_play_moves_in_it"""
    passing: int = 32
    """[parts] Of a sample in which the current goes far, or reaches all of the supply pressure. Why: the speed is no
    straight line there; with sixteen the way is off by 0.7 nm, not by 0.5.
    Test: test_criteria_of_simulation.py::test_a_sample_is_divided_by_how_the_play_moves_in_it"""
    far: float = 0.25
    """[of the current from the zero shift] Change in half a sample from which on a current goes far. Why: with four
    times as much the way of a sine of 5 Hz is off by 31 nm, not by 9.
    Test: test_criteria_of_simulation.py::test_a_current_goes_far_from_a_quarter_of_itself_on"""
    parts: int = 4
    """[parts] Of a sample with an effect that has no closed form. Why: each halving takes the error to a quarter, and
    twice the time.
    Test: test_criteria_of_simulation.py::test_a_record_with_an_effect_is_simulated_in_four_parts_of_a_sample"""
    longest_step: float = 2.5e-3
    """[s] Longest step where a record is shown and not fitted. Why: a sine of 10 Hz has then forty.
    Test: test_criteria_of_simulation.py::test_a_step_is_no_longer_than_a_tenth_of_the_lag_and_four_hundred_a_second"""
    step_of_lag: float = 0.1
    """[of T] The same. Why: over it the lagged current bends by a thousandth of its change.
    Test: test_criteria_of_simulation.py::test_a_step_is_no_longer_than_a_tenth_of_the_lag_and_four_hundred_a_second"""


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
    """[Way] Effort of the fit before the last one. Why: it only weighs the records for that.
    Test: test_criteria_of_fits.py::test_a_fit_of_a_bench_ends_where_its_effort_ends"""
    last: Way = Way(converged=1e-10, longest=0.7, rough=1e-7)
    """[Way] Effort of the last fit, whose standard errors count. Why: of 10⁵ readings one is 1e-5 of the sum of
    squares; a thousandth of it, 1e-6 of that again, is what any other search for this optimum may differ by.
    Test: test_criteria_of_fits.py::test_a_fit_of_a_bench_ends_where_its_effort_ends"""
    whole: int = 8
    """[steps] Of a fit of all values, and of one with a delay. Why: it begins at what the procedures found.
    Test: test_criteria_of_fits.py::test_a_fit_of_a_bench_ends_after_its_steps"""
    polish: int = 60
    """[steps] From a member of a search, and from where an earlier fit ended. Why: from afar it takes more than 50.
    Test: test_criteria_of_fits.py::test_what_a_search_found_is_refined_in_sixty_steps"""
    folds: float = 1e-4
    """[relative difference of sums of squares] That folds make. Why: a part of a standard error.
    Test: test_criteria_of_fits.py::test_ends_in_folds_of_one_optimum_are_one"""
    farther: float = 1.01
    """[ratio of errors] To where the procedures lead, from which on a search went astray. Why: so far from the records
    is another optimum.
    Test: test_criteria_of_fits.py::test_a_search_that_ends_a_hundredth_farther_went_astray"""
    natural: float = 0.05
    """[of its range] Natural size of a value that may be zero, where the machine has no size of its own for it. Why:
    one step is up to 0.7 of it; with twice as much a member of a search passed over the optimum (error 85 times as
    large).
    Test: test_criteria_of_fits.py::test_a_value_that_may_be_zero_is_measured_by_a_twentieth_of_its_range"""
    farthest: float = 5.0
    """[logarithm] From its first value to which any other may go. Why: 150 times, more than any range has.
    Test: test_criteria_of_fits.py::test_a_value_goes_no_farther_than_150_times"""
    places: int = 16
    """[places] Within a step of the converter from which each way begins. Why: the scatter of a value that hangs on one
    record is then known to 18 %.
    Test: test_criteria_of_fits.py::test_a_way_begins_at_sixteen_places_within_a_step"""


@dataclass(frozen=True)
class BenchSearch:
    """The search for all values at once."""

    rate: float = 60.0
    """[Hz] Least of a record during the search. Why: it only has to find the basin; the refinement takes what each
    record needs.
    Test: test_criteria_of_fits.py::test_a_search_takes_sixty_hertz_and_forty_samples_of_a_period"""
    samples_of_a_period: float = 40.0
    """[samples] Of a period of a sine. Why: half of what the refinement takes.
    Test: test_criteria_of_fits.py::test_a_search_takes_sixty_hertz_and_forty_samples_of_a_period"""
    starts: int = 3
    """[vectors] Of the last generation that are refined, in addition to what the procedures found. Why: each costs a
    refinement.
    Test: test_criteria_of_fits.py::test_three_vectors_of_a_search_are_refined"""


@dataclass(frozen=True)
class Criteria:
    """The numbers that decide on a bench, by procedure."""

    records: BenchRecords = BenchRecords()
    movements: Movements = Movements()
    comparison: Comparison = Comparison()
    simulation: BenchSimulation = BenchSimulation()
    fits: BenchFits = BenchFits()
    search: BenchSearch = BenchSearch()
    static: StaticProcedure = StaticProcedure()
    frequency: FrequencyProcedure = FrequencyProcedure()
    speed: SpeedProcedure = SpeedProcedure()
    time_constants: TimeConstants = TimeConstants()
    position_loop: PositionLoopMargins = PositionLoopMargins()


BENCH_CRITERIA = Criteria()
