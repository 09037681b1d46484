"""Every number that decides in a diagnosis, by the stage that it decides in.

Below each number stand [its unit], its meaning (read: value, unit, meaning), the reason for it, and the test in
tests/diagnosis that fails where the number moves by 30 %.
"""

from __future__ import annotations

from dataclasses import dataclass

from ident.diagnosis.discovery.criteria import Discovery, TermShapes
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.fit.levenberg_marquardt import Way


@dataclass(frozen=True)
class Estimation:
    """How far the parameters of one model are refined, and which refits are valid."""

    full: Way = Way(1e-7, 20, rough=1e-5)
    """[Way] Effort of a refit to every sample. Why: 20 steps end within a hundredth of a tie.
    Test: test_criteria_of_estimation.py::test_a_refit_that_still_gains_ends_after_its_steps"""
    coarse: Way = Way(1e-4, 20, rough=1e-4)
    """[Way] Effort of a refit that begins far away, and of a finalist that was behind the best on trial. Why: both lack
    far more than a tie, and from far away ten steps do not arrive.
    Test: test_criteria_of_estimation.py::test_a_refit_that_still_gains_ends_after_its_steps"""
    trial: Way = Way(1e-4, 10, rough=1e-4)
    """[Way] Effort of a refit on trial. Why: a trial only has to rank to within a tie, and is refined if it is among
    the first.
    Test: test_criteria_of_estimation.py::test_a_refit_that_still_gains_ends_after_its_steps"""
    screen: Way = Way(1e-5, 3)
    """[Way] Effort of first steps from many starts. Why: after three steps the best start is known.
    Test: test_criteria_of_estimation.py::test_a_refit_that_still_gains_ends_after_its_steps"""
    trial_samples: int = 131_072
    """[samples] Of all runs in a trial. Why: enough for a ranking; the finalists take every sample.
    Test: test_criteria_of_estimation.py::test_a_refit_takes_so_much_of_the_records"""
    rough_samples: int = 49_152
    """[samples] Of all runs on which effects are predicted, points of the whole space are judged, refits from far away
    begin and terms are sought. Why: all effects take about a second, and 128 points about as much as one trial.
    Test: test_criteria_of_estimation.py::test_a_refit_takes_so_much_of_the_records"""
    delayed_power: float = 1.5
    """[ratio of powers] Of the residual of a run to that of its first part, above which trials take the run whole. Why:
    the power of the first part of a stationary residual with a hundred independent samples scatters by a seventh; a
    stop that is hit after it makes the ratio 1.3 to 3,000.
    Test: test_trial_records.py::test_a_run_whose_residual_comes_late_is_tried_whole"""
    global_points: int = 128
    """[points] Of a Sobol sample of the whole search space. Why: they cost about as much as one trial; of models with
    ten parameters no measurement of it is kept.
    Test: test_criteria_of_estimation.py::test_a_model_of_unknown_place_is_begun_from_the_four_best_of_128_points"""
    global_starts: int = 4
    """[points] Of these from which a refit begins. Why: the least error of a coarse sample is not always the best
    start; chosen by what it costs, and no measurement of it is kept.
    Test: test_criteria_of_estimation.py::test_a_model_of_unknown_place_is_begun_from_the_four_best_of_128_points"""
    leading: int = 8
    """[refits] Of first steps, and of rough refits with terms, that are continued. Why: the rest is usually far behind;
    chosen by what it costs, and no measurement of it is kept.
    Test: test_fitted_model.py::test_of_first_steps_the_eight_that_leave_least_go_on"""
    new_optimum: float = 0.99
    """[ratio of errors] Below which a refit is at another optimum than the one before. Why: refits of one optimum
    differ by less than 1e-4, optima of an effect that acts in jumps by some per cent.
    Test: test_criteria_of_estimation.py::test_a_refit_one_per_cent_better_is_at_another_optimum"""
    places_of_rest: int = 65
    """[places] Along its range, at which such a parameter is tried. Why: eight a decade of an eight-decade range.
    Test: test_criteria_of_estimation.py::test_a_parameter_at_rest_is_looked_for_at_each_64th_of_its_range"""
    convergence_rounds: int = 5
    """[refits] To continue with while each is at a better optimum. Why: in a long narrow valley one refit stops on its
    way, and of an effect that acts in jumps the next optimum lies behind the last.
    Test: test_criteria_of_estimation.py::test_a_refit_is_continued_five_times_at_most"""
    pair_shares: tuple[float, ...] = (1.0, 0.3, 0.03)
    """[of the strength] Of the second of two effects when fitted alone, to start the pair from; and of an equal part of
    the strengths of several, to start them all from. Why: the first may take over most of what the second explained
    alone.
    Test: test_criteria_of_estimation.py::test_a_pair_begins_with_all_of_the_second_effect_and_with_a_small_part"""
    simulation_excess: float = 1.03
    """[ratio of errors] Of a simulation over its linear prediction that is still a result. Why: a model that is not
    linear in its initial states may look good at states that no simulation confirms.
    Test: test_fitted_model.py::test_what_no_first_state_leads_to_is_no_refit"""
    off_strength: float = 0.01
    """[of the largest strength] Below which an effect is as good as off. Why: less is not seen in the output.
    Test: test_criteria_of_estimation.py::test_an_effect_is_as_good_as_off_at_a_hundredth_of_its_range"""


