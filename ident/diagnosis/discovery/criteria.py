"""Every number that decides in the search for terms that no catalogue holds.

The two classes are sections of ident.diagnosis.criteria and have the same form.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Discovery:
    """The search for terms that no catalogue holds."""

    most: int = 3
    """[terms] Proposed at most. Why: each is sought in addition to the last.
    Test: discovery/test_criteria_of_terms.py::test_three_terms_are_proposed_at_most"""
    worthwhile: float = 1e-2
    """[relative reduction] Least reduction of the error that is worth a term. Why: less is not worth one, however
    certain.
    Test: discovery/test_criteria_of_terms.py::test_a_term_is_worthwhile_where_the_error_falls_by_a_hundredth"""
    log_likelihood_gain: float = 5.0
    """[log-likelihood] Least gain beyond the logarithm of the number of candidates. Why: one in 150 by chance, whatever
    the number.
    Test: discovery/test_criteria_of_terms.py::
    test_the_best_of_many_terms_has_to_gain_five_nats_beyond_the_logarithm_of_their_number"""
    lost_gain: float = 0.25
    """[of the best term's gain] Share that a simpler term may lose. Why: where all terms gain little, a term with an
    equal error may gain nothing.
    Test: discovery/test_criteria_of_terms.py::test_a_simpler_term_may_lose_a_quarter_of_the_gain"""
    fewest_runs: int = 6
    """[runs] Least number for which separate runs search, choose and confirm. Why: one run does not show the
    differences between runs.
    Test: discovery/test_criteria_of_terms.py::test_six_runs_are_parted_into_those_that_search_choose_and_confirm"""
    classes: int = 6
    """[classes] Of terms that are refitted. Why: the best is usually among the first; chosen by what it costs, and no
    measurement of it is kept.
    Test: discovery/test_criteria_of_terms.py::test_the_six_best_classes_are_refitted"""
    of_a_kind: int = 4
    """[candidates] Of one kind that are refitted: pairs of terms, curves, and terms without shapes behind the leading
    ones. Why: the best is usually among the first, and held-out data may prefer a plain term; chosen by what it costs,
    and no measurement of it is kept.
    Test: discovery/test_criteria_of_terms.py::
    test_four_pairs_at_most_are_refitted_and_none_that_gains_less_than_half_of_the_best"""
    may_win: float = 0.5
    """[of the best's reduction] Least predicted reduction of a pair of terms, and of a term whose shape is to be moved.
    Why: a shape that is not yet at its optimum has that much of it, and a pair that explains less is not the best.
    Test: discovery/test_criteria_of_terms.py::test_a_kind_with_a_shape_is_refitted_where_it_gains_half_of_the_best"""
    same_shape: float = 0.01
    """[of the range of a shape] Within which two guesses lead to the same refit. Why: from there both come to the same
    optimum.
    Test: discovery/test_criteria_of_terms.py::
    test_two_first_values_lead_to_one_refit_within_a_hundredth_of_the_range"""
    smoothing: int = 16
    """[frequencies] Averaged in a periodogram. Why: its scatter is then a quarter of its level.
    Test: discovery/test_criteria_of_terms.py::test_a_line_gains_what_it_adds_to_the_mean_of_sixteen_frequencies"""
    few_runs: int = 3
    """[runs] Below which their scatter is not used. Why: the scatter of two runs is not known.
    Test: discovery/test_criteria_of_terms.py::test_the_scatter_of_two_runs_is_not_known"""
    consistent: float = 3.0
    """[standard errors] By which the mean gain of a run exceeds zero. Why: one in 700 by chance.
    Test: discovery/test_criteria_of_terms.py::
    test_runs_agree_where_their_mean_gain_is_three_standard_errors_above_zero"""
    lost: float = 0.03
    """[of the gains] Most that the runs may lose in all where few gain. Why: a stop that only some runs reach loses
    nothing in the others.
    Test: discovery/test_criteria_of_terms.py::test_runs_lose_three_in_a_hundred_of_the_gains_at_most"""
    absorbed: float = 1e-4
    """[of a term's power] Least share that the parameters do not explain. Why: below it the parameters replace the
    term.
    Test: discovery/test_criteria_of_terms.py::
    test_a_term_that_the_parameters_explain_is_absorbed_but_for_a_part_in_ten_thousand"""
    same_class: float = 0.999
    """[cosine] Of the outputs of two terms, or of what two curves explain, that are one class. Why: the data cannot
    tell them apart.
    Test: discovery/test_criteria_of_terms.py::test_two_terms_are_one_class_where_the_data_cannot_tell_them_apart"""
    digits: int = 8
    """[digits] Of a reduction that count. Why: further digits are rounding.
    Test: discovery/test_criteria_of_terms.py::test_the_reductions_of_two_terms_differ_from_the_eighth_digit_on"""
    band: float = 1.3
    """[of the command's band] Band of the search. Why: above it there is noise alone.
    Test: discovery/test_criteria_of_terms.py::test_the_search_reaches_a_third_beyond_the_band_of_the_command"""
    diverged: float = 1e60
    """[of the output] Size of a response to a strength of one from which on it has diverged. Why: no power of a signal
    comes near.
    Test: discovery/test_criteria_of_terms.py::test_a_response_beyond_all_numbers_has_diverged"""
    fewest_samples: int = 256
    """[samples] Of each run, however many there are. Why: a spectrum needs some.
    Test: discovery/test_criteria_of_terms.py::test_each_run_has_256_samples_of_the_coarse_clock_at_least"""
    knots: tuple[float, ...] = (0.005, 0.04, 0.12, 0.25, 0.38, 0.5, 0.62, 0.75, 0.88, 0.96, 0.995)
    """[quantiles of the signal] Where a free curve has its knots. Why: more at the ends, where curves bend.
    Test: discovery/test_criteria_of_terms.py::test_a_curve_has_a_knot_near_every_quantile_of_its_signal"""
    fewest_knots: int = 4
    """[knots] Of a free curve. Why: fewer are a formula.
    Test: discovery/test_criteria_of_terms.py::test_a_curve_has_four_knots_at_least"""
    bins: int = 24
    """[bins] Of a characteristic. Why: a curve is then seen, and each bin has samples.
    Test: discovery/test_criteria_of_terms.py::test_a_characteristic_with_24_steps_is_seen_whole"""
    shown: float = 0.5
    """[of a term's power] Least share that a curve is to show. Why: below it no curve shows the term.
    Test: discovery/test_criteria_of_terms.py::test_a_curve_shows_a_term_where_it_explains_half_of_it"""
    small: float = 0.1
    """[of a signal's deviation] Size below which no quotient by the signal is taken. Why: a quotient of small numbers
    scatters.
    Test: discovery/test_criteria_of_terms.py::test_no_quotient_is_drawn_of_a_signal_below_a_tenth_of_its_deviation"""
    strength_reach: float = 4.0
    """[ratio] Of the bounds of a strength to the strength at which the term is as large as the signal. Why: a term is
    rarely larger than the signal that it adds to.
    Test: discovery/test_criteria_of_terms.py::
    test_a_strength_reaches_four_times_the_size_of_its_signal_and_ten_times_its_first_value"""
    strength_far: float = 10.0
    """[ratio] Of the bounds of a strength to its value in the regression. Why: the linear answer may be that far off.
    Test: discovery/test_criteria_of_terms.py::
    test_a_strength_reaches_four_times_the_size_of_its_signal_and_ten_times_its_first_value"""
    curve_steep: float = 20.0
    """[ratio] Of the bounds of the values of a curve to a large value of it. Why: a curve that a refit bends may rise
    beyond its first values.
    Test: discovery/test_criteria_of_terms.py::
    test_a_curve_may_rise_to_twenty_times_its_value_at_the_knot_that_is_held"""


@dataclass(frozen=True)
class TermShapes:
    """Where the shapes of the terms of the library begin, and how far a refit may move them."""

    spread: float = 8.0
    """[ratio] To either side by which a refit moves a shape. Why: the neighbouring guesses are nearer.
    Test: discovery/test_criteria_of_shapes.py::test_a_refit_moves_a_shape_by_a_factor_of_eight"""
    thresholds: tuple[float, ...] = (0.3, 0.5, 0.7, 0.85, 0.95)
    """[quantiles of a signal's size] Where a threshold lies, and where half of the compressibility of air is gone. Why:
    a refit moves it from there: the neighbours lie within its reach.
    Test: discovery/test_criteria_of_shapes.py::test_a_shape_lies_near_one_from_which_a_refit_begins"""
    hills: tuple[float, ...] = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)
    """[quantiles of the position] Where a hill lies. Why: a refit moves it from there: the neighbours lie within its
    reach.
    Test: discovery/test_criteria_of_shapes.py::
    test_a_hill_anywhere_along_the_way_lies_near_one_from_which_a_refit_begins"""
    hill_widths: tuple[float, ...] = (0.1, 0.25)
    """[of the range of the position] Width of a hill. Why: a refit moves it from there: the neighbours lie within its
    reach.
    Test: discovery/test_criteria_of_shapes.py::test_a_shape_lies_near_one_from_which_a_refit_begins"""
    slow: tuple[float, ...] = (0.05, 0.15, 0.4)
    """[quantiles of the speed's size] Below which the machine is near rest; friction slips below the least. Why: a
    refit moves it from there: the neighbours lie within its reach.
    Test: discovery/test_criteria_of_shapes.py::test_a_shape_lies_near_one_from_which_a_refit_begins"""
    frequency_spread: float = 0.7
    """[of a line's distance] By which a refit moves a frequency. Why: the next line begins there.
    Test: discovery/test_criteria_of_shapes.py::
    test_a_refit_moves_a_frequency_beyond_half_of_the_way_to_the_next_line_and_not_to_it"""
    lags: tuple[float, ...] = (0.02, 0.06, 0.2, 0.6)
    """[of a period at the end of the band, times 2π] Time constant of a lag. Why: a refit moves it from there: the
    neighbours lie within its reach.
    Test: discovery/test_criteria_of_shapes.py::test_a_shape_lies_near_one_from_which_a_refit_begins"""
    plays: tuple[float, ...] = (0.1, 0.3, 0.6)
    """[of the deviation of a signal] Half width of a play, and way over which a force yields. Why: a refit moves it
    from there: the neighbours lie within its reach.
    Test: discovery/test_criteria_of_shapes.py::test_a_shape_lies_near_one_from_which_a_refit_begins"""
    resonances: tuple[float, ...] = (0.15, 0.2, 0.27, 0.36, 0.48, 0.65, 0.9)
    """[of the end of the band] Frequency of a resonance. Why: a refit moves it from there: the neighbours lie within
    its reach.
    Test: discovery/test_criteria_of_shapes.py::test_a_shape_lies_near_one_from_which_a_refit_begins"""
    damping: float = 0.1
    """[of critical damping] Of a resonance. Why: a refit moves it from there: the neighbours lie within its reach.
    Test: discovery/test_criteria_of_shapes.py::test_a_shape_lies_near_one_from_which_a_refit_begins"""
    time_constants: tuple[float, ...] = (0.02, 0.1, 0.5)
    """[of the shortest run] Time constant of a term that fades or recovers. Why: a refit moves it from there: the
    neighbours lie within its reach.
    Test: discovery/test_criteria_of_shapes.py::test_a_shape_lies_near_one_from_which_a_refit_begins"""
