"""The way through library, commands and service in a Python that lacks what Windows lacks: `FOLDER [--full]`.

What is deleted here is what the documentation of Python marks as "Availability: Unix" and this program, or one that
it is built on, could reach for. Writing text in an encoding that is not named is an error too: Windows has its own.
"""

from __future__ import annotations

import asyncio  # noqa: F401  in its form for this system it needs what is deleted, as do the next
import os
import shutil
import signal
import subprocess  # noqa: F401
import sys
import time
import warnings

import numpy as np  # noqa: F401
import platformdirs  # noqa: F401

OF_OS = (
    "chown", "fchmod", "fchown", "fork", "forkpty", "getegid", "geteuid", "getgid", "getloadavg", "getpgid", "getpgrp",
    "getpriority", "getsid", "getuid", "killpg", "lchown", "lockf", "mkfifo", "nice", "pread", "pwrite",
    "sched_getaffinity", "sched_setaffinity", "sched_yield", "setgid", "setpgid", "setpriority", "setsid", "setuid",
    "statvfs", "sync", "sysconf", "uname", "wait", "wait3", "wait4",
    "O_CLOEXEC", "O_DIRECTORY", "O_NOFOLLOW", "O_NONBLOCK",
)  # fmt: skip
OF_SIGNAL = ("SIGALRM", "SIGHUP", "SIGKILL", "SIGPIPE", "SIGQUIT", "SIGUSR1", "SIGUSR2", "alarm", "pause", "setitimer")
MODULES = ("fcntl", "grp", "pty", "pwd", "readline", "resource", "syslog", "termios", "tty")

room = shutil._ntuple_diskusage(1 << 40, 0, 1 << 40)  # type: ignore[attr-defined]
shutil.disk_usage = lambda _: room  # type: ignore[assignment]  here by statvfs, which Windows does without
for name in OF_OS:
    delattr(os, name)
for name in OF_SIGNAL:
    delattr(signal, name)
del time.tzset
sys.modules.update(dict.fromkeys(MODULES))  # to import one of them is an ImportError
warnings.filterwarnings("error", category=EncodingWarning, module=r"(app|ident|schemas|migrations)\.")

from pathlib import Path  # noqa: E402

import yaml  # noqa: E402
from fastapi.testclient import TestClient  # noqa: E402

from app.cli.program import main  # noqa: E402
from app.main import create_app  # noqa: E402
from app.settings import Settings  # noqa: E402
from ident.diagnosis import candidate_models  # noqa: E402
from ident.simulation.cache import cache_folder  # noqa: E402

candidate_models.CATALOGUE = candidate_models.CATALOGUE[::11]  # type: ignore[misc]  few of it take the same way
SMALL = ("--option", "population=20", "--option", "generations=2")
HEADERS = {"Authorization": "Bearer token"}


def command(*arguments: object) -> None:
    """Run a command; whatever its failure is ends this process."""
    try:
        main([str(argument) for argument in arguments])
    except SystemExit as ended:
        if ended.code:
            raise


def commands(folder: Path, full: bool) -> Path:
    """Simulate, check, in the full form fit and diagnose; the matrix."""
    matrix = folder / "matrix"
    command("simulate", matrix, "--small", "--seconds", 0.25, *(("--effect", "coulomb_friction") if full else ()))
    few(matrix / "matrix.yaml")
    command("check", matrix)
    if full:
        command("fit", matrix, "--json", folder / "fit.json", *SMALL)
        command("diagnose", matrix, "--fit", folder / "fit.json", "--max-effects", 1, "--json", "-")
    return matrix


def few(description: Path) -> None:
    """Keep every fourth run."""
    whole = yaml.safe_load(description.read_text(encoding="utf-8"))
    whole["runs"] = whole["runs"][::4]
    description.write_text(yaml.safe_dump(whole), encoding="utf-8")


def served(folder: Path, matrix: Path, full: bool) -> None:
    """A service that starts, takes the matrix, fits it and stops; in the full form it draws the fit and shows it."""
    files = [("files", (str(path.relative_to(matrix)), path.read_bytes())) for path in matrix.rglob("*.*")]
    with TestClient(create_app(Settings(data=folder / "data", token="token")), "http://127.0.0.1:8000") as client:
        client.headers = HEADERS
        stored = client.post("/api/v1/matrices", files=files).json()
        wanted = {"matrix": stored["id"], "options": {"population": 20, "generations": 2}}
        job = client.post("/api/v1/fits", json=wanted, headers={"Idempotency-Key": "once"}).json()["id"]
        assert '"state":"succeeded"' in client.get(f"/api/v1/jobs/{job}/events").text
        for place in (f"/api/v1/fits/{job}/figures/evolution.svg", f"/fits/{job}") if full else ():
            assert client.get(place).status_code == 200


if __name__ == "__main__":
    work, whole = Path(sys.argv[1]), "--full" in sys.argv[2:]
    served(work, commands(work, whole), whole)
    print("cache:", cache_folder())
    print("τ")  # which the code page lacks: commands, too, print what they say