@dataclass(frozen=True)
class Noise:
    """When an error is noise alone."""

    floor_contradicted: float = 1.2
    """[ratio] Of a noise floor to the error of the fitted model, above which the floor is not believed. Why: samples of
    one phase differ where a motion jumps between two of them.
    Test: test_free_shapes.py::test_a_floor_that_a_fitted_model_comes_below_is_none"""
    floor_deviations: float = 3.0
    """[standard deviations] Of the noise floor, by which the error may exceed it. Why: one in 700 by chance.
    Test: test_criteria_of_estimation.py::test_an_error_is_noise_within_each_margin"""
    colour: float = 2.0
    """[ratio] Of the error to a noise floor from frequencies above the command's, up to which coloured noise may make
    it. Why: noise whose memory is two samples long is twice as large as white noise with its power there; a larger
    error that no input predicts is of six measured machines out of six no noise.
    Test: test_candidate_models.py::test_coloured_noise_makes_no_error_of_three_times_the_floor"""
    bench_excess: float = 0.25
    """[of the floor] By which an error on the records of a bench may exceed it. Why: the error of a reading that stands
    still lasts long.
    Test: test_criteria_of_estimation.py::test_an_error_is_noise_within_each_margin"""
    noise_correlation: float = 0.5
    """[correlation] Of a residual with itself that noise may have where no floor is known. Why: above it the residual
    has a memory.
    Test: test_criteria_of_estimation.py::test_an_error_is_noise_within_each_margin"""
    memory: int = 10
    """[samples] Up to which a residual is compared with itself there. Why: a swing of up to twenty samples turns round
    within them, and what is slower is like its neighbour.
    Test: test_criteria_of_estimation.py::test_what_swings_is_no_noise_where_no_floor_is_known"""


