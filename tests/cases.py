"""Small raw files beside the checkout, each with what is said of it, and what is right: read here by numpy alone."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT.parent / "shared" / "cases"
RATE, DURATION = 1000.0, 1.5  # Hz, s: of every record


@dataclass(frozen=True)
class OfFile:
    """A file: its columns of time, command and displacement, and those of their units that it does not state.

    `head` lines stand above the samples, cut at `delimiter`. The command and the displacement are in mm.
    """

    name: str
    columns: tuple[str, str, str]
    units: tuple[str, str, str] = ("", "", "")
    head: int = 1
    delimiter: str = ","

    def truth(self) -> NDArray[np.float64]:
        """Command and displacement in m, (2, n), of the rows that are whole."""
        lines = (FOLDER / self.name).read_text(encoding="utf-8").splitlines()[self.head :]
        rows = [line.split(self.delimiter)[1:] for line in lines if line.count(self.delimiter) == 2]
        return 1e-3 * np.array([[float(field.replace(",", ".")) for field in row] for row in rows]).T


@dataclass(frozen=True)
class Case:
    """Files that are one matrix."""

    name: str
    files: tuple[OfFile, ...] = field(default_factory=tuple)

    def paths(self) -> list[Path]:
        """Where they are. Skips where they are absent."""
        found = [FOLDER / file.name for file in self.files]
        if not all(path.is_file() for path in found):
            pytest.skip(f"no small files: {FOLDER} does not hold {', '.join(file.name for file in self.files)}")
        return found

    def right(self, runs) -> None:
        """Each run is its file: rate, length, every sample of both channels."""
        assert [run.file for run in runs] == [f"runs/{file.name}" for file in self.files]
        for run, file in zip(runs, self.files, strict=True):
            assert run.sample_rate == pytest.approx(RATE, rel=1e-6)
            assert run.duration == pytest.approx(DURATION, abs=2 / RATE)
            assert run.units == {"command": "m", "displacement": "m"}
            np.testing.assert_allclose([run.command, run.measured], file.truth(), rtol=1e-12)


SAID = ("s", "mm", "mm")
GERMAN = ("Zeit", "Sollwert", "Istwert")
_NAMES_B = ("t_s", "setpoint_mm", "displacement_mm"), ("s", "mm", "mm")
MANY = (
    Case("units", tuple(OfFile(f"units_{one}.csv", ("time", "x_soll", "x_ist"), head=2) for one in "ab")),
    Case(
        "names",
        (
            OfFile("names_a.csv", ("time_ms", "cmd_mm", "pos_mm"), ("ms", "mm", "mm")),
            OfFile("names_b.csv", *_NAMES_B),
        ),
    ),
)
"""Matrices of more than one file, whose columns and units differ from one file to the next."""
ALONE = (
    OfFile("comma_plain.csv", GERMAN, SAID, delimiter=";"),
    OfFile("comma_tabs.txt", GERMAN, SAID, delimiter="\t"),
    OfFile("comma_units_row.csv", GERMAN, head=2, delimiter=";"),
    OfFile("comma_units_in_names.csv", ("Zeit [s]", "Sollwert [mm]", "Istwert [mm]"), delimiter=";"),
    OfFile("comma_preamble.csv", GERMAN, head=5, delimiter=";"),
    OfFile("two_header_rows.csv", ("Time", "Position command", "Position feedback"), head=7),
    OfFile("interval_rows.csv", ("Time", "Command", "Position"), head=3),
    OfFile("iso_time.csv", ("timestamp", "command_mm", "position_mm")),
    OfFile("cut_last_row.csv", ("time", "command", "position"), SAID),
)
"""Files that are a matrix each."""
CASES = (
    *MANY,
    *(Case(file.name, (file,)) for file in ALONE),
    Case("a decimal comma in one file, a point in the other", (ALONE[0], OfFile("names_b.csv", *_NAMES_B))),
)
