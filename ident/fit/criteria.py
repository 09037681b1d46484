"""Every number that decides in a fit, by the step that it decides in.

Below each number stand [its unit], its meaning (read: value, unit, meaning), the reason for it, and the test in
tests/fit that fails where the number moves by 30 %.
"""

from __future__ import annotations

from dataclasses import dataclass

from ident.fit.criteria_of_records import (
    Band,
    FirstStates,
    InverseDynamicsRegression,
    OffsetsOfTransducers,
    ReducedRecords,
    WindowsOfRecords,
)


@dataclass(frozen=True)
class GeneticSearch:
    """The program's own search, and what of it is refined. The paper's has the numbers of the paper."""

    population: float = 200.0
    """[vectors] Of a generation. Why: of fifteen parameters each has then a dozen values in every third of its range;
    chosen by what it costs, and no measurement of it is kept.
    Test: test_criteria_of_search.py::test_a_search_has_so_many_vectors_and_generations"""
    generations: float = 30.0
    """[generations] Of a search. Why: mutations are then a fiftieth of their first width, and the refinement goes on.
    Test: test_criteria_of_search.py::test_a_search_has_so_many_vectors_and_generations"""
    elite: float = 10.0
    """[vectors] Of a generation that stay. Why: a twentieth keeps several basins.
    Test: test_criteria_of_search.py::test_the_best_vectors_of_a_generation_stay"""
    population_nearby: float = 64.0
    """[vectors] Of a generation about a model that is fitted already, without its effects or in another place. Why:
    only what is new is searched over its whole range, and each vector is a simulation.
    Test: test_criteria_of_search.py::test_a_search_has_so_many_vectors_and_generations"""
    generations_nearby: float = 12.0
    """[generations] Of such a search. Why: as for its vectors.
    Test: test_criteria_of_search.py::test_a_search_has_so_many_vectors_and_generations"""
    elite_nearby: float = 6.0
    """[vectors] Of a generation of such a search that stay. Why: a tenth of fewer vectors.
    Test: test_criteria_of_search.py::test_the_best_vectors_of_a_generation_stay"""
    mutation: float = 0.3
    """[of the elements] That are mutated. Why: of a vector of three or more parameters most are then changed in one.
    Test: test_criteria_of_search.py::test_three_elements_of_ten_are_mutated_by_a_fifth_of_an_axis_at_first"""
    blend: float = 0.3
    """[of the distance of two parents] By which a child may lie beyond either of them. Why: without it a population
    contracts, whatever the errors are.
    Test: test_criteria_of_search.py::test_a_child_lies_up_to_a_third_beyond_its_parents"""
    mutation_width: float = 0.2
    """[of an axis] Standard deviation of the first mutations. Why: a fifth reaches the next basin.
    Test: test_criteria_of_search.py::test_three_elements_of_ten_are_mutated_by_a_fifth_of_an_axis_at_first"""
    narrowing: float = 0.02
    """[of the first width] Width of the last mutations. Why: the refinement takes a hundredth of an axis in a step.
    Test: test_criteria_of_search.py::test_the_last_mutations_have_a_fiftieth_of_the_width_of_the_first"""
    strengths: tuple[float, ...] = (0.03, 0.15, 0.5)
    """[of an axis] At which each effect is tried alone. Why: a weak, a middling and a strong one.
    Test: test_criteria_of_search.py::test_a_search_with_effects_begins_near_the_model_without_them"""
    nearby: float = 0.1
    """[of an axis] Over which the other parameters are drawn then. Why: an effect moves them by some per cent.
    Test: test_criteria_of_search.py::test_a_search_with_effects_begins_near_the_model_without_them"""
    samples: int = 65_536
    """[samples] Of all runs in a search of simulations; the refinement takes every sample. Why: a search only has to
    find the basin.
    Test: test_criteria_of_search.py::test_a_search_takes_the_beginnings_of_long_records_of_noise"""
    enough_samples: int = 8_192
    """[samples] Of all runs, to which finely sampled records are decimated for a search or a trial. Why: at so many
    samples a period they are 250 periods of the highest frequency that the commands excite.
    Test: test_criteria_of_search.py::test_finely_sampled_records_are_decimated_for_a_search"""
    samples_of_a_period: float = 32.0
    """[samples] That then remain of a period of that frequency. Why: the line between two samples takes 0.3 % off a
    sine at the edge of the band, and a step has a hundredth of its power beyond the band.
    Test: test_criteria_of_search.py::test_finely_sampled_records_are_decimated_for_a_search"""
    shortest_part: int = 512
    """[samples] Least of a run in such a search. Why: fewer are over before the machine has answered.
    Test: test_criteria_of_search.py::test_a_search_takes_the_beginnings_of_long_records_of_noise"""
    stationary_parts: int = 8
    """[parts] Of a record, which are compared. Why: as many periods or steps as show a machine are in an eighth.
    Test: test_trial_runs.py::test_a_record_is_cut_where_its_parts_are_alike"""
    stationary_ratio: float = 1.5
    """[ratio] Of the largest part to the smallest, by the size and by the crossings of the mean, up to which a record
    goes on as it begins. Why: of random steps with a hundred changes a part, one of twenty is beyond it by chance.
    Test: test_trial_runs.py::test_a_record_is_cut_where_its_parts_are_alike"""
    candidates: int = 5
    """[vectors] Of the last generation that are refined. Why: each costs a refinement, and more seldom end elsewhere.
    Test: test_criteria_of_search.py::test_five_distinct_vectors_of_a_search_are_refined"""
    apart: float = 0.1
    """[of an axis] From which on two vectors are distinct. Why: nearer ones end at the same optimum.
    Test: test_criteria_of_search.py::test_vectors_a_tenth_of_an_axis_apart_are_distinct"""
    further: int = 16
    """[vectors] Of the first generation that are refined, too, where those do not settle it. Why: three of sixteen
    agree with the best where a third of the space leads there.
    Test: test_criteria_of_search.py::test_sixteen_further_vectors_are_refined_where_the_first_do_not_settle_it"""
    judged: int = 8
    """[runs] Of a matrix that are examined for a controller. Why: one rig records them all alike.
    Test: test_criteria_of_search.py::test_eight_runs_of_many_are_examined_for_a_controller"""


