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
    Test: discovery/test_search.py::test_what_stood_in_for_a_term_is_left_out_again"""
    worthwhile: float = 1e-2
    """[relative reduction] Least reduction of the error that is worth a term. Why: less is not worth one, however
    certain.
    Test: discovery/test_term_evidence.py::test_all_runs_gain_or_some_gain_much_and_none_loses"""
    log_likelihood_gain: float = 5.0
    """[log-likelihood] Least gain beyond the logarithm of the number of candidates. Why: one in 150 by chance, whatever
    the number. Test: discovery/test_search.py::test_noise_of_any_colour_is_no_physics"""
    close: float = 1.1
    """[ratio of rough errors] To the least error, within which refits are refined. Why: a rough refit is that far
    off."""
    most_close: int = 8
    """[refits] Refined at most. Why: the rest is far behind."""
    plain: int = 4
    """[terms] Terms without shapes that are refined, too. Why: held-out data may prefer them."""
    practically_equal: float = 1.02
    """[ratio of errors] To the least error, within which a simpler term is taken. Why: the simpler one is more
    likely."""
    lost_gain: float = 0.25
    """[of the best term's gain] Share that a simpler term may lose. Why: where all terms gain little, a term with an
    equal error may gain nothing. Test: discovery/test_term_candidate.py::
    test_what_is_simpler_and_gains_next_to_nothing_does_not_stand_for_what_gains"""
    fewest_runs: int = 6
    """[runs] Least number for which separate runs search, choose and confirm. Why: one run does not show the
    differences between runs. Test:
    discovery/test_free_curves.py::test_of_few_runs_a_curve_is_drawn_only_where_it_is_asked_for"""
    parts: int = 3
    """[parts] Of the runs: to search, to choose, to confirm. Why: the sets have to be disjoint."""
    classes: int = 6
    """[classes] Of terms that are refitted. Why: the best is among the first."""
    pairs: int = 3
    """[pairs] Of terms that are refitted. Why: the best is among the first."""
    pairs_seen: int = 200
    """[pairs] From which the distinguishable ones are taken. Why: all others explain far less."""
    cancelled: float = 1e-6
    """[of the power of both] Below which the difference of a pair of terms is nothing. Why: the two are one term."""
    may_win: float = 0.5
    """[of the best term's reduction] Least predicted reduction of a term whose shape is to be moved. Why: a shape that
    is not yet at its optimum has that much of it."""
    same_shape: float = 0.01
    """[of the range of a shape] Within which two guesses lead to the same refit. Why: from there both come to the
    same optimum.
    Test: discovery/test_term_candidate.py::test_what_was_refitted_from_about_there_is_not_refitted_again"""
    smoothing: int = 16
    """[frequencies] Averaged in a periodogram. Why: its scatter is then a quarter of its level."""
    few_runs: int = 3
    """[runs] Below which their scatter is not used. Why: the scatter of two runs is not known.
    Test: discovery/test_term_evidence.py::test_all_runs_gain_or_some_gain_much_and_none_loses"""
    consistent: float = 3.0
    """[standard errors] By which the mean gain of a run exceeds zero. Why: one in 700 by chance.
    Test: discovery/test_term_evidence.py::test_all_runs_gain_or_some_gain_much_and_none_loses"""
    lost: float = 0.03
    """[of the gains] Most that the runs may lose in all where few gain. Why: a stop that only some runs reach loses
    nothing in the others. Test: discovery/test_term_evidence.py::test_all_runs_gain_or_some_gain_much_and_none_loses"""
    absorbed: float = 1e-4
    """[of a term's power] Least share that the parameters do not explain. Why: below it the parameters replace the
    term."""
    same_class: float = 0.999
    """[cosine] Of two terms that are one class. Why: the data cannot tell them apart."""
    digits: int = 8
    """[digits] Of a reduction that count. Why: further digits are rounding."""
    runs_at_once: int = 4
    """[runs] Whose columns lie side by side in memory. Why: memory.
    Test: discovery/test_search.py::test_the_regression_is_that_of_all_terms_and_runs_at_once"""
    rank: float = 1e-10
    """[of the largest eigenvalue] Below which a direction of the parameters is undetermined. Why: rounding of the
    products."""
    block: int = 128
    """[terms] Whose responses are worked out together. Why: the responses to all terms at once are large.
    Test: discovery/test_search.py::test_the_regression_is_that_of_all_terms_and_runs_at_once"""
    columns_at_once: int = 32
    """[terms] Whose samples are simulated to the output at once. Why: they stay in the processor's cache.
    Test: discovery/test_regressors.py::test_a_column_is_to_the_bit_what_it_is_alone"""
    band: float = 1.3
    """[of the command's band] Band of the search. Why: above it there is noise alone."""
    diverged: float = 1e60
    """[of the output] Size of a response to a strength of one from which on it has diverged. Why: no power of a signal
    comes near. Test: discovery/test_search.py::test_an_answer_that_grows_without_end_is_no_column"""
    rounding: float = 1e-12
    """[of the measured deviation] Below which a residual is rounding. Why: rounding of the arithmetic.
    Test: discovery/test_any_machine.py::test_a_residual_of_rounding_alone_is_not_explained"""
    free_rank: float = 1e-9
    """[of the largest] Least singular value of the nuisance parameters of a run. Why: rounding."""
    samples: int = 60_000
    """[samples] Of all runs on the coarse clock. Why: records are cut to their beginnings."""
    fewest_samples: int = 256
    """[samples] Of each run, however many there are. Why: a spectrum needs some."""
    knots: tuple[float, ...] = (0.005, 0.04, 0.12, 0.25, 0.38, 0.5, 0.62, 0.75, 0.88, 0.96, 0.995)
    """[quantiles of the signal] Where a free curve has its knots. Why: more at the ends, where curves bend.
    Test: discovery/test_free_curves.py::test_what_no_form_reaches_is_drawn_as_a_free_curve"""
    knots_apart: float = 1e-3
    """[of the signal's range] Nearer than which two knots are one. Why: a hat between them would see no samples."""
    fewest_knots: int = 4
    """[knots] Of a free curve. Why: fewer are a formula."""
    curves: int = 4
    """[curves] That are refitted. Why: the best is among the first."""
    same_curve: float = 0.99
    """[cosine] Between the outputs that two curves explain, above which the first is enough. Why: the second would
    explain nothing more."""
    curve_rank: float = 1e-7
    """[of the largest product] Of hats, below which their joint response is undetermined. Why: rounding of the
    products."""
    bins: int = 24
    """[bins] Of a characteristic. Why: a curve is then seen, and each bin has samples."""
    shown: float = 0.5
    """[of a term's power] Least share that a curve is to show. Why: below it no curve shows the term.
    Test: discovery/test_characteristic_plot.py::test_a_term_is_drawn_where_it_shows"""
    straight: float = 1e-6
    """[of a term's power] Below which nothing remains beyond a straight line. Why: rounding."""
    small: float = 0.1
    """[of a signal's deviation] Size below which no quotient by the signal is taken. Why: a quotient of small numbers
    scatters."""
    proportional: float = 1.0 - 1e-6
    """[cosine] Of two signals that are one in other units. Why: rounding of a file."""
    rests: float = 1e-9
    """[of its size] Deviation up to which a channel is the same in all runs. Why: rounding of a file."""
    strength_reach: float = 4.0
    """[ratio] Of the bounds of a strength to the strength at which the term is as large as the signal. Why: a term is
    rarely larger than the signal that it adds to."""
    strength_far: float = 10.0
    """[ratio] Of the bounds of a strength to its value in the regression. Why: the linear answer may be that far
    off."""
    curve_steep: float = 20.0
    """[ratio] Of the bounds of the values of a curve to a large value of it. Why: a curve that a refit bends may rise
    beyond its first values."""


@dataclass(frozen=True)
class TermShapes:
    """Where the shapes of the terms of the library begin, and how far a refit may move them."""

    spread: float = 8.0
    """[ratio] To either side by which a refit moves a shape. Why: the neighbouring guesses are nearer."""
    thresholds: tuple[float, ...] = (0.3, 0.5, 0.7, 0.85, 0.95)
    """[quantiles of a signal's size] Where a threshold lies. Why: a refit moves it from there: the neighbours lie
    within its reach."""
    hills: tuple[float, ...] = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)
    """[quantiles of the position] Where a hill lies. Why: a refit moves it from there: the neighbours lie within
    its reach."""
    hill_widths: tuple[float, ...] = (0.1, 0.25)
    """[of the range of the position] Width of a hill. Why: a refit moves it from there: the neighbours lie within
    its reach."""
    range_quantiles: tuple[float, ...] = (0.02, 0.98)
    """[quantiles] Of the position that are its range. Why: single samples do not count."""
    slow: tuple[float, ...] = (0.05, 0.15, 0.4)
    """[quantiles of the speed's size] Below which the machine is near rest. Why: a refit moves it from there: the
    neighbours lie within its reach."""
    fading: tuple[float, ...] = (0.15, 0.5)
    """[of the shortest run] Time constant of a term that fades. Why: a refit moves it from there: the neighbours lie
    within its reach."""
    phases: tuple[float, ...] = (0.0, 0.25)
    """[of a turn] Phases of a periodic term. Why: a sine and a cosine."""
    frequency_spread: float = 0.7
    """[of a line's distance] By which a refit moves a frequency. Why: the next line begins there."""
    lags: tuple[float, ...] = (0.02, 0.06, 0.2, 0.6)
    """[of a period at the end of the band, times 2π] Time constant of a lag. Why: a refit moves it from there: the
    neighbours lie within its reach."""
    plays: tuple[float, ...] = (0.1, 0.3, 0.6)
    """[of the deviation of a signal] Half width of a play. Why: a refit moves it from there: the neighbours lie
    within its reach."""
    slipping: float = 0.1
    """[quantile of the speed's size] Below which friction slips. Why: a refit moves it from there: the neighbours
    lie within its reach."""
    yielding: tuple[float, ...] = (0.1, 0.4, 1.5)
    """[of the deviation of the position] Way over which a force yields. Why: a refit moves it from there: the
    neighbours lie within its reach."""
    resonances: tuple[float, ...] = (0.15, 0.2, 0.27, 0.36, 0.48, 0.65, 0.9)
    """[of the end of the band] Frequency of a resonance. Why: a refit moves it from there: the neighbours lie
    within its reach."""
    damping: float = 0.1
    """[of critical damping] Of a resonance. Why: a refit moves it from there: the neighbours lie within its
    reach."""
    recovering: tuple[float, ...] = (0.02, 0.1, 0.5)
    """[of the shortest run] Time constant of a term that recovers. Why: a refit moves it from there: the neighbours lie
    within its reach."""
    soft: tuple[float, ...] = (0.3, 0.7, 0.95)
    """[quantiles of the pressure's size] Where half of the compressibility of air is gone. Why: a refit moves it from
    there: the neighbours lie within its reach."""
