"""Samples that no fit could use are refused, with the place of the first bad one."""

from __future__ import annotations

import numpy as np
import pytest

from ident.errors import Unusable
from ident.readers import read_matrix
from ident.readers.clock import evened, read_clock
from ident.readers.run import difference


def refusal(path):
    with pytest.raises(Unusable) as refused:
        read_matrix(path)
    assert "\n" not in str(refused.value)
    return refused.value


@pytest.mark.parametrize("bad", [np.inf, -np.inf, 1e200])
def test_a_sample_that_is_not_finite_is_named(matrix, kind, bad):
    matrix.columns["x"][[17, 90]] = bad
    refused = refusal(matrix.write(kind))
    assert refused.code == "not-finite"
    assert "sample 17 is" in str(refused)


@pytest.mark.parametrize(("length", "code"), [(0, "empty-file"), (1, "too-short"), (7, "too-short")])
def test_a_record_without_enough_samples_is_refused(matrix, kind, length, code):
    matrix.columns = {name: values[:length] for name, values in matrix.columns.items()}
    assert refusal(matrix.write(kind)).code == code


def test_an_empty_file_is_refused(matrix, kind):
    path = matrix.write(kind)
    next((path / "runs").iterdir()).write_bytes(b"")
    assert refusal(path).code == "empty-file"


@pytest.mark.parametrize("kind", ["npz", "mat5", "mat73", "h5", "tdms"])
def test_columns_of_unequal_length_are_refused(matrix, kind):
    matrix.columns["x"] = matrix.columns["x"][:300]
    refused = refusal(matrix.write(kind))
    assert refused.code == "unequal-lengths"
    assert "command 400, displacement 300" in str(refused)


@pytest.mark.parametrize(("name", "value"), [("u", 0.0), ("x", 0.3)])
def test_a_channel_that_never_moves_is_refused(matrix, name, value):
    matrix.columns[name][:] = value
    assert refusal(matrix.write()).code == "zero-variance"


def test_a_command_that_is_held_is_a_step_from_nothing(matrix):
    matrix.columns["u"][:] = 0.3
    run = read_matrix(matrix.write()).runs[0]
    assert run.stepped
    assert run.drive == pytest.approx(abs(run.command[0]))


def test_a_missing_run_file_is_named(matrix):
    refused = refusal(matrix.describe())
    assert (refused.code, refused.where) == ("missing-file", "runs/first.csv")


def test_text_in_a_column_of_numbers_is_named_with_its_line(matrix):
    path = matrix.write()
    text = (path / "runs/first.csv").read_text().splitlines()
    text[5] = "0.004,broken,1"
    (path / "runs/first.csv").write_text("\n".join(text))
    refused = refusal(path)
    assert refused.code == "not-numeric"
    assert "line 6 holds 'broken' among numbers; correct the number, or leave the cell empty" in str(refused)
    assert "heading" not in str(refused)


def test_the_part_behind_a_sample_that_is_missing_is_used_as_the_error_says(matrix):
    path = matrix.change("gain: 7", "rows: [10, 100]").write()
    text = (path / "runs/first.csv").read_text().splitlines()
    text[5] = "0.004,nan,1"
    (path / "runs/first.csv").write_text("\n".join(text))
    assert read_matrix(path).runs[0].length == 90


def test_a_row_that_is_too_short_is_named_with_its_line(matrix):
    path = matrix.write()
    text = (path / "runs/first.csv").read_text().splitlines()
    text[5] = "0.004,1"
    (path / "runs/first.csv").write_text("\n".join(text))
    refused = refusal(path)
    assert refused.code == "ragged-row"
    assert "line 6 has 2 fields" in str(refused)


@pytest.mark.parametrize("kind", ["npz", "parquet", "mat5", "h5", "tdms"])
@pytest.mark.parametrize("wrong", ["text", "complex", "truth"])
def test_arrays_of_anything_but_numbers_are_refused(matrix, kind, wrong):
    made = {"text": np.array(["a"] * 400), "complex": np.ones(400) * 1j, "truth": np.arange(400) % 2 == 0}
    if (kind, wrong) in (("parquet", "complex"), ("h5", "text"), ("mat5", "truth")):
        pytest.skip("the format cannot hold it, or stores it as numbers")
    matrix.columns["x"] = made[wrong]
    refused = refusal(matrix.write(kind))
    assert refused.code in ("not-numeric", "missing-column")


def test_a_time_column_gives_the_rate(matrix, kind):
    matrix.change("sample_rate: 1000 Hz", "time: {column: t, unit: s}")
    run = read_matrix(matrix.write(kind)).runs[0]
    assert run.sample_rate == 1000.0
    assert run.gaps == 0
    assert run.clock_jitter < 1e-6


@pytest.mark.parametrize("change", [lambda t: np.roll(t, 7), lambda t: np.where(np.arange(400) == 7, t[2], t)])
def test_time_that_does_not_increase_is_refused(matrix, change):
    matrix.change("sample_rate: 1000 Hz", "time: {column: t, unit: s}")
    matrix.columns["t"] = change(matrix.columns["t"])
    assert refusal(matrix.write()).code == "time-not-monotonic"