@dataclass(frozen=True)
class SearchOptions:
    """The least and the most of each option of a search that a user may choose."""

    population: tuple[float, float] = (10.0, 100_000.0)
    """[vectors] Of a generation. Why: fewer have no parents to choose from, more need the memory of a machine.
    Test: test_criteria_of_search.py::test_an_option_is_chosen_within_its_limits"""
    keep: tuple[float, float] = (0.05, 0.99)
    """[of the vectors] That survive a generation of the paper's search. Why: with less it is over at once, with more
    it lasts for hundreds of generations.
    Test: test_criteria_of_search.py::test_an_option_is_chosen_within_its_limits"""
    survivors: tuple[float, float] = (1.0, 1000.0)
    """[vectors] With which the paper's search ends. Why: their mean is its result.
    Test: test_criteria_of_search.py::test_an_option_is_chosen_within_its_limits"""
    generations: tuple[float, float] = (1.0, 10_000.0)
    """[generations] Of a search. Why: each is kept to be drawn.
    Test: test_criteria_of_search.py::test_an_option_is_chosen_within_its_limits"""
    elite: tuple[float, float] = (1.0, 10_000.0)
    """[vectors] Of a generation that stay. Why: none would lose the best, and more than a tenth of the largest
    population is a search no more.
    Test: test_criteria_of_search.py::test_an_option_is_chosen_within_its_limits"""
    starts: tuple[float, float] = (0.0, 1000.0)
    """[vectors] Of the first generation that are refined. Why: each costs a refinement.
    Test: test_criteria_of_search.py::test_an_option_is_chosen_within_its_limits"""


