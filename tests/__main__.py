"""`python3 -m tests`: set up what is needed, then run the tests; arguments go to pytest."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from app.environment import enter, say

SYSTEM_PACKAGES = {
    "chromium-headless-shell": "usr/bin/chromium-headless-shell",
    "postgresql": "usr/lib/postgresql/*/bin/pg_ctl",
}
"""Debian packages that some tests need, and the program by which each is known; chromium will do, but takes longer."""
APT = ["apt-get", "-o", "Acquire::Retries=0", "-o", "Acquire::http::Timeout=20"]  # s: without a network it soon ends


def install_system_packages() -> None:
    """Install what is missing, where this user may; the tests that need the rest skip and say why."""
    missing = [name for name, program in SYSTEM_PACKAGES.items() if not any(Path("/").glob(program))]
    if not missing:
        return
    if shutil.which("apt-get") is None or os.geteuid() != 0:
        say(f"not installed: {', '.join(missing)} (this needs apt-get and root); tests that need it are skipped")
        return
    say(f"installing {', '.join(missing)} with apt-get")
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for command in ([*APT, "update"], [*APT, "install", "-y", "--no-install-recommends", *missing]):
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
        )
        if done.returncode:
            reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
            say(f"apt-get {command[len(APT)]} failed: {reason}; tests that need {', '.join(missing)} are skipped")
            return


if __name__ == "__main__":
    install_system_packages()
    # A worker a core, and one more while others wait; the tests of a file share what they set up; files in the order
    # of tests/conftest.py.
    everything = ["--workers", str((os.cpu_count() or 1) + 1)]
    chosen = sys.argv[1:]
    of_whole = all(argument == "--full" or argument.startswith("--costs=") for argument in chosen)
    whole = [*everything, *chosen] if of_whole else chosen
    if whole is not chosen:  # every core has its worker: threads of linear algebra would only wait for one another
        os.environ.setdefault("OMP_NUM_THREADS", "1")
    enter("requirements-tests.lock", ["-m", "pytest", *whole])
