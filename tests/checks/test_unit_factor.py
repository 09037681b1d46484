"""A clock or an amplitude that is off by the factor of a unit is doubted; what was meant so is not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ident.checks.check import check
from ident.checks.response import respond
from ident.checks.unit_factor import FACTORS, factor, unit_causes, unit_factor
from ident.drafts.answers import Answer, Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_raw
from ident.drafts.text import drafted, gathered
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.readers import read_matrix
from ident.run import Run, Specimen
from ident.synthesis.matrix import Simulation, simulate_matrix, simulated
from ident.workflows import identify
from tests.blind.any_machine import Lab
from tests.cases import CASES
from tests.presets.test_composed import force_loop
from tests.presets.test_machines import motor, specimen
from tests.short_form import short_form

from .conftest import displacement_of

WRONG = (1e1, 1e2, 1e3, 1e6, *FACTORS)
"""Factors that the tests put in, each also as its reciprocal."""


def doubts(runs) -> list[tuple[str | None, str]]:
    """Run and code of everything that is doubted of units."""
    return [(one.run, one.code) for one in unit_factor([(run, respond(run)) for run in runs], [])]


def clocked(run: Run, times: float) -> Run:
    """The run with its time in another unit: the samples are the same."""
    return replace(run, sample_rate=run.sample_rate * times)


def sized(run: Run, times: float, *channels: str) -> Run:
    """The run with channels in another unit."""
    return replace(run, channels={name: x * (times if name in channels else 1.0) for name, x in run.channels.items()})


def with_one(runs, number: int, run: Run) -> list[Run]:
    return [run if place == number else one for place, one in enumerate(runs)]


def misread() -> Matrix:
    """Two records of 1.5 s at 1 kHz, one of them in s and called ms."""
    case = CASES[0]
    contents = [path.read_bytes() for path in case.paths()]
    files = [read_raw(content, file.name) for content, file in zip(contents, case.files, strict=True)]
    _, command, displacement = case.files[0].columns
    channels = {"command": Answer(command), "displacement": Answer(displacement)}
    answers = Answers("S", channels, Answer("time", "ms"))
    return drafted(gathered(Draft(files, answers), contents))


def test_a_time_in_seconds_that_is_called_milliseconds_is_doubted():
    """With the factor, the rate, the duration, the sister, and what to correct."""
    (found,) = (one for one in check(misread()) if one.code == "clock-factor")
    assert (found.run, found.severity) == ("units_b", "doubt")
    for told in ("1e+06 Hz", "0.0015", "1000 times that of units_a", "s and ms", "Correct the unit of its time"):
        assert told in found.text


def test_a_factor_is_known_within_two_per_cent_and_one_is_none():
    for size in (1e1, 1e2, 1e3, 1e6, 1e9, *FACTORS):
        for near in (size, size * 1.019, size / 1.019, 1 / size):
            assert factor(near) is not None, near
    assert factor(1e3).value == factor(1e-3).value == 1e3
    for other in (1.0, 1.02, 2.0, 2.5, 5.0, 11.0, 23.0, 58.65, 1030.0, 970.0, 300.0):
        assert factor(other) is factor(1 / other) is None, other


@pytest.fixture(scope="module")
def plain():
    """The paper's small matrix, simulated: 27 runs of three amplitudes, three specimens, three gains."""
    return simulated(Simulation(seconds=1.0, small=True))


def test_nothing_is_doubted_of_simulated_machines(plain, tmp_path):
    """The paper's matrix with its amplitudes stated and not, a bench, a press, a damper, a motor; others below."""
    assert doubts(plain.runs) == []
    assert doubts([replace(run, amplitude=None) for run in plain.runs]) == []
    simulate_matrix(tmp_path / "bench", "kononykhin", noise=0.001)
    assert doubts(read_matrix(tmp_path / "bench").runs) == []
    for made in (force_loop(1, seconds=2.0), specimen(2), motor(3)):
        assert doubts(made.runs) == []


def test_nothing_is_doubted_of_measured_machines(measured_data, full):
    folders = [path.parent for path in sorted(measured_data.glob("*/matrix.yaml"))]
    assert len(folders) > 15
    for folder in folders if full else folders[1::3]:
        assert doubts(read_matrix(folder).runs) == [], folder.name


def record(name: str, seed: int, rate: float = 4096.0, band: float = 80.0, n: int = 8192, rms: float = 1e-3) -> Run:
    """White noise up to a band, in Hz, into the machine of Table 4."""
    random = np.random.default_rng(seed)
    lines = np.fft.rfft(random.normal(size=n))
    lines[np.fft.rfftfreq(n, 1 / rate) > band] = 0
    u = np.fft.irfft(lines, n)
    u *= rms / u.std()
    x = displacement_of(u, Specimen(), 7.0, rate)
    channels = {"command": u, "displacement": x + 0.005 * x.std() * random.normal(size=n)}
    return Run(name, "", rate, channels, dict.fromkeys(channels, "m"), gain=7.0)


def sweep(name: str, seconds: float, top: float) -> Run:
    """A swept sine from 0.1 Hz."""
    t = np.arange(round(seconds * 1000)) / 1000
    u = 1e-3 * np.sin(2 * np.pi * (0.1 * t + (top - 0.1) * t**2 / (2 * seconds)))
    channels = {"command": u, "displacement": displacement_of(u, Specimen(), 7.0, 1000.0)}
    return Run(name, "", 1000.0, channels, dict.fromkeys(channels, "m"), gain=7.0)