@dataclass(frozen=True)
class CrossCheckSearches:
    """The searches of other libraries, as cross-checks."""

    generations: int = 150
    """[generations] Most of either search. Why: five times those of the program's own.
    Test: test_criteria_of_search.py::test_the_searches_of_other_libraries_end_after_150_generations"""
    differential_evolution: int = 120
    """[vectors] Of a generation of differential evolution. Why: ten of each of a dozen parameters (Storn, Price 1997).
    Test: test_criteria_of_search.py::test_the_searches_of_other_libraries_have_so_many_vectors"""
    tolerance: float = 1e-4
    """[of the mean error] Deviation of the errors of a generation at which differential evolution ends. Why: the
    refinement takes over.
    Test: test_criteria_of_search.py::test_differential_evolution_ends_where_the_errors_of_a_generation_are_one"""
    cma_es: int = 40
    """[vectors] Of a generation of CMA-ES. Why: four times its default for a dozen parameters, for local optima.
    Test: test_criteria_of_search.py::test_the_searches_of_other_libraries_have_so_many_vectors"""
    deviation: float = 0.25
    """[of an axis] Standard deviation of its first generation. Why: the range is then two deviations to either
    side.
    Test: test_criteria_of_search.py::test_the_first_generation_of_cma_es_has_a_deviation_of_a_quarter"""
    change: float = 1e-7
    """[error] Change over its last generations at which CMA-ES ends. Why: the refinement takes over.
    Test: test_criteria_of_search.py::test_cma_es_ends_where_the_errors_change_by_a_ten_millionth"""


@dataclass(frozen=True)
class Refinement:
    """Levenberg and Marquardt's way from a start to the optimum."""

    steps: int = 200
    """[steps] At most. Why: along a curved valley it takes more than 60.
    Test: test_criteria_of_refinement.py::test_a_refinement_ends_after_200_steps"""
    converged: float = 1e-10
    """[relative decrease of the error] Promised by a step below which none is worth it. Why: the standard error of a
    parameter is 1e-5 of the error and more.
    Test: test_criteria_of_refinement.py::test_a_refinement_ends_where_a_step_promises_next_to_nothing"""
    damping: float = 1e-4
    """[of the diagonal of H] Of the first step. Why: Gauss and Newton's step, but where H is singular.
    Test: test_criteria_of_refinement.py::test_the_first_step_is_damped_by_a_ten_thousandth"""
    most_damping: float = 1e6
    """[of the diagonal of H] From which on a step that fails is the last. Why: it is a millionth of Gauss and Newton's.
    Test: test_criteria_of_refinement.py::test_a_step_that_fails_is_the_last_from_a_damping_of_a_million_on"""
    fall: float = 0.1
    """[of the damping] Least that remains after a step that kept its promise. Why: tenfold at a time, a valley that
    curves is not left.
    Test: test_criteria_of_refinement.py::test_the_damping_falls_tenfold_at_most"""
    hope: float = 4.0
    """[steps like the last] That an aim may be away. Why: a few more steps may take as much.
    Test: test_criteria_of_refinement.py::test_who_is_four_steps_from_an_aim_gives_up"""
    kept: float = 0.1
    """[of what a step promised] By which it may miss it for the promise of the next one to be believed. Why: the model
    is straight there, unless the step was short because it was damped.
    Test: test_criteria_of_refinement.py::test_a_promise_is_believed_where_the_last_was_kept_within_a_tenth"""
    near: float = 0.1
    """[of the length of a step that failed] In units of the diagonal of H, by which another has to differ to be tried.
    Why: of those nearer than that one in 90 helped; they were a fifth of all that a diagnosis of a short record tried.
    Test: test_criteria_of_refinement.py::test_a_step_within_a_tenth_of_one_that_failed_is_not_tried"""
    stride: float = 1e-5
    """[of an axis] By which a parameter is moved for a sensitivity. Why: the error of a difference, 1e-5 of the slope
    by the second derivative, is as large as that of rounding.
    Test: test_criteria_of_refinement.py::test_sensitivities_are_differences_over_a_hundred_thousandth_of_an_axis"""
    lost: float = 1e-7
    """[of the largest eigenvalue of H] Below which Newton's step of a fold goes nowhere along a direction. Why: a
    direction that a fold does not see stays.
    Test: test_criteria_of_refinement.py::test_a_newton_step_leaves_out_directions_of_a_ten_millionth"""
    fewest_means: int = 3
    """[runs] Fewest whose means tell of a bias. Why: of two the zero of the transducer explains the difference.
    Test: test_criteria_of_refinement.py::test_the_means_of_three_runs_tell_of_a_bias"""
    noise_of_means: float = 1e-14
    """[of the power of a record] Least power of the noise of the means. Why: rounding.
    Test: test_criteria_of_refinement.py::test_means_that_meet_exactly_are_known_to_rounding"""