@dataclass(frozen=True)
class StructureSelection:
    """Which machine fits where none is named, and over which windows it is judged."""

    unusual: float = 0.01
    """[ratio of the probability of the usual machine to that of one that moves otherwise as a rule] Below which the
    unusual one is meant. Why: with an effect a motor often explains a cylinder by fewer parameters.
    Test: test_structure_selection.py::test_an_unusual_machine_stands_for_the_usual_one_that_moves_alike"""
    no_parts: float = 0.5
    """[prior, as a ratio to that of a machine] Of a lag, which has no parts. Why: a machine may answer by a lag
    and nothing else, and friction and springs act on the machine alone.
    Test: test_structure_selection.py::test_a_lag_is_taken_that_is_more_probable_than_a_machine"""
    tried_further: float = 1.3
    """[ratio of held-out errors] To the best model without an effect, up to which a model is tried with more effects
    where none explains the records. Why: a machine without what it lacks leaves about as much as what imitates it.
    Test: test_structure_selection.py::
    test_a_model_about_as_good_as_the_best_is_tried_with_more_effects_where_none_explains_the_records"""
    within_reach: float = 10.0
    """[ratio of held-out errors] To the best model with its effect, up to which a smaller one is given a second effect.
    Why: with one of two effects that it lacks a machine leaves up to ten times what a larger one leaves; chosen by what
    it costs, since it only counts where it explains the records, or more than a larger one.
    Test: test_smaller_machines.py::
    test_a_smaller_machine_with_two_effects_is_compared_where_it_explains_more_than_a_larger_one"""
    longer_gain: float = 10.0
    """[log-likelihood] Gain of longer windows over the fitted ones, beyond the logarithm of the number of models. Why:
    one in 20,000 by chance.
    Test: test_criteria_of_comparison.py::test_longer_windows_have_to_make_the_records_more_likely_beyond_chance"""
    carried_models: int = 4
    """[models] Taken to the next longer windows. Why: the most probable of each set of effects.
    Test: test_criteria_of_ranking.py::test_the_four_most_probable_sets_of_effects_are_taken_to_longer_windows"""


@dataclass(frozen=True)
class Screening:
    """The predicted error of each effect, to first order."""

    strengths: tuple[float, ...] = (0.01, 0.03, 0.1, 0.3, 1.0)
    """[of the way to each bound] At which an effect is simulated. Why: a response scales over a factor of three.
    Test: test_criteria_of_prediction.py::test_strengths_over_four_decades_lie_near_one_that_is_simulated"""
    weak_strengths: tuple[float, ...] = (1e-4, 3e-4, 1e-3, 3e-3)
    """[of the way to each bound] In addition, for a machine of unknown size. Why: its bounds are wide.
    Test: test_criteria_of_prediction.py::test_strengths_over_four_decades_lie_near_one_that_is_simulated"""
    many_shapes: int = 10
    """[initial guesses] Of shapes, above which each is simulated at fewer strengths. Why: the simulations are as many
    as shapes times strengths.
    Test: test_criteria_of_prediction.py::test_of_many_shapes_each_is_simulated_once"""
    strengths_of_many: tuple[float, ...] = (0.3,)
    """[of the way to each bound] At which each of many shapes is simulated. Why: scaled by two it reaches from a sixth
    to over half of the range; weaker and stronger ones are left to the refit.
    Test: test_criteria_of_prediction.py::
    test_the_one_strength_of_many_shapes_can_be_scaled_from_a_sixth_to_over_half_of_the_range"""
    strengths_of_stop: tuple[float, ...] = (1.02, 1.08, 1.2, 1.4, 1.7)
    """[of the inverse of the way that was covered] At which a stop is simulated. Why: a stop that gives way was passed.
    Test: test_initial_guesses.py::test_a_stop_that_gives_way_lies_before_the_end_of_the_way"""
    elsewhere: int = 3
    """[places] Of its shapes from which a refit begins again, in addition to the one with the best prediction. Why:
    there are four places along a range.
    Test: test_free_shapes.py::test_a_search_for_a_width_begins_again_from_three_other_places_and_three_strengths"""
    max_scaling: float = 2.0
    """[ratio of strengths] By which a response may be scaled. Why: beyond it the response would be another strength's.
    Test: test_criteria_of_prediction.py::test_a_response_is_scaled_by_two_at_most"""
    strength_powers: tuple[float, ...] = (0.67, 0.33, 0.0)
    """[exponent of the scaling] Of further starts, between the scaled and the simulated strength. Why: an effect with a
    threshold needs the simulated strength.
    Test: test_criteria_of_prediction.py::
    test_from_the_simulated_strength_to_the_scaled_one_refits_begin_within_a_factor_of_five"""
    threshold_growth: float = 300.0
    """[ratio of powers] Of two neighbouring responses between which a threshold lies. Why: a proportional response
    grows by at most ten.
    Test: test_criteria_of_prediction.py::test_a_threshold_lies_where_the_power_of_a_response_grows_three_hundredfold"""
    reweighting_rounds: int = 3
    """[rounds] Of weighting each run by its residual. Why: the weights settle within three.
    Test: test_criteria_of_prediction.py::test_the_weights_of_runs_are_settled_when_a_fit_is_predicted"""


