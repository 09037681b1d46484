"""Samples without a value, rows in another order, times that stand twice: as loggers and historians write them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from ident.drafts.draft import Answers, Draft
from ident.drafts.raw_file import read_raw
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.readers import read_matrix

COUNT, RATE = 400, 100.0
TIME = np.arange(COUNT) / RATE
LEVELS = np.repeat(np.random.default_rng(3).uniform(-2, 2, COUNT // 20), 20)
SPEED = 3.0 * np.sin(2 * np.pi * 0.5 * TIME)
Cells = dict[int, str]


def table(u: Cells | None = None, v: Cells | None = None) -> list[str]:
    """The rows of a record, with cells in the place of what was measured."""
    return [
        f"{TIME[n]:.2f},{(u or {}).get(n, f'{LEVELS[n]:.6f}')},{(v or {}).get(n, f'{SPEED[n]:.6f}')}"
        for n in range(COUNT)
    ]


def read(folder: Path, lines: list[str], **of_run: object) -> Matrix:
    (folder / "run.csv").write_text("\n".join(["t,u,v", *lines, ""]))
    channels = {"command": {"column": "u", "unit": "V"}, "velocity": {"column": "v", "unit": "rad/s"}}
    run = {"id": "one", "file": "run.csv", "output": "velocity", "hold": "zoh", "channels": channels} | of_run
    if "sample_rate" not in of_run:
        run["time"] = {"column": "t", "unit": "s"}
    (folder / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "GAPS"}, "runs": [run]}))
    return read_matrix(folder)


def told(matrix: Matrix) -> str:
    return " ".join(matrix.notices)


@pytest.mark.parametrize("word", ["", "nan", "NaN", "NULL", "#N/A", "n/a", "-", '""', "None"])
def test_single_cells_without_a_value_are_interpolated_and_told(tmp_path, word):
    matrix = read(tmp_path, table({250: word}, {100: word, 101: word, 300: word}))
    (run,) = matrix.runs
    assert (run.length, run.sample_rate, run.gaps, run.unbroken) == (COUNT, RATE, 3, (102, 300))
    np.testing.assert_allclose(run.channels["velocity"], SPEED, atol=2e-3)
    np.testing.assert_allclose(run.command, np.where(np.arange(COUNT) == 250, LEVELS[249], LEVELS), atol=1e-6)
    assert "no value of command in 1 and velocity in 3 of 400 rows" in told(matrix)
    assert "interpolated" in told(matrix)


@pytest.mark.parametrize("stated", [{}, {"sample_rate": "100 Hz"}])
def test_a_run_is_the_stretch_in_which_every_channel_has_values(tmp_path, stated):
    cells = dict.fromkeys([*range(30), *range(350, COUNT)], "NaN")
    matrix = read(tmp_path, table(None, cells), **stated)
    (run,) = matrix.runs
    np.testing.assert_allclose(run.channels["velocity"], SPEED[30:350], atol=1e-6)
    np.testing.assert_allclose(run.command, LEVELS[30:350], atol=1e-6)
    assert (run.gaps, run.evened) == (0, False)
    assert run.past is not None
    np.testing.assert_allclose(run.past, LEVELS[:30], atol=1e-6)
    assert "rows 30 to 349 are used" in told(matrix)


def test_validation_data_end_where_the_values_do(tmp_path):
    cells = dict.fromkeys(range(350, COUNT), "")
    fit, verify = read(tmp_path, table(None, cells), split={"validation": [280, 400], "gap": "0.1 s"}).runs
    assert (fit.length, verify.length) == (270, 70)
    np.testing.assert_allclose(verify.channels["velocity"], SPEED[280:350], atol=1e-6)


def test_a_channel_that_is_read_less_often_has_the_clock_where_it_is_the_output(tmp_path):
    """The command, read at each row, becomes its mean over each step: an edge between two samples keeps its time."""
    matrix = read(tmp_path, table(None, {n: "" for n in range(COUNT) if n % 3}))
    (run,) = matrix.runs
    assert run.sample_rate == pytest.approx(RATE / 3)
    assert (run.gaps, run.length) == (0, 133)
    np.testing.assert_allclose(run.channels["velocity"], SPEED[::3][: run.length], atol=1e-6)
    means = LEVELS[: 3 * (COUNT // 3)].reshape(-1, 3).mean(axis=1)
    np.testing.assert_allclose(run.command[: len(means)], means, atol=1e-6)
    assert "33.33 Hz" in told(matrix)


def test_a_logger_that_writes_one_signal_a_row_is_read(tmp_path):
    cells: tuple[Cells, Cells] = (dict.fromkeys(range(1, COUNT, 2), ""), dict.fromkeys(range(0, COUNT, 2), ""))
    (run,) = read(tmp_path, table(*cells)).runs
    assert run.sample_rate == RATE / 2
    np.testing.assert_allclose(run.channels["velocity"], SPEED[1 : COUNT - 1 : 2][: run.length], atol=1e-6)
    held = LEVELS[0 : COUNT - 2 : 2][: run.length]  # on at the half of a step
    after = LEVELS[2::2][: run.length]
    np.testing.assert_allclose(run.command, (held + after) / 2, atol=1e-5)


def test_a_hole_that_is_too_long_to_interpolate_leaves_the_longest_part(tmp_path):
    matrix = read(tmp_path, table(None, dict.fromkeys(range(120, 200), "")))
    (run,) = matrix.runs
    np.testing.assert_allclose(run.channels["velocity"], SPEED[200:], atol=1e-6)
    assert "rows 200 to 399 are used" in told(matrix)


@pytest.mark.parametrize("given", [(10, 40, 200, 300, 301), (0, 1, 2, 200, 201, 202, 203)])
def test_a_run_of_fewer_samples_than_a_clock_needs_is_refused(tmp_path, given):
    with pytest.raises(Unusable) as refused:
        read(tmp_path, table(None, {n: "" for n in range(COUNT) if n not in given}))
    assert refused.value.code == "too-short"


def test_channels_without_a_common_time_are_refused(tmp_path):
    cells = (dict.fromkeys(range(200, COUNT), ""), dict.fromkeys(range(200), ""))
    with pytest.raises(Unusable) as refused:
        read(tmp_path, table(*cells))
    assert refused.value.code == "no-values"


def test_rows_that_stand_newest_first_are_reversed(tmp_path):
    matrix = read(tmp_path, table()[::-1])
    (run,) = matrix.runs
    np.testing.assert_allclose(run.channels["velocity"], SPEED, atol=1e-6)
    assert "the newest row stands first" in told(matrix)
    (part,) = read(tmp_path, table()[::-1], rows=[0, 100]).runs
    np.testing.assert_allclose(part.channels["velocity"], SPEED[:100], atol=1e-6)


def test_rows_without_a_new_time_are_left_out_and_told(tmp_path):
    rows = table()
    rows = [*rows[:50], rows[49], *rows[50:200], ",0,0", rows[199], *rows[200:]]
    matrix = read(tmp_path, rows)
    (run,) = matrix.runs
    np.testing.assert_allclose(run.channels["velocity"], SPEED, atol=1e-6)
    assert "left out: 1 row without a time and 2 rows with the time of the row before" in told(matrix)


@pytest.mark.parametrize("back", [1.5, 50.0])
def test_a_row_whose_stamp_came_late_is_left_out_unless_the_time_begins_again(tmp_path, back):
    """Of a logger: a few times lie a step or two before the latest one; far before it begins a second record."""
    rows = table()
    rows[120] = f"{TIME[120] - back / RATE},{rows[120].split(',', 1)[1]}"
    if back > 3.0:
        with pytest.raises(Unusable) as refused:
            read(tmp_path, rows)
        assert refused.value.code == "time-not-monotonic"
        return
    matrix = read(tmp_path, rows)
    (run,) = matrix.runs
    np.testing.assert_allclose(run.channels["velocity"][:120], SPEED[:120], atol=1e-6)
    assert "left out: 1 row with a time before that of an earlier row" in told(matrix)


def test_rows_of_an_even_clock_that_was_printed_with_too_few_digits_all_stay(tmp_path):
    lines = [f"{time:.1f},{row.split(',', 1)[1]}" for time, row in zip(TIME, table(), strict=True)]
    matrix = read(tmp_path, lines)
    (run,) = matrix.runs
    assert (run.length, run.sample_rate) == (COUNT, pytest.approx(RATE, rel=1e-3))
    assert "left out" not in told(matrix)


def test_rows_of_an_uneven_clock_of_which_most_times_are_repeated_are_refused(tmp_path):
    times = np.floor(5 * TIME**1.3) / 5
    lines = [f"{time:.1f},{row.split(',', 1)[1]}" for time, row in zip(times, table(), strict=True)]
    with pytest.raises(Unusable) as refused:
        read(tmp_path, lines)
    assert refused.value.code == "time-not-monotonic"


@pytest.mark.parametrize("missing", [[17, 90], [0, 1, 399]])
def test_files_of_every_type_may_have_samples_without_a_value(matrix, kind, missing):
    sound = matrix.columns["x"].copy()
    matrix.columns["x"][missing] = np.nan
    (run,) = read_matrix(matrix.write(kind)).runs
    rows = np.arange(2, 399) if missing[0] == 0 else np.delete(np.arange(400), missing)
    values = run.channels["displacement"] if missing[0] == 0 else np.delete(run.channels["displacement"], missing)
    np.testing.assert_allclose(values, 1e-3 * sound[rows], rtol=1e-9, atol=1e-12)


def test_a_column_with_samples_without_a_value_is_proposed_with_the_others():
    rows = ["time [s],command [V],speed [rad/s],event", *(f"{row}," for row in table(None, {7: "NULL", 90: ""}))]
    rows[20] = f"{rows[20]}1"
    draft = Draft([read_raw("\n".join(rows).encode(), "run.csv")], Answers("A"))
    assert not draft.missing
    (described,) = draft.description()["runs"]
    assert set(described["channels"]) == {"command", "velocity"}