@dataclass(frozen=True)
class Optima:
    """Where the refinements of several starts end, and which runs one model cannot explain."""

    same: float = 1e-6
    """[relative difference of errors] That is none: both ends are in one valley. Why: refinements end within 1e-10 of
    their promise, and in a flat valley a hundred times farther from it.
    Test: test_criteria_of_optima.py::test_ends_are_one_valley_agree_or_compete_by_their_errors"""
    agree: float = 1e-3
    """[relative difference of errors] Of one optimum that was found twice, and by which an optimum beyond a bound has
    to be better. Why: less does not matter.
    Test: test_criteria_of_optima.py::test_ends_are_one_valley_agree_or_compete_by_their_errors"""
    near: float = 0.01
    """[relative difference of errors] That is no reason to prefer one end to another. Why: records scatter by more.
    Test: test_criteria_of_optima.py::test_ends_are_one_valley_agree_or_compete_by_their_errors"""
    settled: int = 3
    """[starts] That end together. Why: two may do so by chance.
    Test: test_criteria_of_optima.py::test_three_further_starts_that_agree_settle_it"""
    competing: int = 2
    """[ends] Beside the best that are followed to the last sample. Why: each costs a refinement of every sample.
    Test: test_criteria_of_optima.py::test_two_competing_ends_are_followed_to_the_last_sample"""
    edge: float = 1e-6
    """[of an axis] Up to which a value is at its bound. Why: a refinement ends at a bound exactly, but for rounding.
    Test: test_criteria_of_optima.py::test_a_value_is_at_its_bound_within_a_millionth_of_the_axis"""
    fewest_runs: int = 5
    """[runs] Fewest of which one may be called bad. Why: the scatter of fewer is not known.
    Test: test_criteria_of_optima.py::test_a_run_is_bad_that_stands_out_of_five_and_more"""
    outlier: float = 5.0
    """[robust standard deviations] Of the logarithms of the errors, beyond which a run is bad. Why: one in two million
    by chance.
    Test: test_criteria_of_optima.py::test_a_run_is_bad_beyond_five_deviations_and_three_times_the_usual_error"""
    times: float = 3.0
    """[ratio of errors] To the usual one, beyond which a run is bad. Why: conditions that the model lacks make less.
    Test: test_criteria_of_optima.py::test_a_run_is_bad_beyond_five_deviations_and_three_times_the_usual_error"""
    most_bad: float = 0.05
    """[of the runs] Most that are bad, one at least. Why: where more are, the model is.
    Test: test_criteria_of_optima.py::test_one_run_in_twenty_is_bad_at_most"""


@dataclass(frozen=True)
class SearchedRange:
    """Over which values a parameter is searched, and when its range was too narrow."""

    further: float = 10.0
    """[times] As far reaches a range that was too narrow. Why: a decade is a step that a refinement takes at once.
    Test: test_criteria_of_optima.py::test_a_range_that_was_too_narrow_reaches_ten_times_as_far_up_to_three_times"""
    rounds: int = 3
    """[times] That a range is widened at most: a thousandfold. Why: beyond it the parameter is not seen, and at its
    bound.
    Test: test_criteria_of_optima.py::test_a_range_that_was_too_narrow_reaches_ten_times_as_far_up_to_three_times"""
    far: float = 30.0
    """[times the size of a parameter on this machine] From which on a bound or a value that was given is far off. Why:
    below it lies what a user may well want, above it an inch (39.4 to the metre), and every prefix of a unit.
    Test: test_criteria_of_optima.py::test_a_value_thirty_times_off_is_far_off"""
    of_steps: float = 10.0
    """[times] Beyond the band where it says much the power of a single step reaches. Why: it falls by 1/f² alone.
    Test: test_criteria_of_optima.py::test_the_band_of_steps_is_a_tenth_of_where_their_power_reaches"""
    same_area: float = 0.02
    """[relative difference] Of piston areas that still is the same machine. Why: a data sheet rounds by as much.
    Test: test_criteria_of_optima.py::test_a_paper_s_bounds_hold_for_a_piston_area_within_two_per_cent"""
    followed: float = 2.5
    """[of the fastest accurate mode] Up to which a mode is followed at all. Why: from 2.7 of it on a Runge-Kutta step
    goes astray.
    Test: test_criteria_of_optima.py::test_a_mode_is_followed_up_to_two_and_a_half_times_the_accurate_ones"""