@dataclass(frozen=True)
class InitialGuesses:
    """Where the shapes of an effect begin."""

    lines: int = 6
    """[lines] Of the spectrum taken as frequencies. Why: the clearest are usually among the first three.
    Test: test_criteria_of_prediction.py::test_the_six_clearest_lines_of_a_spectrum_are_tried"""
    angles: int = 6
    """[angles] Around a turn, where a phase begins. Why: an optimum of a phase reaches a third of a turn.
    Test: test_criteria_of_prediction.py::test_a_phase_begins_at_each_sixth_of_a_turn"""
    along_range: tuple[float, ...] = (0.2, 0.4, 0.6, 0.8)
    """[of an axis] Where a searched shape begins, and where strengths are tried between two of which one does next to
    nothing and the other much. Why: a width is felt over about a fifth of four decades.
    Test: test_criteria_of_prediction.py::test_a_threshold_lies_where_the_power_of_a_response_grows_three_hundredfold"""
    finely: int = 24
    """[places] Where a searched shape begins with which the output jumps. Why: over two decades each is a fifth longer
    than the one before, about the resolution of a play in a sample.
    Test: test_criteria_of_prediction.py::test_a_shape_with_which_the_output_jumps_begins_at_places_a_fifth_apart"""
    hanging_shares: tuple[float, ...] = (0.1, 0.4, 0.7, 0.9)
    """[of the moving mass] That may hang behind a spring, where the search for its frequency begins. Why: the
    frequencies that follow, down to a quarter of that of the record, lie within a third of one; over how much a refit
    follows a resonance is not measured.
    Test: test_criteria_of_prediction.py::test_a_part_behind_a_spring_begins_within_a_third_of_its_frequency"""
    periods: int = 16
    """[periods of the resonance of the records] Of a stretch whose spectrum is averaged with those of others. Why: a
    mode with a damping ratio of 0.03 is as wide as such a stretch resolves.
    Test: test_initial_guesses.py::test_what_swings_beside_the_machine_is_seen_in_the_residual"""
    apart: float = 1.33
    """[times the resonance of the records, or of its inverse] From where on a peak of the residual is another one. Why:
    the residual is large at the resonance itself, whose damping is off; starts within a third reach one another.
    Test: test_initial_guesses.py::test_what_swings_beside_the_machine_is_seen_in_the_residual"""
    upper_share: float = 0.4
    """[of the moving mass] That may hang behind a spring whose mode lies above the resonance of the records, where the
    search for its frequency begins. Why: the frequencies of a tenth to seven tenths lie within two fifths of it.
    Test: test_initial_guesses.py::test_what_swings_beside_the_machine_is_seen_in_the_residual"""
    spring_shares: tuple[float, ...] = (0.3, 0.6)
    """[of the machine's spring] Share that an effect which is a spring at first has taken over. Why: from either share
    the refit of a Bouc-Wen oscillator reaches its optimum, from none and from all of the spring it does not.
    Test: test_criteria_of_prediction.py::
    test_an_effect_in_the_place_of_a_spring_begins_with_a_quarter_to_three_quarters_of_it"""
    spectrum_points: int = 4
    """[points] Of a spectrum for each that the record resolves. Why: a peak between two is not missed.
    Test: test_initial_guesses.py::test_a_pulsation_is_found_to_an_eighth_of_what_the_record_resolves"""


