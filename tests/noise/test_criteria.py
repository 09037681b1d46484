"""Each number that decides how much of a record is noise decides a case that lies within a third of it."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

from ident.noise.autoregression import prediction_errors
from ident.noise.effective_sample_size import independent_samples
from ident.noise.floor import like_transducer, noise_floor, noise_floors
from ident.noise.own_periods import own_repeats, period
from ident.noise.periodic import fundamental, periodic_noise
from ident.noise.repeats import Repeat, at_rest, repeated
from ident.run import Run

RATE = 1000.0
EDGE = np.pi * RATE  # rad/s: the Nyquist frequency


def white(samples: int, seed: int = 0) -> np.ndarray:
    """Noise of deviation 1."""
    return np.random.default_rng([61, seed]).standard_normal(samples)


def run(name: str, command: np.ndarray, measured: np.ndarray) -> Run:
    """A record at 1 kHz."""
    return Run(name, "", RATE, {"command": command, "displacement": measured}, {"displacement": "m"})


@pytest.mark.parametrize(("samples", "order"), [(4000, 32), (320, 32), (250, 25), (9, 0)])
def test_a_sample_is_predicted_from_the_32_before_it_or_a_tenth_of_the_record(samples, order):
    """What is not predicted yet is zero."""
    assert np.flatnonzero(np.append(prediction_errors(white(samples)), 1.0))[0] in (order, samples)


@pytest.mark.parametrize(("lag", "share"), [(0.24, 1 / 1.5), (0.26, 1.0)])
def test_a_residual_that_repeats_itself_after_less_than_a_quarter_of_the_record_tells_less(lag, share):
    """Two equal strokes: at their distance, the only lag with a correlation, it is one half."""
    residual = np.zeros(1000)
    residual[[100, 100 + int(1000 * lag)]] = 1.0
    assert independent_samples(residual) == pytest.approx(1000 * share, rel=0.03)


@pytest.mark.parametrize(("edge", "told"), [(0.48, True), (0.52, False)])
def test_a_spectrum_shows_the_noise_where_a_fifth_of_it_is_free_of_the_command(edge, told):
    """1.6 times the edge of the band is 0.77 and 0.83 of the Nyquist frequency."""
    assert (noise_floor(run("r", white(1000), white(1000)), edge * EDGE) is not None) is told


@pytest.mark.parametrize(("at", "seen"), [(0.9775, True), (0.9825, False)])
def test_the_last_two_per_cent_of_the_spectrum_show_no_noise(at, seen):
    n = np.arange(8192)
    line = np.sin(np.pi * at * n)
    told = noise_floor(run("r", white(8192), line + 0.001 * white(8192, 1)), 0.1 * EDGE)
    assert (told > 0.1) is seen


@pytest.mark.parametrize(("samples", "told"), [(240, False), (260, True)])
def test_a_record_of_fewer_than_256_samples_tells_no_noise(samples, told):
    assert (noise_floor(run("r", white(samples), white(samples)), 0.1 * EDGE) is not None) is told


def test_a_long_record_has_the_mean_power_of_windows_of_8192_samples():
    """As SciPy finds it with such windows, to rounding; with others it is another estimate."""
    measured = white(40_000)
    frequency, power = scipy.signal.welch(measured, RATE, nperseg=8192)
    told = noise_floor(run("r", white(40_000, 1), measured), 0.1 * EDGE)
    upper = (frequency > RATE / 4) & (frequency < 0.98 * RATE / 2)
    assert told * np.std(measured) == pytest.approx(np.sqrt(power[upper].mean() * RATE / 2), rel=1e-9)


@pytest.mark.parametrize(
    ("count", "spread", "told"), [(2, 1.0, False), (3, 1.0, True), (3, 0.017, False), (3, 0.023, True)]
)
def test_whether_noise_grows_with_a_record_is_told_of_three_records_that_differ_by_two_per_cent(count, spread, told):
    sizes = np.linspace(-1.0, 1.0, count)
    sizes = np.exp(sizes / sizes.std() * spread)
    assert like_transducer(sizes, [0.01] * count) is (False if told else None)


def cycles(periods: float, samples_of_a_period: float, third: float = 0.0) -> np.ndarray:
    """A sine, with a third harmonic of this size."""
    phase = 2 * np.pi * (np.arange(round(periods * samples_of_a_period)) / samples_of_a_period + 0.1)
    return np.sin(phase) + third * np.sin(3 * phase)


@pytest.mark.parametrize(
    ("periods", "samples", "told"), [(4.0, 50.0, True), (3.0, 50.0, False), (50.0, 4.5, True), (50.0, 3.6, False)]
)
def test_a_command_is_periodic_from_four_periods_and_four_samples_a_period_on(periods, samples, told):
    assert (fundamental(cycles(periods, samples), 1.0) is not None) is told


@pytest.mark.parametrize(("share", "told"), [(0.55, True), (0.45, False)])
def test_the_highest_line_of_a_periodic_command_has_half_of_its_power(share, told):
    """The third harmonic, and the ninth with it, have the rest in equal parts."""
    phase = 2 * np.pi * np.arange(4000) / 100.0
    size = np.sqrt(0.5 * (1.0 / share - 1.0))
    signal = np.sin(phase) + size * np.sin(3 * phase) + size * np.sin(5 * phase)
    assert (fundamental(signal, 1.0) is not None) is told


@pytest.mark.parametrize(("noise", "told"), [(0.04, True), (0.06, False)])
def test_a_periodic_command_is_repeated_but_for_a_twentieth(noise, told):
    command = cycles(100.0, 100.0) / np.sqrt(0.5)
    assert (fundamental(command + noise * white(len(command)), 1.0) is not None) is told


def test_a_start_in_the_first_third_of_a_periodic_record_is_no_noise():
    command = cycles(60.0, 100.0)
    noise = np.where(np.arange(len(command)) < len(command) // 3, 0.1, 0.001) * white(len(command))
    assert periodic_noise(command, command + noise, 1.0) == pytest.approx(0.001, rel=0.15)


def test_a_periodic_record_tells_its_noise_as_well_as_a_quarter_of_its_samples():
    """The deviation of 200 estimates of it is that of so many independent samples."""
    command = cycles(10.0, 100.0)
    told = [periodic_noise(command, command + 0.01 * white(len(command), seed), 1.0) for seed in range(200)]
    independent = 0.5 / np.var(np.log(np.array(told, dtype=float)))
    own = noise_floors([run("r", command, command)], 0.1 * EDGE)
    assert independent / len(command) == pytest.approx(own.degrees_of_freedom / len(command), rel=0.15)


def is_repeat(command: np.ndarray, again: np.ndarray, shift: int = 0) -> bool:
    """Whether two records of these commands repeat each other."""
    outputs = (white(len(command), 3), white(len(again), 4))
    found = repeated([run("a", command, outputs[0]), run("b", again, outputs[1])])
    return [one.shift for one in found] == [shift]


SMOOTH = np.sin(2 * np.pi * np.arange(4000) / 400) / np.sqrt(0.5)


@pytest.mark.parametrize(("difference", "one"), [(0.85e-3, True), (1.15e-3, False)])
def test_two_inputs_are_one_within_a_thousandth_or_three_times_their_noise(difference, one):
    """An offset is no noise; an offset and noise, of which three times the noise explains both, are."""
    assert is_repeat(SMOOTH, SMOOTH + difference) is one
    noises = [0.01 * white(len(SMOOTH), seed) for seed in (5, 6)]
    offset = 0.01 * np.sqrt((2.6 if one else 3.4) ** 2 - 2.0)
    assert is_repeat(SMOOTH + noises[0], SMOOTH + noises[1] + offset) is one


@pytest.mark.parametrize(("noise", "one"), [(0.042, True), (0.058, False)])
def test_an_input_with_more_noise_than_a_twentieth_repeats_no_other(noise, one):
    first, second = (SMOOTH + noise * white(len(SMOOTH), seed) for seed in (5, 6))
    assert is_repeat(first, second) is one


@pytest.mark.parametrize(
    ("samples", "late", "one"), [(4000, 5, True), (4000, 6, False), (80, 4, True), (70, 4, False), (90, 5, False)]
)
def test_a_trigger_is_late_by_five_samples_at_most_or_a_twentieth_of_the_record(samples, late, one):
    command = white(samples + late)
    assert is_repeat(command[:samples], command[late:], -late) is one


@pytest.mark.parametrize(("share", "taken"), [(0.88, True), (0.92, False)])
def test_a_shift_that_takes_less_than_a_tenth_of_the_difference_is_none(share, taken):
    """Noise of which a part comes a sample late; the difference is within three times what is recorded."""
    late = np.sqrt(1.0 - share**2)
    part, first, second = white(4001, 7), white(4000, 8), white(4000, 9)
    a, b = (late * part[at : at + 4000] + np.sqrt(1.0 - late**2) * own for at, own in ((1, first), (0, second)))
    slow = np.sin(2 * np.pi * np.arange(4000) / 4000) / np.sqrt(0.5)
    assert is_repeat(slow + 0.01 * a, slow + 0.01 * b, 1 if taken else 0)


@pytest.mark.parametrize(("until", "settled"), [(0.085, True), (0.115, False)])
def test_repeats_are_compared_behind_the_first_tenth(until, settled):
    output = white(2000)
    other = output + np.where(np.arange(2000) < 2000 * until, 1.0, 0.0)
    difference = Repeat(run("a", SMOOTH[:2000], output), run("b", SMOOTH[:2000], other)).difference()
    assert bool(np.any(difference)) is not settled


@pytest.mark.parametrize(("apart", "one"), [(0.04, True), (0.06, False)])
def test_steps_repeat_each_other_from_starts_within_a_twentieth_of_their_way(apart, one):
    held, way = np.full(400, 0.1), 1.0 - np.exp(-np.arange(400) / 40)
    other = way + 1e-4 * white(400)
    other[0] = apart
    found = repeated([run("a", held, way), run("b", held, other)])
    assert bool(found) is one


@pytest.mark.parametrize(("change", "still"), [(0.85e-9, True), (1.15e-9, False)])
def test_a_record_stands_still_where_it_changes_by_a_billionth(change, still):
    assert at_rest(np.array([5.0, 5.0 * (1.0 - change), 5.0])) is still


def many(periods: float, samples: int) -> np.ndarray:
    """A multisine of so many periods: the lines 2 to 5 at random phases."""
    t = np.arange(round(periods * samples)) / samples
    return np.sum([np.sin(2 * np.pi * (k * t + 0.37 * k**2)) for k in (2, 3, 4, 5)], axis=0)


def repeats_itself(command: np.ndarray) -> bool:
    return bool(own_repeats(run("r", command, command + white(len(command)))))


@pytest.mark.parametrize(("periods", "told"), [(3.0, True), (2.95, False)])
def test_a_multisine_repeats_itself_from_three_periods_on(periods, told):
    assert repeats_itself(many(periods, 200)) is told


@pytest.mark.parametrize(("samples", "told"), [(16, True), (15, False)])
def test_a_period_of_its_own_has_sixteen_samples(samples, told):
    assert repeats_itself(many(40, samples)) is told


@pytest.mark.parametrize(("least", "told"), [(0.45, True), (0.55, False)])
def test_a_command_that_changes_slowly_does_not_repeat_itself_a_sample_later(least, told):
    """A multisine about two levels, one in each half of the part that is looked at: the least likeness is `least`."""
    sines = many(400, 100) / np.std(many(1, 100))
    lowest = float(np.min([sines[lag:] @ sines[: len(sines) - lag] / (len(sines) - lag) for lag in range(1, 100)]))
    share = (least - lowest) / (1.0 - lowest)
    levels = np.where(np.arange(len(sines)) * 3 > len(sines) * 2, 1.0, -1.0)  # of the last two thirds, the half
    assert (period(np.sqrt(1.0 - share) * sines + np.sqrt(share) * levels) is not None) is told


@pytest.mark.parametrize(("noise", "told"), [(0.094, True), (0.107, False)])
def test_a_noisy_multisine_repeats_itself(noise, told):
    """The autocorrelation after a period is 1/(1 + σ²) of that at once."""
    command = many(40, 400)
    assert (period(command + noise * np.std(command) * white(len(command), 5)) is not None) is told
