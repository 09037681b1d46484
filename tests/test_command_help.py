"""The list of the commands: each under a heading, on one line of eighty characters."""

from __future__ import annotations

import pytest
import typer

from app.cli.program import BELOW, GROUPS, commands


@pytest.fixture
def listed(monkeypatch: pytest.MonkeyPatch) -> str:
    """What `servoident --help` prints on a terminal of eighty columns."""
    monkeypatch.setenv("COLUMNS", "80")
    group = commands()
    return group.get_help(typer.Context(group))


def test_every_command_is_listed_once_and_not_cut(listed: str) -> None:
    names = [function.__name__.rstrip("_") for functions in GROUPS.values() for function in functions]
    names += [name for below in BELOW.values() for name in below]
    group = commands()
    assert sorted(names) == sorted(group.commands)
    for name in names:
        assert sum(line.startswith(f"  {name} ") for line in listed.splitlines()) == 1, name
    assert "..." not in listed.partition("Data:")[2]
