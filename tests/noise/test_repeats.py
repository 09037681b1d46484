"""One rule says which runs repeat each other: their inputs agree sample by sample; labels can only part them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter

from ident.checks.check import check
from ident.fit.reduction import excited_band
from ident.matrix import Actuator, Matrix
from ident.noise.criteria import NOISE_CRITERIA
from ident.noise.floor import noise_floors
from ident.noise.repeats import recording_noise, repeated
from ident.run import Run, Specimen

RATE, LENGTH = 1000.0, 4000
MOST_SHIFT = NOISE_CRITERIA.repeats.shift
NOISE = 0.01  # of the output's standard deviation
Command = Callable[[np.random.Generator], np.ndarray]


def random_band(rng: np.random.Generator) -> np.ndarray:
    """Noise of 0 to 40 Hz."""
    lines = np.fft.rfft(rng.standard_normal(LENGTH + 40))
    lines[np.fft.rfftfreq(LENGTH + 40, 1 / RATE) > 40.0] = 0.0
    found = np.fft.irfft(lines)
    return found / found.std()


def staircase(rng: np.random.Generator) -> np.ndarray:
    """Held levels of 40 samples."""
    return np.repeat(rng.uniform(-1.0, 1.0, LENGTH // 40 + 1), 40)


def sine(rng: np.random.Generator) -> np.ndarray:
    """A sine of 5 Hz that repeats twenty times within the run, from any phase."""
    return np.sin(2 * np.pi * (5.0 * np.arange(LENGTH + 40) / RATE + rng.uniform()))


def sweep(rng: np.random.Generator) -> np.ndarray:
    """From 1 Hz to 30 Hz at any pace."""
    t = np.arange(LENGTH + 40) / RATE
    return np.sin(2 * np.pi * (t + rng.uniform(2.0, 3.5) * t**2))


def white(rng: np.random.Generator) -> np.ndarray:
    """Noise that fills the spectrum, as the noise of a recorder does."""
    return rng.standard_normal(LENGTH + 40)


COMMANDS: tuple[Command, ...] = (random_band, staircase, sine, sweep, white)


def answer(command: np.ndarray) -> np.ndarray:
    """A second-order machine whose gain is another one way than the other, so that an offset changes its course."""
    y = lfilter(*butter(2, 0.1), command)
    return np.where(y > 0, y, 0.6 * y)


def run(name: str, command: np.ndarray, seed: int, recorded: float = 0.0, shift: int = 0, length: int = LENGTH) -> Run:
    """A run of a command, which is recorded with noise; it starts `shift` samples after the trigger's 20th."""
    rng = np.random.default_rng(seed)
    output, cut = answer(command), slice(20 + shift, 20 + shift + length)
    output = output[cut] + NOISE * output.std() * rng.standard_normal(length)
    seen = command[cut] + recorded * command.std() * rng.standard_normal(length)
    channels = {"command": seen, "displacement": output}
    return Run(name, "", RATE, channels, dict.fromkeys(channels, "m"), gain=5.0)


def pairs(*runs: Run) -> list[tuple[str, str, int]]:
    return [(found.first.id, found.second.id, found.shift) for found in repeated(runs)]


def floors(*runs: Run) -> np.ndarray:
    return np.array(list(noise_floors(runs, excited_band(runs)).by_run.values()), dtype=float)


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("recorded", [0.0, 0.0005, 0.005, 0.02])
@pytest.mark.parametrize("shift", [0, 1, 3, -3, MOST_SHIFT])
def test_one_command_twice_is_a_repeat_recorded_with_noise_or_late_by_a_trigger(command, recorded, shift):
    u = command(np.random.default_rng(1))
    one, again = run("one", u, 2, recorded), run("again", u, 3, recorded, shift)
    (found,) = repeated([one, again])
    moved = np.std(u[20 + shift : LENGTH + shift] - u[20:LENGTH]) / u.std()
    if found.shift != -shift:  # a shift that changes the command by less than its noise is hidden by it
        assert found.shift == 0
        assert moved < 1.5 * recorded
    assert floors(one, again) == pytest.approx([NOISE, NOISE], rel=0.1 if found.shift == -shift else 0.5)


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("recorded", [0.0, 0.005])
@pytest.mark.parametrize("offset", [0.05, 0.5, 3.0, -3.0])
def test_a_command_with_another_mean_is_another_command(command, recorded, offset):
    u = command(np.random.default_rng(4))
    one, other = run("one", u, 5, recorded), run("other", u + offset * u.std(), 6, recorded)
    assert pairs(one, other) == []