@dataclass(frozen=True)
class FreeWidths:
    """When the widths of an effect are identified with its strength."""

    missed: float = 1.1
    """[ratio of errors] Of a refit over its prediction, above which it is begun again elsewhere; of rough refits with
    terms to the least, within which they are refined. Why: a prediction is a step towards an optimum, and a rough refit
    is that far off.
    Test: test_criteria_of_prediction.py::test_a_refit_keeps_its_prediction_within_a_tenth"""
    short_steps: int = 50_000
    """[simulation steps] Of all runs below which widths are free from the start and refits begin again. Why: a single
    test has a tenth of the samples of a test matrix, and determines the initial guesses less.
    Test: test_criteria_of_estimation.py::test_records_are_short_below_fifty_thousand_steps_of_eight_a_sample_at_most"""
    counted_steps: int = 8
    """[steps a sample] That count at most for a short record. Why: a base whose mass ended next to nothing asks for 32,
    and no model that explains the records does.
    Test: test_criteria_of_estimation.py::test_records_are_short_below_fifty_thousand_steps_of_eight_a_sample_at_most"""
    tried: int = 3
    """[effects] Refitted with free widths, the best predictions first. Why: each is refitted from several places;
    chosen by what it costs, and no measurement of it is kept.
    Test: test_criteria_of_prediction.py::test_three_effects_are_refitted_with_free_widths"""


@dataclass(frozen=True)
class Ranking:
    """How many candidates are refitted, on trial and to every sample."""

    contenders: int = 12
    """[candidates] Refitted on trial; of a large matrix two fewer for each effect of the model with a further one. Why:
    the best is usually among the first predictions, and each refit costs more the larger the model; chosen by what it
    costs, and no measurement of it is kept.
    Test: test_criteria_of_ranking.py::test_of_a_large_matrix_fewer_are_tried_the_larger_the_model"""
    quick_steps: int = 200_000
    """[simulation steps] Of all runs below which a matrix is quick. Why: every prediction and every finalist can then
    be tried.
    Test: test_criteria_of_estimation.py::test_a_matrix_is_quick_below_two_hundred_thousand_steps"""
    near_best: float = 1.3
    """[ratio of predicted errors] To the best, of a contender for a further effect. Why: a prediction is that far off.
    Test: test_criteria_of_ranking.py::test_a_further_effect_is_tried_where_it_promises_within_a_third_of_the_best"""
    finalists: int = 5
    """[candidates] Refitted to every sample, reported as soon as they are predicted, and tried two at a time. Why: the
    table shows the first five in full.
    Test: test_criteria_of_ranking.py::test_of_a_large_matrix_fewer_are_tried_the_larger_the_model"""
    close_trial: float = 1.05
    """[ratio of trial errors] To the best, up to which a candidate is a finalist, too; to the model with another lag or
    pair of lags in the place of which a trial is continued. Why: a trial takes only the beginnings of the records.
    Test: test_criteria_of_ranking.py::test_a_trial_in_the_place_of_an_effect_counts_within_five_per_cent"""
    multistart_finalists: int = 2
    """[finalists] Refitted from other strengths, too. Why: they decide what is added; chosen by what it costs, and no
    measurement of it is kept.
    Test: test_criteria_of_ranking.py::test_the_best_two_finalists_are_begun_again"""
    strong_starts: tuple[float, ...] = (1.0, 0.6, 0.3)
    """[of the largest strength] From which a refit begins, too. Why: a fit that lacks the effect may have gone far
    astray.
    Test: test_criteria_of_ranking.py::test_a_strong_effect_begins_within_a_factor_of_its_strength"""
    perturbed_starts: tuple[float, ...] = (0.5, 0.7, 1.4, 2.0)
    """[of the fitted strength] From which a refit begins, too. Why: play and stiction have optima nearby, one for each
    reversal.
    Test: test_criteria_of_ranking.py::test_optima_at_half_the_strength_and_at_twice_are_begun_from_nearby"""
    promising: float = 3e-3
    """[relative reduction] Of the score that is worth a refit. Why: three tenths of the share that is needed in the end
    (evidence.share).
    Test: test_criteria_of_ranking.py::
    test_a_prediction_is_worth_a_trial_where_it_reduces_the_error_by_three_in_a_thousand"""
    offset_gain: float = 3.0
    """[log-likelihood] Predicted gain of the runs' offsets that is worth a refit. Why: about the gain that the prior of
    an effect needs in the end.
    Test: test_criteria_of_ranking.py::test_a_prediction_is_worth_a_trial_where_the_offsets_gain_three_nats"""


