"""Tables drawn at random, each read right or asked about; none is read as something else."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from ident.drafts.answers import NONE, Answer, Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import RawFile, read_raw
from ident.drafts.text import drafted, gathered
from ident.errors import Unusable
from ident.readers import read_matrix
from ident.readers.column_names import channel_of
from ident.run import Run
from ident.units.quantity import si_scale
from tests.readers.random_tables import Written, drawn

TABLES, SHORT = 500, 60  # with --full, in the short form
READ = 0.97
"""Share of the tables that must be read: asking about everything would be right and of no use."""
OF_UNIT = {"mm": 1e-3, "µm": 1e-6, "in": 0.0254, "V": 1.0, "kN": 1e3, "N": 1.0}


def same_unit(found: str, written: str) -> bool:
    return found == "" or si_scale(found, "") == si_scale(written, "")


def check_columns(file: RawFile, table: Written) -> None:
    """Every column with its samples; a name is the one written or a number, a unit the one written or none."""
    assert [column.number for column in file.columns] == list(range(len(table.names))), "columns"
    for column, name, unit, values in zip(file.columns, table.names, table.units, table.values, strict=True):
        within = 1e-9 if column.number in file.table.stamps else 0.0
        np.testing.assert_allclose(file.samples(column.number), values, rtol=0, atol=within)
        assert len(file.samples(column.number)) == len(values), "rows"
        called = (name, name.split(" [")[0], str(column.number))
        assert column.name in called or (not table.header and not channel_of(column.name)), column.name
        assert same_unit(column.unit, unit), (column.unit, unit)


def check_known(file: RawFile, table: Written) -> None:
    """A channel or a time that is taken from a name is the one that was written; what is not known is asked."""
    draft = Draft([file], Answers())
    known, asked = draft.known(file), {one.key for one in draft.missing}
    for channel, answer in known.channels.items():
        assert table.channels[file.table.number(answer.column, "")] == channel, (channel, answer)
        assert answer.unit or f"unit {channel}" in asked, channel
    if known.time.column != "":
        assert table.channels[file.table.number(known.time.column, "")] == "time"
        assert known.time.unit or "unit time" in asked
    else:
        assert "rate" in asked or known.rate == "1000 Hz"
    if table.cut:
        assert any(f"line {table.cut}, the last one, is cut off" in doubt for doubt in draft.doubts), draft.doubts


def answers(table: Written) -> Answers:
    """What the writer knows, by the numbers of columns; what else is named as a channel is none."""
    channels = {name: Answer(NONE) for name in ("force",)}
    for channel in ("command", "displacement"):
        number = table.of(channel)
        channels[channel] = Answer(number, table.units[number])
    if not table.time:
        return Answers("A", channels, rate="1 kHz")
    return Answers("A", channels, Answer(table.of("time"), table.units[table.of("time")]))


def check_run(run: Run, table: Written) -> None:
    """The samples of both channels in SI, at 1 kHz."""
    assert run.sample_rate == pytest.approx(1000.0, rel=1e-6)
    for channel, samples in (("command", run.command), ("displacement", run.measured)):
        number = table.of(channel)
        written = OF_UNIT[table.units[number]] * np.array(table.values[number])
        np.testing.assert_allclose(samples, written, rtol=1e-12, err_msg=channel)


def outcome(seed: int, folder) -> str:
    """What becomes of a table: read, or why it is refused. Fails where anything is wrong."""
    table = drawn(seed)
    try:
        file = read_raw(table.data, "run.txt")
    except Unusable as refused:
        return refused.code
    check_columns(file, table)
    check_known(file, table)
    given = answers(table)
    draft = Draft([file], given)
    assert not draft.missing, draft.missing
    (made,) = drafted(gathered(draft, [table.data])).runs
    check_run(made, table)
    path = folder / "run.txt"
    path.write_bytes(table.data)
    stated = {name: given.channels[name] for name in ("command", "displacement")}
    clock = {"time": {"column": given.time.column, "unit": given.time.unit}} if table.time else {"sample_rate": "1 kHz"}
    (read,) = read_matrix(
        path,
        units={name: one.unit for name, one in stated.items()},
        columns={name: one.column for name, one in stated.items()},
        **clock,
    ).runs
    check_run(read, table)
    return "read"


def test_each_table_is_read_right_or_asked_about(tmp_path, full):
    """Delimiter, decimal sign, heading, units, order, encoding, line ends, preamble, blanks and clock are drawn."""
    found: Counter[str] = Counter()
    wrong, count = [], TABLES if full else SHORT
    for seed in range(count):
        try:
            found[outcome(seed, tmp_path)] += 1
        except Exception as error:
            wrong.append(
                f"table {seed} ({drawn(seed).told}): {type(error).__name__} {' '.join(str(error).split())[:300]}"
            )
    assert not wrong, "\n".join([f"{len(wrong)} of {count}", *wrong[:20]])
    assert found["read"] >= READ * count, found
    assert set(found) <= {"read", "comma-twice"}, found
