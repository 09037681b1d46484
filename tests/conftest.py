"""What several test folders share: the command line, the measured data, the long forms of slow tests."""

from __future__ import annotations

import contextlib
import contextvars
import gc
import importlib
import io
import logging
import os
import sys
import threading
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.rounding import rounded_otherwise

pytest_plugins = ("tests.dearest", "tests.workers")

ROOT = Path(__file__).resolve().parents[1]

# Two dozen processes are started, and where nothing may be kept each compiles every module that it imports: 6 s.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# A warning of a number ends the processes that tests start, too; those of the tests themselves: pyproject.toml.
os.environ["PYTHONWARNINGS"] = "error::RuntimeWarning"

# What is imported and collected stays, and with all tests in memory each search of the collector through everything
# takes a tenth of a second and more.
gc.set_threshold(1_000_000, 20, 50)


def pytest_configure(config: pytest.Config) -> None:
    """What the processes of all workers are forked from imports the program while the tests are collected.

    That is a core's work, and the other one waited. In a fresh clone each compiles half of the modules for both.
    """
    if config.getoption("--workers") > 1 and hasattr(os, "fork"):
        from tests.running import nursery

        nursery()


def pytest_collection_finish(session: pytest.Session) -> None:
    """Loops of the references are compiled once for all processes, though they know nothing of the library's way.

    What is there before the first test stays: the collector need not look through it again.
    """
    for name, module in list(sys.modules.items()):
        if name.startswith("tests.reference."):
            from ident.simulation.jit import shared

            for function in vars(module).values():
                if hasattr(function, "py_func"):
                    shared(function)
    if session.config.getoption("--workers") > 1:
        # What each worker would import in its tests, for a second.
        for name in ("ident.simulation.numba_preload", "control"):
            importlib.import_module(name)
    if "hypothesis" in sys.modules and not asked_for_full(session.config):
        from hypothesis.internal.conjecture import providers

        # In the short form nothing is drawn of what stands in the program's own text: to read it takes seconds.
        providers._get_local_constants = lambda: providers._local_constants
    gc.freeze()
    gc.set_threshold(50_000, 20, 50)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--full", action="store_true", help="run the acceptance tests at full length (many minutes)")
    parser.addoption("--costs", metavar="FILE", help="write what each test cost, in seconds of the processor")


LONGEST = (
    "browser/test_workbench", "app/test_hybrid", "test_project", "diagnosis/test_diagnose", "bench/test_figures",
    "diagnosis/discovery/test_search", "browser/test_pages", "presets/test_moving_base", "cli/test_postgresql",
    "cli/test_commands", "app/backup/test_backup", "diagnosis/test_structure_selection",
    "cli/test_service_commands", "acceptance/test_identification", "test_readme", "checks/test_check",
    "test_windows", "checks/test_unit_factor", "presets/test_machines", "diagnosis/test_beyond_bounds",
    "diagnosis/test_drive_hysteresis", "figures/test_figures", "diagnosis/test_measured", "bench/test_acceptance",
    "test_warnings", "readers/test_lab_formats", "cli/test_diagnose", "effects/test_contract", "test_wheel",
    "hybrid/test_what_if", "acceptance/test_fitness", "residuals/test_curves", "presets/test_two_masses",
    "fit/test_windows", "diagnosis/test_recommended", "fit/test_fifth_order", "design/test_proposal",
    "faults/test_kill", "bench/test_procedures", "test_site", "bench/test_continued", "words/test_message",
    "diagnosis/test_free_shapes", "test_results", "diagnosis/test_time_budget", "hybrid/test_hybrid_simulation",
    "noise/test_noise", "test_docs", "test_alone",
)  # fmt: skip
"""Files that take longest, the dearest first; those that wait for a browser or a process stand between others.

What goes to one worker together (tests/workers.py) goes with its first. Of the folders of tests/app the backup comes
first: what it compares is all that the shared service holds.
"""