def ramp(name: str, rate: float, seconds: float) -> Run:
    """A slow triangle of 20 mm: a static test."""
    t = np.arange(round(rate * seconds)) / rate
    u = 0.02 * (2 / np.pi) * np.arcsin(np.sin(2 * np.pi * t / seconds))
    channels = {"command": u, "displacement": displacement_of(u, Specimen(), 7.0, rate)}
    return Run(name, "", rate, channels, dict.fromkeys(channels, "m"), gain=7.0)


def noise() -> list[Run]:
    """Three runs alike."""
    return [record(f"n{seed}", seed) for seed in range(3)]


MEANT: dict[str, Callable[[], list[Run]]] = {
    "a recorder ten times slower": lambda: [*noise(), record("slow", 4, rate=409.6, n=819)],
    "and ten times as long, its command as much slower": lambda: [*noise(), record("slow", 4, rate=409.6, band=8.0)],
    "sweeps of 10 and 100 s": lambda: [sweep("a", 10, 30), sweep("b", 10, 30), sweep("c", 100, 30), sweep("d", 10, 3)],
    "a slow static test": lambda: [*noise(), ramp("static", 40.96, 200), ramp("static-2", 4096.0, 20)],
    "decades of amplitude, each repeated": lambda: [record(f"r{k}", k, rms=10.0 ** -(2 + k // 2)) for k in range(6)],
    "decades of amplitude, the last one once": lambda: [
        record(f"r{k}", k, rms=10.0 ** -(2 + k // 2)) for k in range(5)
    ],
    "decades of amplitude, each once": lambda: [record(f"r{k}", k, rms=10.0**-k) for k in (2, 3, 4)],
    "a stated amplitude": lambda: [*noise(), replace(record("large", 4, rms=1e-2), amplitude=1e-2)],
    "a gain that was as much smaller": lambda: [*noise(), replace(record("large", 4, rms=1e-2), gain=0.7)],
    "runs of other kinds": lambda: [*noise(), replace(record("large", 4, rms=1e-2), kind="multisine")],
    "two amplitudes of no unit's factor": lambda: [*noise(), record("large", 4, rms=5e-3)],
}


@pytest.mark.parametrize("name", MEANT)
def test_what_was_meant_is_not_doubted(name):
    assert doubts(MEANT[name]()) == []


@pytest.mark.parametrize("times", short_form(WRONG, 10.0, 25.4, 60.0))
def test_each_factor_is_found_in_the_clock_and_in_the_amplitude(plain, times):
    """In a matrix of three amplitudes, one of 27 runs; what is stated of an amplitude is judged by its own check."""
    runs = plain.runs
    bare = [replace(run, amplitude=None) for run in runs]
    for wrong in (times, 1 / times):
        assert doubts(with_one(runs, 5, clocked(runs[5], wrong))) == [(runs[5].id, "clock-factor")]
        both = sized(bare[4], wrong, "command", "displacement")
        assert doubts(with_one(bare, 4, both)) == [(runs[4].id, "amplitude-factor")]
    turned = [replace(record(f"r{k}", k), gain=7.0) for k in range(3)]
    answered = sized(turned[1], times, "displacement")
    assert doubts(with_one(turned, 1, answered)) == [("r1", "amplitude-factor")]


def test_a_time_that_was_resampled_in_a_wrong_unit_is_told_by_its_duration():
    """The rate is that of the others: only the answer, as much too slow, gives it away."""
    sisters = [record(f"r{k}", k, rate=409.6, n=1024) for k in range(3)]
    assert doubts(sisters) == []
    long = replace(record("long", 4, rate=60 * 409.6, n=60 * 1024), sample_rate=409.6)
    assert doubts([*sisters, long]) == [("long", "clock-factor")]


def test_where_a_command_is_missing_the_motion_that_drives_is_looked_at():
    """A damper in N and kgf; its own clock."""
    first, second = specimen(4, friction=20.0).runs
    third = specimen(5, friction=20.0).runs[0]
    runs = [replace(run, id=name, use="fit") for run, name in zip((first, second, third), "abc", strict=True)]
    assert doubts(runs) == []
    assert doubts(with_one(runs, 2, clocked(runs[2], 60.0))) == [("c", "clock-factor")]


def test_one_run_of_machines_drawn_at_random_is_found(full):
    """All clocks; all amplitudes whose two sisters have one size: of two sizes nobody knows which is usual."""
    known = 0
    for seed in range(200 if full else 3):
        runs = Lab.drawn(seed, hidden=bool(seed % 2)).measured().runs
        assert doubts(runs) == [], seed
        random = np.random.default_rng(seed)
        number, times = int(random.integers(3)), float(random.choice(WRONG) ** random.choice([-1, 1]))
        bad = clocked(runs[number], times)
        assert doubts(with_one(runs, number, bad)) == [(bad.id, "clock-factor")], seed
        sizes = [float(np.std(run.command)) for run in runs]
        others = [size for place, size in enumerate(sizes) if place != number]
        if max(others) > 1.01 * min(others) or not 0.99 < sizes[number] / others[0] < 1.01:
            continue
        known += 1
        bad = sized(runs[number], times, "command", runs[number].output)
        assert doubts(with_one(runs, number, bad)) == [(bad.id, "amplitude-factor")], seed
    assert known > (100 if full else 0)


def test_a_fit_that_explains_hardly_anything_names_the_unit():
    """Of the run that is doubted; where none is, that a unit may be wrong."""
    causes = "; ".join(map(str, unit_causes(misread().runs)))
    assert causes.startswith("a wrong unit: run units_b is sampled at 1e+06 Hz")
    assert list(map(str, unit_causes(noise()))) == ["a wrong unit of a channel or of the time"]


def test_a_fit_of_a_run_whose_time_has_a_wrong_unit_says_so_first():
    fit = identify(misread(), Settings(model="first_order"))
    assert fit.error["fit"] > 0.8
    assert "a wrong unit: run units_b" in fit.notes[0]