def test_a_file_of_several_records_is_refused_with_the_rows_of_the_first():
    """Each from its own zero, as of a logger that appends: to sort them by time would mix them. A clock that begins
    anew every 10 s looks alike."""
    with pytest.raises(Unusable) as refused:
        read_clock(np.tile(np.arange(25) / 100, 3), "t")
    assert refused.value.remedy.startswith("if it holds 3 records, make a run of each, rows: [0, 25] and so on; if one")
    with pytest.raises(Unusable) as refused:
        read_clock(np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.2, 0.5]), "t")
    assert refused.value.remedy.startswith("sort the lines by time")


def test_gaps_are_counted_and_do_not_change_the_rate():
    time = np.delete(np.arange(4000) / 4096, [100, 101, 102, 2500])
    clock = read_clock(time, "t")
    assert (clock.rate, clock.gaps) == (4096.0, 4)
    assert clock.jitter < 1e-6


def test_jitter_is_the_largest_deviation_from_an_even_clock_in_samples():
    time = np.arange(4000) / 4096
    time[1000] += 0.3 / 4096
    clock = read_clock(time, "t")
    assert clock.gaps == 0
    assert clock.jitter == pytest.approx(0.3, rel=1e-3)


def test_a_time_printed_with_few_digits_is_no_gap():
    clock = read_clock(np.round(np.arange(4000) / 4096, 4), "t")
    assert clock.gaps == 0
    assert clock.rate == pytest.approx(4096, rel=1e-5)
    assert clock.jitter < 0.5


def test_a_late_sample_of_an_uneven_clock_is_not_missing():
    """A busy computer's clock: every step is another, some are twice as long, and no sample was lost."""
    random = np.random.default_rng(3)
    steps = 0.05 + 0.008 * random.uniform(-1, 1, 2000)
    steps[[300, 301, 700, 1500]] = 0.11
    assert read_clock(np.append(0.0, np.cumsum(steps)), "t").gaps == 0


def test_a_sample_that_an_even_clock_lacks_is_missing_and_so_is_a_long_gap_of_an_uneven_one():
    steps = np.full(2000, 0.05)
    steps[300] = 0.10
    assert read_clock(np.append(0.0, np.cumsum(steps)), "t").gaps == 1
    uneven = 0.05 + 0.008 * np.random.default_rng(4).uniform(-1, 1, 2000)
    uneven[300] = 0.50
    assert read_clock(np.append(0.0, np.cumsum(uneven)), "t").gaps == 9


def test_short_holes_of_a_clock_are_bridged_and_a_long_pause_is_not():
    """Blocks of 0.1 s with holes of 20 ms, of an even clock and of one that was printed; two tests, a pause apart."""
    even = np.arange(6000) / 500
    blocks = even[np.arange(6000) % 60 < 50]
    for time in (blocks, np.round(blocks, 3)):
        clock = read_clock(time, "t")
        assert not clock.even
        assert clock.rate == pytest.approx(500.0, rel=1e-6)
        assert clock.gaps == 990
        np.testing.assert_allclose(clock.time, blocks, atol=1e-6)
        sine = evened(clock.time, np.sin(2 * np.pi * blocks), clock.rate, held=False, where="t")
        np.testing.assert_allclose(sine, np.sin(2 * np.pi * np.arange(len(sine)) / 500), atol=1e-3)
    pause = even[(even < 4) | (even > 6)]
    assert read_clock(pause, "t").even


def test_a_column_may_be_the_difference_of_two(matrix, kind):
    """As a voltage between two wires, each against earth; whole numbers of a converter do not wrap."""
    u = matrix.columns["u"]
    matrix.columns["up"], matrix.columns["down"] = 0.75 * u, -0.25 * u
    plain = read_matrix(matrix.write(kind)).runs[0]
    matrix.change("{column: u,", "{column: up - down,")
    run = read_matrix(matrix.write(kind)).runs[0]
    assert run.command == pytest.approx(plain.command, rel=1e-6)
    assert difference([np.array([1, 5], np.uint8), np.array([2, 3], np.uint8)], "c") == pytest.approx([-1, 2])


def test_a_difference_names_the_column_that_is_not_there(matrix):
    matrix.change("{column: u,", "{column: u - gone,")
    refused = refusal(matrix.write())
    assert (refused.code, "gone" in refused.what) == ("missing-column", True)


def test_columns_of_a_difference_are_of_one_length():
    with pytest.raises(Unusable, match="3 and 2 samples"):
        difference([np.zeros(3), np.zeros(2)], "run one channels.command")


def test_a_time_of_too_few_digits_repeats_itself_and_is_an_even_clock():
    """2.5 kHz and 10 kHz printed in milliseconds; lines that are there twice are no such clock, and are refused."""
    for rate in (2500.0, 10000.0):
        clock = read_clock(np.round(np.arange(4000) / rate, 3), "t")
        assert (clock.rate, clock.gaps, clock.even) == (pytest.approx(rate, rel=1e-4), 0, True)
    twice = np.insert(np.arange(400) / 100, [200, 200, 200], 2.0)
    with pytest.raises(Unusable, match="state the sample rate"):
        read_clock(twice, "t")