@dataclass(frozen=True)
class CrossValidationFolds:
    """Stretches of records, or whole runs, that take turns in being left out of a fit."""

    folds: int = 4
    """[folds] A quarter of the runs is held out at a time. Why: the fit without a fold is close to the fit of all.
    Test: test_criteria_of_comparison.py::test_a_single_run_has_eight_stretches_and_many_runs_four_folds"""
    stretches: int = 8
    """[stretches] Of a single run, each held out in turn; half as many of each of two or three runs. Why: twice as many
    fits as for many runs, and each stretch is longer than the machine's memory.
    Test: test_criteria_of_comparison.py::test_a_single_run_has_eight_stretches_and_many_runs_four_folds"""
    max_step: float = 0.01
    """[of an axis] Step over which one linearisation is trusted. Why: an effect that acts in jumps is far from linear
    beyond.
    Test: test_criteria_of_comparison.py::test_one_linearisation_is_trusted_over_a_hundredth_of_an_axis"""
    longest_step: float = 0.1
    """[of an axis] Longest step of any parameter by one linearisation: in a fold, and from a fitted model to a
    prediction. Why: a parameter that the data do not determine would go to a bound.
    Test: test_criteria_of_comparison.py::test_a_long_step_is_tried_at_a_tenth_of_an_axis_and_at_shares_of_that"""
    step_shares: tuple[float, ...] = (1.0, 0.5, 0.2, 0.05)
    """[of the step] Shares of a step of a linearisation that are tried, in a fold until the other folds are explained
    better. Why: a linearisation may be too bold, each share is a simulation, and less than a twentieth moves nothing.
    Test: test_criteria_of_comparison.py::test_a_long_step_is_tried_at_a_tenth_of_an_axis_and_at_shares_of_that"""
    conditions_of_an_octave: float = 2.0
    """[steps] Of the size and the period of a command, by which tests are of one condition. Why: repetitions of a test
    differ by less, levels of a test matrix by more.
    Test: test_criteria_of_comparison.py::test_tests_whose_commands_differ_in_size_by_a_fifth_are_of_two_conditions"""


@dataclass(frozen=True)
class Equality:
    """When two models count as equal: the one that is listed first is taken."""

    tie: float = 1e-4
    """[relative difference] Of two errors that rounding may decide. Why: refits end within about a hundredth of it.
    Test: test_criteria_of_comparison.py::test_rounding_may_decide_on_a_ten_thousandth_of_an_error"""
    practically_equal: float = 1.02
    """[ratio of errors] Of two models that the data cannot tell apart, within which they tie; of a simpler model or
    term to the best, within which it is taken. Why: in a flat valley rounding decides where a refit ends, and less is
    no reason for another parameter.
    Test: test_criteria_of_comparison.py::test_models_that_the_data_cannot_tell_apart_tie_within_two_per_cent"""


