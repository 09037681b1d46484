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
        importlib.import_module("ident.simulation.ready")
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
    "browser/test_workbench", "browser/test_pages", "cli/test_postgresql", "cli/test_service_commands",
    "test_readme", "test_project", "test_windows", "test_wheel", "diagnosis/test_diagnose",
    "diagnosis/discovery/test_search", "cli/test_commands", "acceptance/test_identification",
    "diagnosis/test_structure_selection", "effects/test_every_pair", "reference/test_nonlinear_reference",
    "cli/test_diagnose", "bench/test_figures", "fit/test_windows", "bench/test_procedures",
    "diagnosis/test_time_budget", "test_docs", "bench/test_acceptance", "test_wrong_arguments",
    "residuals/test_curves", "hybrid/test_what_if", "test_imports", "bench/test_identification",
    "presets/test_machines", "checks/test_check", "test_alone", "acceptance/test_one_error", "fit/test_beginnings",
    "diagnosis/test_measured", "fit/test_custom_fit", "cli/test_effects", "acceptance/test_measured",
    "diagnosis/discovery/test_any_machine", "stability/test_hybrid_judgement", "figures/test_figures",
    "readers/test_lab_formats", "app/backup/test_backup", "app/test_hybrid", "app/test_bench",
    "app/access/test_roles", "app/test_adding", "app/test_diagnoses", "app/test_older_database",
    "app/webhooks/test_webhooks", "app/access/test_audit", "app/test_contract", "app/test_own_effects",
    "app/test_size", "app/test_service", "app/test_bad_inputs", "app/test_side_by_side",
)  # fmt: skip
"""Files that take longest, those that wait for a browser or a service before the others, the dearest first.

The files of the browser stay together and go with their first. Of tests/app the
backup comes first: what it compares is all that the shared service holds.
"""


def asked_for_full(config: pytest.Config) -> bool:
    """Whether the full forms were asked for, by ``--full`` or SERVOIDENT_FULL=1."""
    return bool(config.getoption("--full")) or os.environ.get("SERVOIDENT_FULL") == "1"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Long files go first, so that no core is left alone with one at the end; then those of tests/app, on end.

    They share a service, which takes a fortieth of a core for as long as it is there, whatever runs meanwhile. What is
    marked `full` is skipped in the short form before its fixtures are made: docs/decisions/tests.md says what stands
    in for it.
    """
    if not asked_for_full(config):
        for item in items:
            if item.get_closest_marker("full"):
                item.add_marker(pytest.mark.skip(reason="run with --full: docs/decisions/tests.md"))
    places = {f"{name}.py": number for number, name in enumerate(LONGEST)}

    def turn(item: pytest.Item) -> tuple[int, int, str]:
        name = item.path.relative_to(ROOT / "tests").as_posix()
        place = places.get(name, len(places))
        return (1 if name.startswith("app/") else 0 if name in places else 2), place, name

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
