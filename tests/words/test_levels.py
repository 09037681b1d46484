"""Levels of findings and uses of runs, as a reader reads them."""

from __future__ import annotations

from ident.run import USES
from ident.words.severity import level, levels
from ident.words.titles import DATA, data, runs


def test_levels_are_those_of_a_compiler_the_worst_first():
    """Files and JSON keep the names on the left."""
    assert [level(name) for name in ("fault", "doubt", "note")] == ["error", "warning", "note"]
    assert levels(["note", "doubt", "fault", "doubt"]) == "1 error, 2 warnings, 1 note"
    assert levels(["note"], all_of=True) == "0 errors, 0 warnings, 1 note"
    assert levels([]) == ""


def test_every_use_has_the_fields_word():
    assert {*USES} <= {*DATA}
    assert [data(use) for use in DATA] == ["estimation data", "held-out data", "validation data"]
    assert runs("verify") == "validation runs"
