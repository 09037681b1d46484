"""The commands of the README run as they stand, one after the other in one terminal, beside the running demo."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.running import LITTLE, command, free_port, nursery

ROOT = Path(__file__).resolve().parents[1]
SLOW = {"compare", "diagnose", "report"}
"""Commands of the README that take long: run in the long form, in the short form only read."""


def lines() -> list[str]:
    """The indented lines below *Command line*, without their comments."""
    section = (ROOT / "README.md").read_text().partition("## Command line\n")[2].partition("\n## ")[0]
    return [shlex.join(shlex.split(line, comments=True)) for line in re.findall(r"^    (.+)$", section, re.MULTILINE)]


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """That of a new user whose demo runs: a home of their own, nothing set."""
    home = tmp_path_factory.mktemp("home")
    named = {"XDG_DATA_HOME": str(home / "data"), "XDG_STATE_HOME": str(home / "state")}
    with pytest.MonkeyPatch.context() as own:
        for name in ("SERVOIDENT_DATA", "SERVOIDENT_TOKEN", "SERVOIDENT_SERVER", "SERVOIDENT_DATABASE"):
            own.delenv(name, raising=False)
        for name, value in named.items():
            own.setenv(name, value)
        with command("demo", "--port", free_port(), until="token="):
            yield {**os.environ}


STAND_IN = """servoident() {
  printf '%s\\0' "$@" > "$STAND_IN/asked"
  read -r status < "$STAND_IN/ended"
  cat "$STAND_IN/said"
  cat "$STAND_IN/errors" >&2
  return "$status"
}
"""
"""The program as a function of the shell: what it is asked goes to a fork of one that has imported it already."""


@contextmanager
def standing_in(folder: Path, environment: dict[str, str]) -> Iterator[dict[str, str]]:
    """The environment of a shell in which the function above is answered, by fits that search shortly."""
    asked, ended = folder / "asked", folder / "ended"
    for pipe in (asked, ended):
        os.mkfifo(pipe)

    def answer() -> None:
        while given := asked.read_text():
            said, errors = folder / "said", folder / "errors"
            for text in (said, errors):
                text.write_text("")
            name, *arguments = given.split("\0")[:-1]
            first = LITTLE if name == "fit" else ""
            number = nursery().start(said, name, *arguments, first=first, stderr=errors, environment=environment)
            ended.write_text(f"{nursery().ended(number)}\n")

    answering = threading.Thread(target=answer, daemon=True)
    answering.start()
    yield environment | {"STAND_IN": str(folder)}
    asked.write_text("")
    answering.join()


def test_the_lines_run_as_they_stand_in_one_terminal(
    environment: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, full: bool
) -> None:
    """In their order, in one shell that stops at the first failure; the last ones reach the demo by themselves.

    In the short form no line starts an interpreter, and a fit searches shortly.
    """
    (tmp_path / ".venv").symlink_to(sys.prefix)
    (tmp_path / "pipes").mkdir()
    monkeypatch.chdir(tmp_path)
    given = lines()
    assert given[0] == ". .venv/bin/activate"
    assert {line.split()[1] for line in given[1:]} >= {"simulate", "check", "fit", "diagnose", "upload", "query"}
    run = [line for line in given if full or line.split()[1] not in SLOW]
    with standing_in(tmp_path / "pipes", environment) as shell:
        done = subprocess.run(
            ["bash", "-e"],
            input="\n".join([*([] if full else [STAND_IN]), *run]),
            env=shell,
            capture_output=True,
            text=True,
            check=False,
        )
    assert done.returncode == 0, done.stderr
    uploaded, _, listed = done.stdout.partition(": 27 runs, new")
    assert re.search(r"matrix \w+ of SIM-0003$", uploaded)
    assert re.search(r"SIM-0001 +\w+ +qian2014", listed)
    assert (tmp_path / "better.json").exists()


def test_the_rate_of_the_blind_trials_is_that_of_their_table() -> None:
    """One effect hidden in a small matrix."""
    (rate,) = re.findall(r"named in (\d+ of \d+) small data sets", (ROOT / "README.md").read_text())
    assert f"| one effect hidden | small | {rate} |" in (ROOT / "docs" / "blind-trials.md").read_text()


def test_every_line_is_one_that_the_command_line_takes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also those that the short form does not run: each option is there, each argument of its kind."""
    from app.cli.program import commands

    monkeypatch.chdir(tmp_path)
    (tmp_path / "demo").mkdir()
    (tmp_path / "fit.json").write_text("{}")
    group = commands()
    for line in lines()[1:]:
        _, name, *arguments = shlex.split(line)
        group.commands[name].make_context(name, arguments)
