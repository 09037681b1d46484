"""The units and the compose file, read by their own tools where those are there: their commands are the program's."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml
from typer.testing import CliRunner

from app.cli.program import program
from tests.conftest import ROOT

UNITS = sorted((ROOT / "docs" / "systemd").glob("*.service"))


def known(words: list[str]) -> None:
    """The command has every option that is given to it."""
    told = CliRunner().invoke(program, [words[0], "--help"], env={"COLUMNS": "200"})
    assert told.exit_code == 0, words
    for option in (word for word in words if word.startswith("--")):
        assert re.search(rf"{option}\b", told.stdout), option


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.name)
def test_a_unit_is_sound_and_runs_a_command_of_the_program(unit: Path, tmp_path: Path) -> None:
    text = unit.read_text(encoding="utf-8")
    command = re.search(r"^ExecStart=\S+/servoident (.*)$", text, re.MULTILINE)
    assert command is not None
    known(shlex.split(command[1]))
    if shutil.which("systemd-analyze") is None:
        pytest.skip("systemd-analyze is not here: only its command was checked")
    here = tmp_path / unit.name.replace("@", "@one")
    here.write_text(re.sub(r"^ExecStart=\S+", "ExecStart=/bin/true", text, flags=re.MULTILINE), encoding="utf-8")
    done = subprocess.run(["systemd-analyze", "verify", here], capture_output=True, text=True, check=False)
    assert unit.stem not in done.stderr, done.stderr


def test_the_compose_file_runs_commands_of_the_program() -> None:
    """Every setting in it is one that the program reads."""
    services = yaml.safe_load((ROOT / "docs" / "compose.yaml").read_text(encoding="utf-8"))["services"]
    for name in ("service", "worker"):
        words = shlex.split(
            services[name]["command"].replace("sh -c 'exec ", "").rstrip("'").replace("$$(hostname)", "x")
        )
        assert words[0] == "servoident"
        known(words[1:])
        own = [setting for setting in services[name]["environment"] if setting.startswith("SERVOIDENT_")]
        source = "".join(file.read_text(encoding="utf-8") for file in (ROOT / "app").rglob("*.py"))
        assert all(setting in source for setting in own)