@pytest.mark.parametrize("offset", [3.0, -3.0])
def test_an_offset_of_three_deviations_leaves_the_floor_where_the_noise_is(offset):
    u = random_band(np.random.default_rng(7))
    one, other = run("one", u, 8), run("other", u + offset, 9)
    assert floors(one, other) == pytest.approx([NOISE, NOISE], rel=0.3)


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("recorded", [0.0, 0.005])
def test_two_commands_of_one_kind_and_one_label_are_no_repeats(command, recorded):
    """Two draws of one generator, one with three times the size, one turned, one ten per cent louder."""
    u, v = command(np.random.default_rng(10)), command(np.random.default_rng(11))
    first = run("first", u, 12, recorded)
    for number, other in enumerate((v, 3.0 * v, 3.0 * u, -u, 1.1 * u)):
        assert pairs(first, run("second", other, 13 + number, recorded)) == []


def test_a_gain_of_one_per_cent_is_no_noise_of_the_recorder_whatever_the_command():
    for command in COMMANDS:
        u = command(np.random.default_rng(14))
        assert pairs(run("one", u, 15), run("louder", 1.01 * u, 16)) == []


def test_the_noise_of_a_recorder_is_found_and_neither_an_offset_nor_a_gain_nor_another_command_is_taken_for_it():
    rng = np.random.default_rng(17)
    for command in COMMANDS:
        u = command(rng)
        for size in (0.002, 0.02):
            one, again = (u + size * rng.standard_normal(len(u)) for _ in range(2))
            assert recording_noise(one, 1.02 * again + 0.3) == pytest.approx(size, rel=0.1)
        if command is not white:
            assert recording_noise(u, command(rng)) < 0.3 * u.std()


def test_a_filter_ahead_of_the_recorder_and_its_steps_are_noise_as_well():
    u = random_band(np.random.default_rng(18))
    noises = (np.random.default_rng(seed).standard_normal(len(u)) for seed in (19, 20))
    one, again = (u + 0.01 * lfilter(*butter(4, 0.5), noise) for noise in noises)
    assert pairs(run("one", one, 21), run("again", again, 22)) == [("one", "again", 0)]
    coarse = [np.round(50 * (u + 0.002 * np.random.default_rng(seed).standard_normal(len(u)))) / 50 for seed in (1, 2)]
    assert pairs(run("one", coarse[0], 23), run("again", coarse[1], 24)) == [("one", "again", 0)]


def test_records_of_other_length_or_rate_are_no_repeats_but_for_a_trigger():
    u = sweep(np.random.default_rng(25))
    one = run("one", u, 26)
    assert pairs(one, run("again", u, 27, length=LENGTH - MOST_SHIFT)) == [("one", "again", 0)]
    assert pairs(one, run("shorter", u, 27, length=LENGTH - 100)) == []
    assert pairs(one, run("shifted", u, 27, shift=MOST_SHIFT + 3)) == []
    again = run("again", u, 27)
    assert pairs(one, replace(again, sample_rate=RATE * (1 + 1e-6))) == [("one", "again", 0)]
    assert pairs(one, replace(again, sample_rate=1.01 * RATE)) == []