def asked_for_full(config: pytest.Config) -> bool:
    """Whether the full forms were asked for, by ``--full`` or SERVOIDENT_FULL=1."""
    return bool(config.getoption("--full")) or os.environ.get("SERVOIDENT_FULL") == "1"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Long files go first, so that no core is left alone with one at the end; what goes together is on end.

    What is marked `full` is skipped in the short form before its fixtures are made: docs/decisions/tests.md says what
    stands in for it.
    """
    from tests.workers import goes_with

    if not asked_for_full(config):
        for item in items:
            if item.get_closest_marker("full"):
                item.add_marker(pytest.mark.skip(reason="run with --full: docs/decisions/tests.md"))
    places = {f"tests/{name}.py": number for number, name in enumerate(LONGEST)}
    of_file = {file: places.get(file, len(places)) for file in {item.nodeid.partition("::")[0] for item in items}}
    first: dict[str, int] = {}
    for file, place in of_file.items():
        first[goes_with(file)] = min(place, first.get(goes_with(file), place))

    def turn(item: pytest.Item) -> tuple[int, str, int, str]:
        file = item.nodeid.partition("::")[0]
        return first[goes_with(file)], goes_with(file), of_file[file], file

    items.sort(key=turn)


class _Raised(logging.Handler):
    """Raises what a diagnosis survives by a note: no defect hides behind it in a test."""

    def emit(self, record: logging.LogRecord) -> None:
        if record.exc_info and record.exc_info[1] is not None:
            raise record.exc_info[1]


SURVIVED = _Raised()
logging.getLogger("servoident.diagnosis").addHandler(SURVIVED)


@pytest.fixture
def survives() -> Iterator[None]:
    """For a test of what becomes of a diagnosis of which a stage fails."""
    log = logging.getLogger("servoident.diagnosis")
    log.removeHandler(SURVIVED)
    yield
    log.addHandler(SURVIVED)


@pytest.fixture(scope="session", autouse=True)
def _rounding() -> Iterator[None]:
    """Data as another processor would round them, where that is asked for: see tests/rounding.py."""
    with rounded_otherwise():
        yield


@pytest.fixture(scope="session")
def full(request: pytest.FixtureRequest) -> bool:
    """True where the full forms were asked for, by ``--full`` or SERVOIDENT_FULL=1."""
    return asked_for_full(request.config)


@pytest.fixture(scope="session", autouse=True)
def _a_core_a_worker(full: bool, request: pytest.FixtureRequest) -> Iterator[None]:
    """In the short form of the whole run, which has a worker a core, none shares out its work among threads.

    They would hand the interpreter to one another and gain nothing: an eighth of what a diagnosis takes.
    """
    with pytest.MonkeyPatch.context() as own:
        if hasattr(request.config, "workerinput") and not full:
            from ident import parallel

            busy = threading.Semaphore(0)
            own.setattr(parallel, "_idle", lambda: busy)
        yield


@pytest.fixture
def all_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    """For a test of work that is shared out, wherever it runs."""
    from ident import parallel

    helpers = threading.Semaphore(parallel.cores() - 1)
    monkeypatch.setattr(parallel, "_idle", lambda: helpers)


FEW = {"coulomb_friction", "dead_zone", "quadratic_damping", "sensor_lag"}


def rank_only(own: pytest.MonkeyPatch, names: Collection[str]) -> None:
    """Put the effects with these names in the place of the catalogue of a diagnosis, until the test ends."""
    from ident.diagnosis import candidate_models
    from ident.effects import CATALOGUE

    few = tuple(effect for effect in CATALOGUE if effect.name in names)
    assert {effect.name for effect in few} == {*names}
    own.setattr(candidate_models, "CATALOGUE", few)


@contextlib.contextmanager
def of_few_effects(full: bool, *beside: str) -> Iterator[None]:
    """In the short form a diagnosis ranks four effects of the catalogue, of three places, and those named `beside`.

    The whole catalogue takes several times as long, and half a minute where its kernels have to be compiled. Of the
    runs that a lab could make next it weighs a few: what is proposed of all of them is said in tests/design.
    """
    with pytest.MonkeyPatch.context() as own:
        if not full:
            from ident.design import candidate_runs

            for most in ("_SPECIMENS", "_GAINS", "_AMPLITUDES"):
                own.setattr(candidate_runs, most, 2)
            rank_only(own, FEW | {*beside})
        yield


@pytest.fixture
def few_effects(full: bool) -> Iterator[None]:
    """For a test whose point is another than the whole catalogue."""
    with of_few_effects(full):
        yield


@contextlib.contextmanager
def short_searches(full: bool) -> Iterator[None]:
    """In the short form a search has a third of its members and generations, and two of them are polished, not five.

    For what is said of a fit, and not of how it is found: along a flat direction each polish goes on for as long as it
    may. The usual searches are in tests/acceptance, and in tests/fit where the search is the point.
    """
    with pytest.MonkeyPatch.context() as own:
        if not full:
            from ident.fit import genetic, identification

            own.setattr(identification, "CANDIDATES", 2)
            for options in (genetic.DEFAULT, genetic.WITH_EFFECTS):
                for name in ("population", "generations", "elite"):
                    own.setitem(options, name, float(round(options[name] / 3)))
        yield


@pytest.fixture(scope="session")
def measured_data() -> Path:
    """The folder of measured data beside the checkout; tests that need it are skipped where it is absent."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"no measured data: {folder} does not exist")
    return folder


@dataclass(frozen=True)
class Outcome:
    """What a command left behind."""

    returncode: int
    stdout: str
    stderr: str


Program = Callable[..., Outcome]


@pytest.fixture(scope="session")
def servoident(tmp_path_factory) -> Iterator[Program]:
    """The command line, run in this process (a new one would spend seconds on imports)."""
    from app.cli.program import main

    own = pytest.MonkeyPatch()
    for name in ("XDG_STATE_HOME", "XDG_DATA_HOME"):
        own.setenv(name, str(tmp_path_factory.mktemp("state")))
    for name in ("SERVOIDENT_DATA", "SERVOIDENT_TOKEN", "SERVOIDENT_SERVER", "SERVOIDENT_DATABASE"):
        own.delenv(name, raising=False)

    def run(*arguments: object) -> Outcome:
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.raises(SystemExit) as ended:
            contextvars.copy_context().run(main, [str(argument) for argument in arguments])  # units that it chose go
        assert "Warning" not in err.getvalue()
        return Outcome(ended.value.code, out.getvalue(), err.getvalue())

    yield run
    own.undo()
