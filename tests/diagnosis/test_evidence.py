"""The one comparison of two models, on residuals whose truth is known. Seeds stand in each test."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

from ident.diagnosis.evidence.chance import bar
from ident.diagnosis.evidence.comparison import Residuals, common_disturbance, compare
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, OF_SHOWN, EvidenceCriteria
from ident.diagnosis.evidence.disturbance import Disturbance
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.diagnosis.evidence.evidence import SPANS, BlockMean, Evidence
from ident.diagnosis.evidence.probability import NOTHING, SetGains, probabilities, structure_probabilities
from ident.diagnosis.evidence.rule import generalises, improves_on_the_whole, worth_adding
from ident.diagnosis.evidence.separation import both_probable, dominated, indistinguishable

Array = NDArray[np.float64]
NOISE = 0.01  # of the output's deviation
WHITE = Record(1.0, floor=NOISE**2)


def common(bands: EnergyBands, models: Sequence[Sequence[Array]]) -> Disturbance:
    """The spectrum common to models by their residuals, the first of them without any effect."""
    return common_disturbance([Residuals(tuple(residuals), bands) for residuals in models])


def compared(
    before: Sequence[Array],
    after: Sequence[Array],
    records: Sequence[Record],
    spectrum: Disturbance | None = None,
    criteria: EvidenceCriteria = EVIDENCE_CRITERIA,
) -> Evidence:
    """Two models by their residuals of each run."""
    bands = spectrum.bands if spectrum else EnergyBands(tuple(records), tuple(map(len, before)), criteria)
    return compare(Residuals(tuple(before), bands), Residuals(tuple(after), bands), spectrum, criteria)


def white(rng: np.random.Generator, n: int) -> Array:
    """Measurement noise."""
    return NOISE * rng.standard_normal(n)


def slow(rng: np.random.Generator, n: int, keeps: float = 0.9) -> Array:
    """A signal of power 1 that remembers: AR(1)."""
    steps = np.sqrt(1 - keeps**2) * rng.standard_normal(n)
    found: Array = lfilter([1.0], [1.0, -keeps], steps, zi=[keeps * rng.standard_normal()])[0]
    return found


def periodic(periods: int, missing: float, left: float = 0.0, per: float = 87.3, seed: int = 1) -> tuple[Array, Array]:
    """Residuals of a test of so many periods: of a model that lacks a square wave, and of one that has most of it.

    The second one leaves the square wave's third harmonic, `left` times as strong.
    """
    rng = np.random.default_rng(seed)
    phase = 2 * np.pi * np.arange(int(periods * per)) / per
    lacking = missing * np.sum([np.sin(h * phase) / h for h in (3, 5, 7, 9)], axis=0)
    rest = left * missing * np.sin(3 * phase) / 3
    noise = white(rng, len(phase))
    return lacking + noise, rest + noise


def screened(residual: Array, columns: Array) -> Array:
    """What the best of columns (n, k) leaves of a residual, as a search would choose it."""
    unit = columns / np.linalg.norm(columns, axis=0)
    shares = unit.T @ residual
    best = int(np.argmax(np.abs(shares)))
    return np.asarray(residual - shares[best] * unit[:, best])


def test_five_periods_and_a_hundred_give_the_same_evidence_against_a_wrong_model() -> None:
    """A model that leaves structural error is judged alike; one that leaves only noise gains by the logarithm alone."""
    record = (Record(1.0, period=87.3),)
    wrong, right = {}, {}
    for periods in (5, 100):
        before, after = periodic(periods, 0.2, left=0.5)
        bands = EnergyBands(record, (len(before),))
        true = periodic(periods, 0.2)[1]
        spectrum = common(bands, [[before], [after], [true]])
        wrong[periods] = compared([before], [after], record, spectrum)
        right[periods] = compared([before], [true], record, spectrum)
    assert wrong[100].gain == pytest.approx(wrong[5].gain, rel=0.1)
    assert wrong[100].share.mean == pytest.approx(wrong[5].share.mean, abs=0.02)
    assert wrong[5].gain < right[5].gain < right[100].gain < 1.5 * right[5].gain
    few, many = (_said(wrong[periods], right[periods]) for periods in (5, 100))
    assert many == pytest.approx(few, abs=0.03)


def _said(wrong: Evidence, right: Evidence) -> dict[str, float]:
    """The probabilities of a wrong effect and a right one."""
    found = probabilities(gaining(right.most, a=wrong.gain, b=right.gain))
    return {**found.effects, "unlisted": found.unlisted, "nothing": found.nothing}


def test_a_period_that_is_no_whole_number_of_samples_is_no_noise() -> None:
    """The floor of a periodic test is what does not repeat, wherever the samples fall; seed 1."""
    before, _ = periodic(20, 0.2)
    bands = EnergyBands((Record(1.0, period=87.3),), (len(before),))
    assert np.sqrt(common(bands, [[before]]).floors[0]) == pytest.approx(NOISE, rel=0.05)
    assert bands.energies([before]).sum() == pytest.approx(before @ before)


def test_a_hundred_times_the_samples_are_no_hundred_times_the_evidence() -> None:
    """Of white residuals that fall by 5 % in every band it grows with the octaves, not with the samples; seed 2."""
    rng = np.random.default_rng(2)
    gains = []
    for n in (1000, 100_000):
        before = white(rng, n)
        gains.append(compared([before], [0.95 * before], [Record(1.0)]).gain)
    assert gains[1] < 2.0 * gains[0]


def test_what_lies_in_a_few_lines_is_not_lost_among_those_of_a_long_record() -> None:
    """Every band says as much as it has to say, not as many samples as it has; seed 17."""
    rng = np.random.default_rng(17)
    noise = white(rng, 100_000)
    slowly = NOISE * np.sin(2 * np.pi * 30 * np.arange(len(noise)) / len(noise))
    assert compared([noise + slowly], [noise], [WHITE]).gain > 60


def test_bands_are_a_quarter_of_an_octave_and_have_eight_degrees_of_freedom_at_least() -> None:
    """But for the mean, which has one; all of them have as many as there are samples."""
    bands = EnergyBands((Record(1.0),), (4096,))
    assert bands.degrees.sum() == pytest.approx(4096)
    assert 8 <= bands.degrees[1:-1].min() <= 10
    widths = bands.degrees[20:-1]
    assert widths[1:] / widths[:-1] == pytest.approx(2**0.25, rel=0.1)


def test_a_test_that_is_cut_in_two_is_one_test() -> None:
    """Repetitions of a condition add no evidence, other conditions do; unequal runs; seed 3."""
    before, after = periodic(40, 0.2, left=0.5, seed=3)
    first = int(15 * 87.3)
    parts = [[side[:first], side[first:]] for side in (before, after)]
    whole = compared([before], [after], [Record(1.0, "sine", 87.3)])
    cut = compared(parts[0], parts[1], [Record(1.0, "sine", 87.3)] * 2)
    other = compared(parts[0], parts[1], [Record(1.0, "small", 87.3), Record(1.0, "large", 87.3)])
    assert cut.gain == pytest.approx(whole.gain, rel=0.25)
    assert other.gain > 1.2 * whole.gain


@pytest.mark.parametrize("colour", [0.0, 0.9])
def test_the_bar_is_passed_by_chance_as_often_as_it_says(colour: float, full: bool) -> None:
    """The best of thirty columns fitted to noise passes in about one of twenty; seeds 100 and up."""
    count, n, passed = (1000 if full else 20), 200, 0
    criteria = replace(EVIDENCE_CRITERIA, surrogates=EVIDENCE_CRITERIA.surrogates if full else 100)
    bands = EnergyBands((Record(1.0),), (n,), criteria)
    for seed in range(100, 100 + count):
        rng = np.random.default_rng(seed)
        columns = np.array([slow(rng, n, 0.8) for _ in range(30)]).T
        before = NOISE * slow(rng, n, colour)
        after = screened(before, columns)
        spectrum = common(bands, [[before], [after]])
        limit = bar([before], [np.empty((n, 0))], [columns], spectrum, seed)
        passed += spectrum.gain(bands.energies([before]), bands.energies([after])) > limit
    assert passed <= count * 0.05 + 3 * np.sqrt(count * 0.05)


def test_the_bar_hardly_hangs_on_the_random_phases() -> None:
    """The bars of eight seeds scatter by less than a tenth; seeds 0 to 7."""
    rng, n = np.random.default_rng(18), 200
    columns, before = np.array([slow(rng, n, 0.8) for _ in range(30)]).T, white(rng, n)
    spectrum = common(EnergyBands((WHITE,), (n,)), [[before], [before]])
    bars = [bar([before], [np.empty((n, 0))], [columns], spectrum, seed) for seed in range(8)]
    assert np.std(bars) < 0.1 * np.mean(bars)


def test_an_effect_worth_three_deviations_above_the_floor_is_found_among_thirty(full: bool) -> None:
    """d² = 60 and 1.1 times the floor: found nearly always, and by a share that matters; seeds 500 and up."""
    count, n, found = (400 if full else 12), 300, 0
    for seed in range(500, 500 + count):
        rng = np.random.default_rng(seed)
        columns = np.array([slow(rng, n, 0.8) for _ in range(30)]).T
        hidden = np.sqrt(75.0) * NOISE * columns[:, 0] / np.linalg.norm(columns[:, 0])
        noise = white(rng, n)
        bands = EnergyBands((WHITE,), (n,))
        spectrum = common(bands, [[hidden + noise], [noise]])
        evidence = compared([hidden + noise], [noise], [WHITE], spectrum)
        limit = bar([hidden + noise], [np.empty((n, 0))], [columns], spectrum, seed)
        found += improves_on_the_whole(evidence, lambda limit=limit: limit)
    assert found >= 0.93 * count


def test_what_a_drift_adds_to_both_models_takes_no_evidence_away() -> None:
    """A drift of ten times the noise that neither model has leaves most of the gain of what one of them has; seed 5."""
    rng = np.random.default_rng(5)
    n = 2000
    missing = 2 * NOISE * slow(rng, n, 0.5)
    noise, drift = white(rng, n), 10 * NOISE * np.sin(np.linspace(0, 3, n))
    without = compared([missing + noise], [noise], [Record(1.0)])
    with_it = compared([missing + noise + drift], [noise + drift], [Record(1.0)])
    assert with_it.gain > 0.6 * without.gain


def test_a_model_that_explains_most_gains_though_its_kinks_reach_into_empty_bands() -> None:
    """A tenth of the power left in kinks, over bands that held nothing before, is a gain; seed 6."""
    rng = np.random.default_rng(6)
    t = np.arange(1800) / 100.0
    before = 0.28 * np.sin(2 * np.pi * t)
    kinks = 0.28 * np.sign(rng.random(len(t)) - 0.5) / np.sqrt(20)
    noise = 0.0005 * rng.standard_normal(len(t))
    record = [Record(1.0, floor=0.0005**2)]
    evidence = compared([before + noise], [kinks + noise], record)
    assert evidence.share.mean > 0.85
    assert evidence.gain > 0
    without = replace(EVIDENCE_CRITERIA, tolerance=0.0)
    assert compared([before + noise], [kinks + noise], record, criteria=without).gain < 0


def test_a_true_effect_is_told_from_one_that_leaves_a_quarter_of_a_harmonic() -> None:
    """The least level of the disturbance does not hide what tells relatives apart; seed 1."""
    (lacking, most), (_, all_of_it) = periodic(20, 0.2, left=0.5), periodic(20, 0.2)
    record = (Record(1.0, period=87.3),)
    spectrum = common(EnergyBands(record, (len(lacking),)), [[lacking], [most], [all_of_it]])
    gains = [compared([lacking], [after], record, spectrum).gain for after in (most, all_of_it)]
    assert gains[1] > 2.2 * gains[0]


def test_a_gain_of_less_than_a_hundredth_of_the_explainable_power_does_not_improve() -> None:
    """However certain: structural error makes every stretch agree; seed 7."""
    for left, expected in ((0.999, False), (0.5, True)):
        before, _ = periodic(100, 0.2, seed=7)
        noise = periodic(100, 0.0, seed=7)[0]
        after = left * (before - noise) + noise
        evidence = compared([before], [after], [Record(1.0, period=87.3)])
        assert evidence.difference.above(0.0, EVIDENCE_CRITERIA)
        assert improves_on_the_whole(evidence, lambda: 0.0) is expected


def test_an_effect_that_moves_the_means_of_the_runs_alone_matters() -> None:
    """A bias shows in nothing else. Means that nothing explains hide no effect on the waveform; seed 19."""
    rng = np.random.default_rng(19)
    noise = [white(rng, 400) for _ in range(6)]
    bands = EnergyBands(tuple(replace(WHITE, condition=run) for run in range(6)), (400,) * 6)
    means = rng.standard_normal(6) - 0.1
    plain = Residuals(tuple(noise), bands, np.zeros(6))
    moved = [Residuals(tuple(noise), bands, size * means) for size in (1e-4, 0.02)]
    assert [improves_on_the_whole(compare(one, plain), lambda: 5.0) for one in moved] == [False, True]
    assert [indistinguishable(compare(one, plain)) for one in moved] == [True, False]
    lacking = tuple(r + 5 * NOISE * slow(rng, 400) for r in noise)
    before, after = (Residuals(series, bands, 3.0 * means) for series in (lacking, tuple(noise)))
    assert improves_on_the_whole(compare(before, after), lambda: 5.0)


def test_what_noise_leaves_of_the_means_is_not_to_be_gained() -> None:
    """A bias that explains them but for that is no stand-in for something unlisted: noise of 5 %; seeds 20 to 25."""
    record, unlisted = replace(WHITE, floor=(5 * NOISE) ** 2), []
    bands = EnergyBands(tuple(replace(record, condition=run) for run in range(27)), (900,) * 27)
    for seed in range(20, 26):
        rng = np.random.default_rng(seed)
        noise = [5 * white(rng, 900) for _ in range(27)]
        left, series = np.array([r.mean() for r in noise]), tuple(r - r.mean() for r in noise)
        assert np.sqrt(np.mean(left**2)) > 3 * EVIDENCE_CRITERIA.level
        before = Residuals(series, bands, left + 0.05 * rng.standard_normal(27))
        evidence = compare(before, Residuals(series, bands, left))
        unlisted.append(probabilities(gaining(evidence.most, a=evidence.gain)).unlisted)
    assert np.median(unlisted) < 0.05
    assert max(unlisted) < 0.3


def test_what_only_one_of_many_runs_asks_for_does_not_improve() -> None:
    """Whole runs are the blocks where there are several: the mean stays within its error; seed 9."""
    rng = np.random.default_rng(9)
    noise = [white(rng, 400) for _ in range(8)]
    one = [noise[0] + 5 * NOISE * slow(rng, 400), *noise[1:]]
    all_of_them = [r + 5 * NOISE * slow(rng, 400) for r in noise]
    records = [replace(WHITE, condition=i) for i in range(8)]
    assert not improves_on_the_whole(compared(one, noise, records), lambda: 5.0)
    assert improves_on_the_whole(compared(all_of_them, noise, records), lambda: 5.0)


def test_what_helps_one_condition_and_harms_another_does_not_generalise() -> None:
    """A condition that loses beyond its error is enough, and so is a half of the record; seed 10."""
    rng = np.random.default_rng(10)
    noise = [white(rng, 1500) for _ in range(2)]
    wrong = [5 * NOISE * slow(rng, 1500) for _ in range(2)]
    records = [replace(WHITE, condition="small"), replace(WHITE, condition="large")]
    before = [noise[0] + 2 * wrong[0], noise[1]]
    after = [noise[0], noise[1] + wrong[1]]
    assert generalises(compared(before, noise, records))
    evidence = compared(before, after, records)
    assert evidence.after < evidence.before
    assert not generalises(evidence)
    late = [np.concatenate([np.zeros(750), r[750:]]) for r in wrong]
    early = [2 * np.concatenate([r[:750], np.zeros(750)]) for r in wrong]
    one = [replace(WHITE, condition="")] * 2
    assert not generalises(
        compared(
            [n + e for n, e in zip(noise, early, strict=True)], [n + e for n, e in zip(noise, late, strict=True)], one
        )
    )


def test_two_models_whose_outputs_the_noise_hides_are_indistinguishable() -> None:
    """Outputs four deviations apart in all are alike, ten are not; seed 11."""
    rng = np.random.default_rng(11)
    noise, apart = white(rng, 2000), slow(rng, 2000)
    apart *= NOISE / np.linalg.norm(apart)
    for size, expected in ((4.0, True), (10.0, False)):
        assert indistinguishable(compared([noise], [noise + size * apart], [WHITE])) is expected


def test_two_models_of_which_one_is_improbable_are_told_apart_however_large_the_error_of_their_difference() -> None:
    """One of four runs alone sets them apart, each output near the other beside what both leave; seed 13."""
    rng = np.random.default_rng(13)
    noise = [white(rng, 1500) for _ in range(4)]
    rest = [40 * NOISE * np.sin(0.01 * np.arange(1500)) for _ in noise]  # of one line: what is apart lies elsewhere
    records = [replace(WHITE, condition="")] * 4
    for size, expected in ((1.0, True), (12.0, False)):
        moved = [noise[0] + size * slow(rng, 1500) * NOISE, *noise[1:]]
        before, after = ([left + one for left, one in zip(rest, side, strict=True)] for side in (noise, moved))
        evidence = compared(before, after, records)
        assert evidence.apart <= EVIDENCE_CRITERIA.separation * evidence.explainable
        assert not evidence.difference.below(0.0, EVIDENCE_CRITERIA)
        assert both_probable(evidence) is expected
        assert indistinguishable(evidence) is expected


def test_two_models_that_leave_as_much_but_look_different_are_told_apart() -> None:
    """Neither is the other: equal errors are no equal outputs, but near to each other beside a large rest they are."""
    before, _ = periodic(30, 0.3, seed=12)
    mirrored = before[::-1].copy()
    assert not indistinguishable(compared([before], [mirrored], [Record(1.0, period=87.3)]))
    phase = 2 * np.pi * np.arange(len(before)) / 87.3
    near = before + 0.025 * np.sin(4 * phase)  # a harmonic that neither lacks: it adds power to one alone
    evidence = compared([before], [near], [Record(1.0, period=87.3)])
    assert evidence.apart < EVIDENCE_CRITERIA.separation * evidence.explainable
    assert not indistinguishable(evidence)
    here, there = (np.sin(3 * phase) + side * 0.1 * np.cos(3 * phase) for side in (1, -1))
    noise = periodic(30, 0.0, seed=12)[0]
    assert indistinguishable(compared([here + noise], [there + noise], [Record(1.0, period=87.3)]))
    here, there = (np.sin(3 * phase) + side * 0.2 * np.cos(3 * phase) for side in (1, -1))
    assert not indistinguishable(compared([here + noise], [there + noise], [Record(1.0, period=87.3)]))


def test_a_member_that_is_worse_beyond_its_error_is_dominated() -> None:
    """Twice the structural error is, equal ones are not; seed 13."""
    before, after = periodic(30, 0.3, left=0.5, seed=13)
    record = [Record(1.0, period=87.3)]
    assert dominated(compared([after], [before], record))
    assert not dominated(compared([before], [after], record))
    assert not dominated(compared([before], [before.copy()], record))


def gaining(most: float, **gains: float) -> SetGains:
    """Models that are named by the letters of their effects; `most` is what can be gained."""
    return SetGains({NOTHING: 0.0, **{frozenset(name): gain for name, gain in gains.items()}}, most)


def test_an_effect_is_added_where_it_improves_and_generalises_alone() -> None:
    """What gains half of all that can be gained passes whatever the bar, and loses in no span of the records."""
    before, after = periodic(30, 0.3, seed=13)
    found = compared([before], [after], [Record(1.0, period=87.3)])
    assert worth_adding(found)
    loses = {**found.parts, [*SPANS][-1]: BlockMean(-0.5 * found.explainable, 1e-9, 20)}
    assert not worth_adding(replace(found, by_part=lambda: loses))
    little = replace(found, gain=0.2 * found.most, without=0.2 * found.most)
    assert not worth_adding(little)
    assert worth_adding(little, lambda: 0.1 * found.most)


def test_a_gain_below_the_least_adds_nothing_however_low_the_bar() -> None:
    before, after = periodic(30, 0.3, seed=13)
    found = compared([before], [after], [Record(1.0, period=87.3)])
    for gain, added in ((3.3, False), (3.5, True)):
        assert worth_adding(replace(found, gain=gain, without=gain), lambda: 0.0) == added


def test_what_the_records_show_has_to_gain_no_more_than_chance_does() -> None:
    before, after = periodic(30, 0.3, seed=13)
    found = compared([before], [after], [Record(1.0, period=87.3)])
    for gain, added in ((1.9, False), (2.1, True)):
        least = replace(found, gain=gain, without=gain, most=100.0)
        assert worth_adding(least, lambda: 2.0, OF_SHOWN) == added


def test_a_floor_above_what_is_left_is_no_floor() -> None:
    """One that was told too large hides neither what an effect takes nor how sure that is; seed 20."""
    noise = white(np.random.default_rng(20), 500)
    bands = EnergyBands((Record(1.0, floor=100 * NOISE**2),), (500,))
    assert Residuals((noise,), bands).floors == pytest.approx([np.mean(noise**2)])


def test_no_member_is_dominated_whose_output_the_noise_hides() -> None:
    """However sure the difference of the errors is."""
    before, after = periodic(30, 0.3, left=0.5, seed=13)
    worse = compared([after], [before], [Record(1.0, period=87.3)])
    assert dominated(worse)
    assert not dominated(replace(worse, resolved=2.0 * worse.apart))


def test_a_gain_that_is_not_worth_the_prior_of_an_effect_does_not_improve() -> None:
    """However little is left to be gained, and however low the bar."""
    noise = white(np.random.default_rng(15), 500)
    plain = compared([noise], [noise], [WHITE])
    near = replace(plain, gain=1.0, without=1.0, most=1.0, share=BlockMean(0.5, 0.01, 20))
    assert not improves_on_the_whole(near, lambda: 0.0)
    more = replace(near, gain=5.0, without=5.0, most=20.0)
    assert improves_on_the_whole(more, lambda: 4.9)
    assert not improves_on_the_whole(more, lambda: 5.1)
    assert improves_on_the_whole(replace(more, most=9.0), lambda: 5.1)


def test_probabilities_are_those_of_the_models_and_sum_to_one() -> None:
    """A name has the probability of all sets that hold it; what gains most is most probable."""
    found = probabilities(gaining(95.0, a=92.0, b=60.0, ab=93.0))
    assert sum(found.alone.values()) + found.unlisted == pytest.approx(1.0)
    assert max(found.alone, key=lambda of: found.alone[of]) == frozenset("a")
    held = (of[names] for of in (found.alone, found.with_unlisted) for names in (frozenset("a"), frozenset("ab")))
    assert found.effects["a"] == pytest.approx(sum(held))
    assert found.of(["a", "b"]) < found.of(["a"]) < found.of(["ab"]) <= 1.0
    assert found.of(["ab", "ab"]) == pytest.approx(found.of(["a", "b"]))
    assert found.effects["a"] > 0.9
    assert probabilities(gaining(1.0, a=0.5)).nothing > 0.9
    assert probabilities(gaining(100.0, a=30.0)).unlisted > 0.95
    with pytest.raises(ValueError, match="without any effect"):
        probabilities(SetGains({frozenset("a"): 1.0}, 1.0))


def test_of_two_structures_that_explain_as_much_the_one_with_fewer_parameters_is_more_probable() -> None:
    """Each parameter is charged as an effect is; what gains more than that is more probable."""
    assert structure_probabilities([10.0, 10.0], [3, 5], [1.0, 1.0])[0] > 0.8
    assert structure_probabilities([0.0, 10.0], [3, 5], [1.0, 1.0])[1] > 0.65
    assert sum(structure_probabilities([0.0, 4.0, 5.0], [1, 2, 3], [1.0, 0.5, 1.0])) == pytest.approx(1.0)


def test_several_effects_that_leave_only_noise_do_not_lose_to_something_unlisted() -> None:
    """Three that gain all of 300 nats, each a hundred, are more probable than one thing that nobody lists."""
    found = probabilities(gaining(300.0, a=100.0, ab=200.0, abc=299.0))
    assert found.of(["a", "b", "c"]) > 0.9
    assert found.unlisted < 0.1


def test_probabilities_are_frozen() -> None:
    """What was fitted to the training seeds of docs/decisions/evidence.md: the numbers give these probabilities."""
    found = probabilities(gaining(24.0, a=21.0, b=18.0))
    assert (found.effects["a"], found.effects["b"], found.unlisted, found.nothing) == pytest.approx(FROZEN, abs=5e-4)


FROZEN = (0.3728, 0.1859, 0.0798, 0.3834)


def test_what_reaches_the_noise_passes_where_one_harmonic_is_all_there_is() -> None:
    """Random phases of one harmonic are met by one of two candidates as often as not, which is no reason to refuse."""
    n, per = 1800, 90.0
    phase = 2 * np.pi * np.arange(n) / per
    noise = white(np.random.default_rng(16), n)
    missing = 0.02 * np.sin(3 * phase)
    columns = np.column_stack([np.sin(3 * phase), np.cos(3 * phase)])
    record = [Record(1.0, period=per)]
    spectrum = common(EnergyBands(tuple(record), (n,)), [[missing + noise], [noise]])
    limit = bar([missing + noise], [np.empty((n, 0))], [columns], spectrum)
    evidence = compared([missing + noise], [noise], record, spectrum)
    assert evidence.gain < 1.2 * limit
    assert improves_on_the_whole(evidence, lambda: 2 * limit)


def test_an_error_within_two_per_cent_of_the_floor_leaves_nothing_to_gain() -> None:
    """However many samples there are: the floor is not known nearer; seed 14."""
    rng = np.random.default_rng(14)
    residual = [white(rng, 20_000)]
    for error, expected in ((1.015, True), (1.08, False)):
        worse = [error * residual[0]]
        evidence = compared(worse, worse, [WHITE])
        assert (evidence.most < 2.0) is expected


def test_what_does_not_go_together_is_refused() -> None:
    """Residuals of other runs than the records, or a run that does not move, are an error of the caller."""
    with pytest.raises(ValueError, match="2 records"):
        compared([np.ones(9)], [np.ones(9)], [WHITE, WHITE])
    with pytest.raises(ValueError, match="no power"):
        compared([np.ones(9)], [np.ones(9)], [Record(0.0)])


def test_models_that_leave_nothing_are_equal() -> None:
    """Exact fits of noise-free records divide by nothing."""
    nothing = np.zeros(500)
    evidence: Evidence = compared([nothing], [nothing], [Record(1.0)])
    assert evidence.gain == 0.0
    assert not improves_on_the_whole(evidence, lambda: 0.0)
