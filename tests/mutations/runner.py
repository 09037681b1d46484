"""Put each defect into a copy of the source and see its tests fail.

The tests have to pass on the copy as it is. One defect at a time, its tests until the first that fails; the table says
which test that was.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.mutations import MUTATIONS
from tests.mutations.mutation import ROOT, Mutation

LEFT_OUT = shutil.ignore_patterns(".git", ".venv", "build", "__pycache__", ".*_cache", ".hypothesis")
OUTCOMES = {0: "SURVIVED", 1: "killed"}  # of pytest: all passed, some failed; whatever else is a fault of the list


def copied(folder: Path) -> Path:
    """A copy of the checkout, with the measured data beside it as here."""
    copy = folder / ROOT.name
    shutil.copytree(ROOT, copy, ignore=LEFT_OUT)
    if (ROOT.parent / "shared").is_dir():
        (folder / "shared").symlink_to(ROOT.parent / "shared")
    return copy


def tested(copy: Path, tests: tuple[str, ...]) -> tuple[int, str]:
    """Pytest's answer on the copy, and the first test that failed."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
    environment = os.environ | {"XDG_CACHE_HOME": str(copy.parent / "cache"), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    done = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    failed = re.search(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.M)
    return done.returncode, failed[1] if failed else ""


def outcome(copy: Path, mutation: Mutation, number: int) -> tuple[str, str]:
    """What became of a defect, and the test that found it."""
    file = copy / mutation.file
    sound, changed = file.read_text(encoding="utf-8"), mutation.changed(copy)
    try:
        _written(file, changed, 2 * number + 1)
        returncode, failed = tested(copy, mutation.tests)
    finally:
        _written(file, sound, 2 * number + 2)
    return OUTCOMES.get(returncode, f"NOT TESTED (pytest ended with {returncode})"), failed


def _written(file: Path, text: str, version: int) -> None:
    """Compiled code is told from old by the file's time in whole seconds: each version has its own."""
    file.write_text(text, encoding="utf-8")
    later = file.stat().st_mtime + 10 * version
    os.utime(file, (later, later))


def main(names: list[str]) -> int:
    """Print the table; 1 where a defect was not found."""
    unknown = set(names) - {mutation.name for mutation in MUTATIONS}
    if unknown:
        sys.exit(f"there is no mutation {', '.join(sorted(unknown))}")
    chosen = [mutation for mutation in MUTATIONS if not names or mutation.name in names]
    with tempfile.TemporaryDirectory() as folder:
        copy = copied(Path(folder))
        returncode, failed = tested(copy, tuple(dict.fromkeys(test for one in chosen for test in one.tests)))
        if returncode:
            sys.exit(f"the tests do not pass without a defect: {failed or returncode}")
        print("| mutation | file | what is wrong | outcome | found by |\n|---|---|---|---|---|")
        found = []
        for number, one in enumerate(chosen):
            found.append(outcome(copy, one, number))
            print(f"| {one.name} | {one.file} | {one.why} | {found[-1][0]} | {found[-1][1]} |", flush=True)
    killed = sum(word == "killed" for word, _ in found)
    print(f"\n{killed} of {len(found)} killed")
    return int(killed < len(found))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