@dataclass(frozen=True)
class Determination:
    """What the data determine, and what is said of it."""

    determined: float = 0.5
    """[relative standard error] Largest of a parameter that is determined. Why: at more its sign is not known either.
    Test: test_criteria_of_determination.py::test_a_parameter_is_determined_up_to_half_of_its_value"""
    combined: float = 0.1
    """[relative standard error] Largest of a combination that is reported. Why: it has to be worth reporting.
    Test: test_criteria_of_determination.py::test_a_combination_is_reported_up_to_a_tenth_of_its_value"""
    lost: float = 1e-9
    """[of the largest eigenvalue of H] Below which a direction is not determined at all. Why: differences have five
    digits, their squares nine or ten.
    Test: test_criteria_of_determination.py::test_a_direction_of_a_billionth_is_not_determined"""
    blind: float = 1e4
    """[logarithmic standard deviation] That stands for none at all. Why: more than any range has.
    Test: test_criteria_of_determination.py::test_what_moves_along_a_blind_direction_has_a_deviation_of_ten_thousand"""
    straight: float = 3e-5
    """[of a slope] Below which a quantity does not move along a blind direction. Why: three times the error of a
    difference over a stride of the search.
    Test: test_criteria_of_determination.py::test_what_hardly_moves_along_a_blind_direction_is_not_blind"""
    step: float = 1e-6
    """[of an axis] For the slope of a quantity. Why: to either side, its error is that of rounding.
    Test: test_criteria_of_determination.py::test_the_slope_of_a_quantity_is_taken_over_a_millionth_to_either_side"""
    no_influence: float = 10.0
    """[relative standard error] From which on a parameter is said to have no influence. Why: no range of values says
    more of it.
    Test: test_criteria_of_determination.py::test_from_ten_times_its_value_on_a_parameter_has_no_influence"""
    felt: float = 1.001
    """[ratio of errors] Of the model without an effect to that with it, from which on its strength is at its bound, and
    not off. Why: less comes of rounding and of the steps.
    Test: test_criteria_of_determination.py::test_an_effect_is_felt_whose_absence_raises_the_error_by_a_thousandth"""
    hardly: float = 0.8
    """[of the output] Left by a fit that explains hardly anything. Why: two thirds of the power are unexplained.
    Test: test_criteria_of_determination.py::
    test_a_fit_that_leaves_four_fifths_of_the_output_explains_hardly_anything"""
    drawn: int = 100
    """[vectors] Drawn within the standard errors for the interval of a free run. Why: two or three lie beyond each end.
    Test: test_criteria_of_determination.py::test_the_interval_of_a_free_run_holds_95_of_100_draws"""
    interval: tuple[float, float] = (0.025, 0.975)
    """[quantiles] Between which the errors of a free run lie. Why: 95 %, as usual.
    Test: test_criteria_of_determination.py::test_the_interval_of_a_free_run_holds_95_of_100_draws"""
    slow: float = 1e-3
    """[of the slowest pole] Frequency at which the lag to a slow command is read. Why: the phase is straight there.
    Test: test_criteria_of_determination.py::test_the_lag_to_a_slow_command_is_read_a_thousand_times_below_the_poles"""
    integrating: float = 1e-6
    """[of the fastest pole] Below which a pole integrates. Why: a machine's poles are less than five decades apart.
    Test: test_criteria_of_determination.py::test_a_pole_a_million_times_slower_than_the_fastest_integrates"""


@dataclass(frozen=True)
class Criteria:
    """Every number that decides in a fit, a section for each step."""

    search: GeneticSearch = GeneticSearch()
    search_options: SearchOptions = SearchOptions()
    cross_check_searches: CrossCheckSearches = CrossCheckSearches()
    band: Band = Band()
    reduced: ReducedRecords = ReducedRecords()
    first_states: FirstStates = FirstStates()
    offsets: OffsetsOfTransducers = OffsetsOfTransducers()
    windows: WindowsOfRecords = WindowsOfRecords()
    refinement: Refinement = Refinement()
    optima: Optima = Optima()
    ranges: SearchedRange = SearchedRange()
    determination: Determination = Determination()
    inverse_dynamics: InverseDynamicsRegression = InverseDynamicsRegression()


FIT_CRITERIA = Criteria()