@dataclass(frozen=True)
class Selection:
    """The search over sets of effects."""

    most: int = 6
    """[effects] Added at most. Why: a test matrix does not distinguish more.
    Test: test_criteria_of_ranking.py::test_more_than_six_effects_are_not_asked_for"""
    usual: int = 4
    """[effects] Added where the user says nothing. Why: machines of the trials lack up to three.
    Test: test_criteria_of_ranking.py::test_terms_are_searched_for_unless_a_small_limit_ended_the_selection"""
    exchanged: int = 3
    """[effects] Up to which each is compared with all others in its place every time. Why: to compare more takes long;
    chosen by what it costs, and no measurement of it is kept.
    Test: test_criteria_of_ranking.py::
    test_more_than_three_effects_are_compared_with_all_others_in_a_pass_of_their_own"""
    rounds: int = 3
    """[rounds] Of exchange, and of the wider search. Why: effects that are added and taken out in a circle come to an
    end.
    Test: test_criteria_of_ranking.py::test_a_pass_of_exchanges_ends_after_three_rounds"""
    global_restarts: int = 8
    """[effects] Of the first ranking started from the whole search space. Why: a local optimum far from the true one
    makes another effect look better.
    Test: test_criteria_of_ranking.py::test_the_eight_best_of_the_first_ranking_are_started_from_anywhere"""
    little_explained: float = 0.1
    """[1] Share of the explainable power that the selected effects leave, above which one effect is looked for from the
    whole search space. Why: effects that stand for a limit of a speed loop left a fifth to all of it, and effects that
    miss a part of the true ones, on six measured machines, less than a fourteenth; there it doubled the time.
    Test: test_criteria_of_ranking.py::test_a_search_that_left_a_tenth_of_the_power_begins_again"""
    companions: int = 2
    """[effects] That by themselves improve the model and worsen a part of the data, each of which is tried with all
    others. Why: each costs a ranking, and more than the leading ones seldom act.
    Test: test_criteria_of_ranking.py::test_two_effects_that_worsen_a_part_are_tried_with_all_others"""
    runners_up: int = 2
    """[sets] Of as many effects as were selected, from which the search continues where it ends above the noise floor.
    Why: each costs a ranking, and where one lag imitates two, either of the two leads to both.
    Test: test_criteria_of_ranking.py::test_the_search_continues_from_the_two_next_best_sets"""


@dataclass(frozen=True)
class Verification:
    """The comparison on validation data."""

    deviations: float = 2.0
    """[standard errors] Rise of the validation error that contradicts an effect; and the shortfall of its fall at which
    validation data show nothing of an effect. Why: one in 40 by chance, and it only takes away the word found, or the
    last name.
    Test: test_criteria_of_comparison.py::test_an_effect_is_contradicted_where_the_error_rises_by_two_standard_errors"""
    rise: float = 1.1
    """[ratio of validation errors] Of the last model to the best on the path, from which on it is reported. Why: less
    is a matter of chance.
    Test: test_criteria_of_comparison.py::test_a_smaller_error_on_the_way_is_told_where_the_last_is_a_tenth_larger"""


