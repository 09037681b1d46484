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

    `head` lines stand above the samples. The command and the displacement are in mm.
    """

    name: str
    columns: tuple[str, str, str]
    units: tuple[str, str, str] = ("", "", "")
    head: int = 1

    def truth(self) -> NDArray[np.float64]:
        """Command and displacement in m, (2, n)."""
        table = np.loadtxt(FOLDER / self.name, delimiter=",", skiprows=self.head)
        return 1e-3 * table[:, 1:].T


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


CASES = (
    Case("units", tuple(OfFile(f"units_{one}.csv", ("time", "x_soll", "x_ist"), head=2) for one in "ab")),
    Case(
        "names",
        (
            OfFile("names_a.csv", ("time_ms", "cmd_mm", "pos_mm"), ("ms", "mm", "mm")),
            OfFile("names_b.csv", ("t_s", "setpoint_mm", "displacement_mm"), ("s", "mm", "mm")),
        ),
    ),
)
"""Matrices of more than one file, whose columns and units differ from one file to the next."""
