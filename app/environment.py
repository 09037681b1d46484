"""Set up the project's own environment, `.venv`, and go on inside it.

Standard library only: this runs in a bare Python before anything is installed. Packages come from a lock file with
hashes; uv installs them where it can itself be installed, else pip does. A stamp in `.venv` says what it holds, so
that the next start skips all of this.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tempfile
import time
import venv
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator, NoReturn  # noqa: UP035 - older interpreters must get as far as the message about them

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / ".venv"
WINDOWS = os.name == "nt"
PYTHON = VENV / ("Scripts/python.exe" if WINDOWS else "bin/python")
LOG = VENV / "setup.log"
OLDEST = (3, 11)
OWN = ("ident", "schemas", "app", "tests")
"""The project's own folders of modules, in the order in which they are needed."""
_compiling: list[subprocess.Popen[bytes]] = []  # processes that go on beside this one


class SetupFailed(Exception):
    """A step of the set-up failed; the text is for the user."""


def enter(lock: str, arguments: list[str]) -> NoReturn:
    """Go on as Python with `arguments` in `.venv`, which holds the packages of the file `lock`."""
    try:
        prepare(lock)
    except SetupFailed as error:
        sys.exit(f"set-up: {error}")
    except OSError as error:
        sys.exit(f"set-up: cannot prepare {VENV}: {error.strerror or error}; check its permissions and the free space")
    except KeyboardInterrupt:
        print("set-up: interrupted; start again to go on", file=sys.stderr)
        sys.exit(130)
    os.chdir(ROOT)
    command = [str(PYTHON), *arguments]
    if WINDOWS:  # whose execv starts a process beside this one and ends: the prompt would be back at once
        sys.exit(ended(command))
    os.execv(PYTHON, command)


def ended(command: list[str]) -> int:
    """Run a command to its end; its exit status. It hears Ctrl-C itself, and may have something to tidy up."""
    with subprocess.Popen(command) as process:
        while True:
            try:
                return process.wait()
            except KeyboardInterrupt:
                continue


def prepare(lock: str) -> None:
    """Make `.venv` hold the packages of `lock` and this project; does nothing where its stamp says that it does."""
    if sys.version_info < OLDEST:
        raise SetupFailed(f"this is Python {sys.version.split()[0]}, 3.11 or later is needed; start with a newer one")
    stamp = VENV / f"{lock}.stamp"
    if is_current(stamp, lock):
        return
    with only_one():
        if is_current(stamp, lock):  # another process made it while this one waited
            return
        began = time.monotonic()
        say("preparing .venv (first start, or the lock file has changed)")
        stamp.unlink(missing_ok=True)
        LOG.write_text("", encoding="utf-8")
        compile_meanwhile()
        if not has_pip():
            create()
        install(lock)
        stamp.write_text(expected(lock), encoding="utf-8")
        say(f"ready after {time.monotonic() - began:.0f} s")


def is_current(stamp: Path, lock: str) -> bool:
    """True where `.venv` was completed for this lock file, project file, interpreter and place."""
    return PYTHON.exists() and stamp.exists() and stamp.read_text(encoding="utf-8") == expected(lock)


def expected(lock: str) -> str:
    """What the stamp of a complete environment says."""
    digest = hashlib.sha256()
    for part in (ROOT / lock, ROOT / "pyproject.toml"):
        digest.update(part.read_bytes())
    return f"{digest.hexdigest()} {sys.version.split()[0]} {ROOT}\n"


@contextmanager
def only_one() -> Iterator[None]:
    """Let one process at a time prepare the environment; others wait."""
    VENV.mkdir(exist_ok=True)
    with (VENV / "setup.lock").open("wb") as handle:
        try:
            import fcntl  # noqa: PLC0415 - not on every system
        except ImportError:
            yield
            return
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say("waiting for another process that is preparing .venv")
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield


def compile_meanwhile() -> None:
    """Begin to compile the project's modules to bytecode: a core is idle while packages are fetched and unpacked.

    The bytecode is of this Python's version, as `.venv` will be. Nobody waits for it: what is not compiled yet is
    compiled where it is imported.
    """
    folders = [str(ROOT / name) for name in OWN if (ROOT / name).is_dir()]
    if folders:
        command, nothing = [sys.executable, "-m", "compileall", "-q", *folders], subprocess.DEVNULL
        _compiling.append(subprocess.Popen(command, stdin=nothing, stdout=nothing, stderr=nothing))


def has_pip() -> bool:
    """True where `.venv` is an environment of this Python version with a working pip."""
    probe = "import sys, pip; print(*sys.version_info[:2])"
    try:
        answer = subprocess.run([PYTHON, "-c", probe], capture_output=True, text=True, check=False)
    except OSError:
        return False
    return answer.stdout.split() == [str(part) for part in sys.version_info[:2]]


def create() -> None:
    """Create `.venv` with pip, also where the system's Python comes without ensurepip (as Debian's does)."""
    say(f"creating it for Python {sys.version.split()[0]}")
    builder = venv.EnvBuilder(symlinks=not WINDOWS, upgrade_deps=False)
    builder.create(VENV)
    try:
        call([str(PYTHON), "-m", "ensurepip", "--upgrade", "--default-pip"])
    except SetupFailed:
        call([sys.executable, "-m", "pip", "--python", str(PYTHON), "install", "--quiet", "pip"])


def install(lock: str) -> None:
    """Install the packages of `lock`, then the project itself without dependencies."""
    pip = [str(PYTHON), "-m", "pip", "install", "--quiet", "--no-input", "--disable-pip-version-check"]
    uv = [str(PYTHON), "-m", "uv", "pip", "install", "--quiet", "--system-certs", "--python", str(PYTHON)]
    packages = ["--require-hashes", "--requirement", str(ROOT / lock)]
    project = ["--no-deps", "--no-build-isolation", "--editable", str(ROOT)]
    count = sum("==" in line for line in (ROOT / lock).read_text(encoding="utf-8").splitlines())
    try:
        with tempfile.TemporaryDirectory() as folder:
            own = Path(folder) / "uv.txt"
            own.write_text(entry("uv", ROOT / lock), encoding="utf-8")
            call([*pip, "--require-hashes", "--requirement", str(own)])
        say(f"installing {count} packages of {lock} with uv")
        call([*uv, *packages])
        call([*uv, *project])
    except SetupFailed:
        say(f"installing {count} packages of {lock} with pip, because uv cannot (see {LOG.name})")
        call([*pip, *packages])
        call([*pip, *project])


def entry(package: str, lock: Path) -> str:
    """The lines of one package in a lock file: its pinned version and the hashes below."""
    lines = lock.read_text(encoding="utf-8").splitlines(keepends=True)
    first = next(index for index, line in enumerate(lines) if line.startswith(f"{package}=="))
    rest = next((i for i in range(first + 1, len(lines)) if not lines[i].startswith(" ")), len(lines))
    return "".join(lines[first:rest])


def call(command: list[str]) -> None:
    """Run a step, its output into the log; raises SetupFailed with the last line that tells why."""
    with LOG.open("a", encoding="utf-8", errors="replace") as log:
        print("$", *command, file=log, flush=True)
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        log.write(result.stdout + result.stderr)
    if result.returncode:
        told = [line.strip() for line in (result.stdout + result.stderr).splitlines() if line.strip()]
        errors = [line for line in told if line.lower().startswith("error")]
        reason = (errors or told or [f"{command[0]} failed"])[-1]
        raise SetupFailed(f"{reason} (all of it in {LOG})")


def say(text: str) -> None:
    """One line of progress on standard error."""
    print(f"set-up: {text}", file=sys.stderr, flush=True)