@dataclass(frozen=True)
class LabelChecks:
    """Runs whose label does not fit their data."""

    outlier: float = 5.0
    """[robust standard deviations] Of the runs' errors beyond which a run is checked. Why: one in two million by
    chance.
    Test: test_criteria_of_labels.py::test_a_run_is_checked_where_its_error_is_five_deviations_above_the_usual"""
    least_excess: float = 1.15
    """[ratio of errors] Least ratio to the usual error, whatever the deviations are. Why: runs differ by some per cent
    anyway.
    Test: test_criteria_of_labels.py::test_a_run_is_checked_where_its_error_is_a_seventh_above_the_usual"""
    explained: float = 0.5
    """[of the excess power] Share that a changed label has to remove. Why: otherwise the label is not the cause.
    Test: test_criteria_of_labels.py::test_a_label_is_doubted_where_another_removes_half_of_the_excess"""
    factors: tuple[float, ...] = (0.1, 0.2, 0.33, 0.5, 0.67, 0.8, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0, 5.0, 10.0)
    """[of the stated value] Tried on a label. Why: from a tenth to ten times.
    Test: test_criteria_of_labels.py::test_a_value_from_a_tenth_to_ten_times_is_found"""
    most: float = 0.2
    """[of the runs] Most that may be outliers. Why: where more are, their labels are not the cause.
    Test: test_criteria_of_labels.py::test_where_more_than_a_fifth_of_the_runs_stand_out_no_label_is_doubted"""
    fewest_runs: int = 5
    """[runs] Least number for which labels are checked. Why: the scatter of fewer is not known.
    Test: test_criteria_of_labels.py::test_the_labels_of_four_runs_are_not_checked"""
    shift_rounds: int = 5
    """[rounds] Of Gauss-Newton on the shift of a channel. Why: it converges within three.
    Test: test_criteria_of_labels.py::test_a_record_that_is_late_by_a_third_of_its_memory_is_found_to_be_so"""


@dataclass(frozen=True)
class RunConsistency:
    """When the values that runs alone give of a parameter disagree."""

    most_runs: int = 12
    """[runs] Up to which the model is refitted to each alone. Why: each costs a refit; with more runs whole runs are
    held out in turn, so that evidence and standard errors hold between runs.
    Test: test_criteria_of_comparison.py::test_up_to_twelve_runs_are_fitted_alone"""
    chance: float = 1e-3
    """[probability] That runs of one machine disagree in any parameter. Why: the sentence sends a user to the test rig.
    Test: test_criteria_of_comparison.py::test_two_runs_differ_by_a_third_and_beyond_a_chance_of_one_in_a_thousand"""
    ratio: float = 1.3
    """[ratio] Of the largest value to the least, at least. Why: oil and windings that warm up make less of it.
    Test: test_criteria_of_comparison.py::test_two_runs_differ_by_a_third_and_beyond_a_chance_of_one_in_a_thousand"""


@dataclass(frozen=True)
class Conclusion:
    """What a report says, and which models it says are in question."""

    competing: int = 3
    """[models] That the next run is to distinguish, and explanations by another machine that are named. Why: more make
    no better experiment, and a sentence has room for no more.
    Test: test_criteria_of_comparison.py::test_the_next_run_is_to_distinguish_three_models"""
    simpler_terms: float = 1.05
    """[ratio of errors] Up to which terms alone come before terms in addition to the added effects. Why: they need one
    effect less.
    Test: test_criteria_of_comparison.py::test_terms_alone_come_first_up_to_an_error_five_per_cent_larger"""
    half_sample: float = 0.1
    """[sample intervals] Around half of one, within which the delay of a command may be that of a command that was
    held. Why: what else is in the machine moves the delay a little; a machine's own delay is seldom there.
    Test: test_held_commands.py::test_a_delay_of_half_a_sample_may_be_a_command_that_was_held"""


@dataclass(frozen=True)
class Criteria:
    """All criteria, a section for each stage."""

    estimation: Estimation = Estimation()
    noise: Noise = Noise()
    structure: StructureSelection = StructureSelection()
    screening: Screening = Screening()
    initial_guesses: InitialGuesses = InitialGuesses()
    free_widths: FreeWidths = FreeWidths()
    ranking: Ranking = Ranking()
    cross_validation: CrossValidationFolds = CrossValidationFolds()
    evidence: EvidenceCriteria = EVIDENCE_CRITERIA
    equality: Equality = Equality()
    selection: Selection = Selection()
    verification: Verification = Verification()
    labels: LabelChecks = LabelChecks()
    consistency: RunConsistency = RunConsistency()
    conclusion: Conclusion = Conclusion()
    discovery: Discovery = Discovery()
    terms: TermShapes = TermShapes()


CRITERIA = Criteria()
"""The criteria of a diagnosis."""
