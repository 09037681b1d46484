"""A text with several tables of the same columns becomes a run of each, with the lines that stand above it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.drafts.raw_file import read_raw
from ident.drafts.separate_tables import with_tables_apart


def cycles(first: str = "", ending: str = "\n") -> bytes:
    """What a testing machine stores of three cycles: in which, when, names, units, numbers with decimal commas."""
    text = first
    for cycle in (100, 200, 300):
        text += f"\nCyclic Acquisition\t\tTime:\t{cycle / 5}\tSec\nStored at:\t{cycle}\tcycle\nPoints:\t12\n"
        text += "Time\tAxial Displacement\tAxial Force\nSec\tmm\tkN\n"
        rows = ((cycle / 5 + n / 500, np.sin(n + cycle), np.cos(n)) for n in range(12))
        text += "".join("\t".join(f"{one:.6f}" for one in row).replace(".", ",") + "\n" for row in rows)
    return text.replace("\n", ending).encode()


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
@pytest.mark.parametrize(("name", "first"), [("test.dat", "MTS793|MPT|ENU|1|2|,|/|:|1|0|0|A\n"), ("test.txt", "")])
def test_each_table_is_a_file_of_its_own(name, first, ending):
    """With its own time, names and units; a remark says which table of which file it was."""
    parts = with_tables_apart([(name, cycles(first, ending))])
    assert [part for part, _ in parts] == ["test-1.txt", "test-2.txt", "test-3.txt"]
    for number, (part, data) in enumerate(parts, 1):
        file = read_raw(data, part)
        assert [(one.meaning, one.unit) for one in file.columns] == [
            ("Time", "Sec"),
            ("Displacement", "mm"),
            ("Force", "kN"),
        ]
        np.testing.assert_allclose(file.samples(0), 20 * number + np.arange(12) / 500, atol=1e-9)
        np.testing.assert_allclose(file.samples(1), np.sin(np.arange(12) + 100 * number), atol=1e-6)
        assert f"{part} is cut from {name}, table {number} of 3" in file.remarks


def test_a_file_of_one_table_or_of_no_text_stays_as_it_is():
    plain = b"time,x\n" + b"".join(b"%d,%d\n" % (n, n % 3) for n in range(20))
    for name, data in (("a.csv", plain), ("a.npz", b"PK\x03\x04"), ("a.dat", b"\0" * 40), ("a.txt", b"words alone\n")):
        assert with_tables_apart([(name, data)]) == [(name, data)]