@pytest.mark.parametrize(
    "label",
    [{"gain": 6.0}, {"gain": None}, {"use": "verify"}, {"specimen": Specimen(1.0)}, {"amplitude": 1.0},
     {"kind": "sine"}, {"frequency": 5.0}, {"position_range": (0.0, 0.1)}, {"hold": "zoh"},
     {"units": {"command": "V", "displacement": "m"}}],
)  # fmt: skip
def test_a_label_parts_runs_of_one_command(label):
    u = sweep(np.random.default_rng(28))
    one, again = run("one", u, 29), run("again", u, 30)
    assert pairs(one, again) == [("one", "again", 0)]
    assert pairs(one, replace(again, **label)) == []


def test_what_moves_a_machine_without_a_command_counts_and_so_does_a_measured_disturbance():
    rng = np.random.default_rng(31)
    u, v = sweep(rng), sweep(rng)

    def moved(name: str, motion: np.ndarray, seed: int, **more: np.ndarray) -> Run:
        made = run(name, motion, seed, 0.005)
        channels = {"velocity": made.command, "force": made.measured, **more}
        return replace(made, channels=channels, output="force", units={"velocity": "m/s", "force": "N"})

    assert pairs(moved("one", u, 32), moved("again", u, 33)) == [("one", "again", 0)]
    assert pairs(moved("one", u, 32), moved("other", v, 33)) == []
    loads = [sweep(rng)[:LENGTH] for _ in range(2)]
    same, other = (moved("two", u, 33, load_disturbance=load) for load in loads)
    assert pairs(moved("one", u, 32, load_disturbance=loads[0]), same) == [("one", "two", 0)]
    assert pairs(moved("one", u, 32, load_disturbance=loads[0]), other) == []


def test_outputs_of_one_record_are_no_repeats_and_each_output_has_its_own():
    rng = np.random.default_rng(34)
    u = sweep(rng)

    def record(name: str, seed: int, share: float) -> tuple[Run, ...]:
        made = run(name, u, seed, 0.002)
        force = made.measured + share * np.random.default_rng(seed + 100).standard_normal(LENGTH)
        made = replace(made, channels={**made.channels, "force": force}, units={**made.units, "force": "N"})
        return made.of_outputs(["displacement", "force"])

    runs = (*record("one", 35, 0.1), *record("again", 36, 0.1))
    expected = [("one.displacement", "again.displacement", 0), ("one.force", "again.force", 0)]
    assert pairs(*runs) == expected
    found = noise_floors(runs, excited_band(runs)).by_run
    assert found["one.displacement"] == pytest.approx(NOISE, rel=0.1)
    assert found["one.force"] > 5 * NOISE
    # Without a command the motion is what drives, unless it is an output of the record itself.
    bare = [
        replace(
            one,
            channels={"velocity": one.command, **{n: one.channels[n] for n in ("displacement", "force")}},
            units={"velocity": "m/s", "displacement": "m", "force": "N"},
        )
        for one in runs
    ]
    assert pairs(*bare) == expected


def test_a_copy_of_a_record_is_no_repeat_even_cut_at_another_sample():
    u = sweep(np.random.default_rng(37))
    whole = run("whole", u, 38)
    for first in (0, 3):
        copy = replace(whole.part(first, LENGTH), id="copy")
        assert pairs(whole, copy) == []


def test_the_check_says_what_repeats_and_by_how_much_it_is_shifted():
    u, v = (random_band(np.random.default_rng(seed)) for seed in (39, 40))
    runs = (run("a", u, 41), run("b", u, 42, 0.005, 3), run("c", u, 43), run("d", v, 44), run("e", u + 3.0, 45))
    said = [each.text for each in check(Matrix(Actuator("R"), runs)) if each.code == "repeat"]
    assert len(said) == 1
    assert said[0].startswith("runs a, b and c repeat the same command under the same conditions")
    assert "Compared with a, b starts 3 samples later" in said[0]
    bare = [replace(one, gain=None) for one in runs[2:4]]
    assert not [each for each in check(Matrix(Actuator("R"), tuple(bare))) if each.code == "repeat"]
