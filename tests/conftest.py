"""What several test folders share: the command line, the measured data, the long forms of slow tests."""

from __future__ import annotations

import contextlib
import gc
import io
import logging
import os
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from tests.dearest import (  # noqa: F401  hooks
    pytest_runtest_logstart,
    pytest_runtest_makereport,
    pytest_runtest_teardown,
    pytest_terminal_summary,
)
from tests.rounding import rounded_otherwise

ROOT = Path(__file__).resolve().parents[1]

# Two dozen processes are started, and where nothing may be kept each compiles every module that it imports: 6 s.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# A warning of a number ends the processes that tests start, too; those of the tests themselves: pyproject.toml.
os.environ["PYTHONWARNINGS"] = "error::RuntimeWarning"

# What is imported and collected stays, and with all tests in memory each search of the collector through everything
# takes a tenth of a second and more.
gc.set_threshold(1_000_000, 20, 50)


def pytest_collection_finish() -> None:
    """Loops of the references are compiled once for all processes, though they know nothing of the library's way.

    What is there before the first test stays: the collector need not look through it again.
    """
    for name, module in list(sys.modules.items()):
        if name.startswith("tests.reference."):
            from ident.simulation.jit import shared

            for function in vars(module).values():
                if hasattr(function, "py_func"):
                    shared(function)
    gc.freeze()
    gc.set_threshold(50_000, 20, 50)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--full", action="store_true", help="run the acceptance tests at full length (many minutes)")


LONGEST = (
    "browser/test_workbench", "browser/test_monkey", "app/test_hybrid", "diagnosis/test_total_delay", "test_project",
    "bench/test_acceptance", "cli/test_service_commands", "cli/test_postgresql", "faults/test_workers",
    "test_readme", "test_site", "diagnosis/test_time_budget", "app/test_own_effects", "faults/test_kill",
    "test_windows", "acceptance/test_measured", "test_additions", "cli/test_effects", "fit/test_fifth_order",
    "test_wheel", "diagnosis/test_structure_selection", "app/test_older_database", "diagnosis/discovery/test_search",
    "app/test_contract", "diagnosis/discovery/test_free_curves", "cli/test_commands", "app/test_diagnoses",
    "app/backup/test_backup", "readers/test_random_tables", "app/test_bench", "fit/test_end_stops",
    "presets/test_machines", "diagnosis/test_diagnose", "test_notebooks", "fit/test_beginnings",
    "bench/test_procedures", "acceptance/test_identification", "bench/test_recovery", "fit/test_windows",
    "bench/test_diagnosis", "bench/test_figures", "cli/test_diagnose", "bench/test_identification",
    "effects/test_contract", "faults/test_mixed_load", "effects/test_every_pair", "app/test_service",
    "cli/test_any_machine", "bench/test_continued", "checks/test_check", "app/test_adding", "app/access/test_roles",
    "faults/test_older_jobs", "acceptance/test_rounding", "residuals/test_curves", "bench/test_calibration",
    "readers/test_damage", "app/test_demo", "readers/test_lab_formats", "hybrid/test_what_if",
)  # fmt: skip
"""Files that take longest, the longest first; the files of the browser stay together and go with their first."""

OWN_SERVICE = "tests/browser/test_workbench.py"
"""Has a service of its own, and takes so long that it has a worker to itself."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Long files go first, so that no core is left alone with one at the end."""
    place = {f"{name}.py": number for number, name in enumerate(LONGEST)}
    items.sort(key=lambda item: place.get(item.path.relative_to(ROOT / "tests").as_posix(), len(place)))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """A file's tests stay on one worker; those of the browser too, which share a service and its window."""
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = super()._split_scope(nodeid)
            return "browser" if file.startswith("tests/browser/") and file != OWN_SERVICE else file

    return Scheduling(config, log) if config.getvalue("dist") == "loadfile" else None


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
    return bool(request.config.getoption("--full")) or os.environ.get("SERVOIDENT_FULL") == "1"


FEW = {
    "backlash", "coulomb_friction", "dead_zone", "gain_asymmetry", "null_bias", "pressure_flow", "quadratic_damping",
    "sensor_lag",
}  # fmt: skip


@contextlib.contextmanager
def of_few_effects(full: bool, *beside: str) -> Iterator[None]:
    """In the short form a diagnosis ranks eight effects of the catalogue, of several places, and those named `beside`.

    The whole catalogue takes several times as long, and half a minute where its kernels have to be compiled.
    """
    with pytest.MonkeyPatch.context() as own:
        if not full:
            from ident.diagnosis import candidate_models

            named = FEW | {*beside}
            few = tuple(effect for effect in candidate_models.CATALOGUE if effect.name in named)
            assert len(few) == len(named)
            own.setattr(candidate_models, "CATALOGUE", few)
        yield


@pytest.fixture
def few_effects(full: bool) -> Iterator[None]:
    """For a test whose point is another than the whole catalogue."""
    with of_few_effects(full):
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
            main([str(argument) for argument in arguments])
        assert "Warning" not in err.getvalue()
        return Outcome(ended.value.code, out.getvalue(), err.getvalue())

    yield run
    own.undo()
