"""The list of mutations does not rot: each still has its place in the source, and tests that exist."""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path

import pytest

from tests.mutations import MUTATIONS
from tests.mutations.mutation import ROOT
from tests.mutations.runner import main


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_a_mutation_still_has_its_place(mutation):
    """Its old text stands once in its file, the changed file can be read, and each of its tests is defined."""
    if mutation.file.endswith(".py"):
        ast.parse(mutation.changed())
    assert mutation.changed() != (ROOT / mutation.file).read_text(encoding="utf-8")
    assert mutation.tests
    for test in mutation.tests:
        file, _, name = test.partition("::")
        assert not name or f"def {name.partition('[')[0]}(" in Path(ROOT, file).read_text(encoding="utf-8"), test


def test_there_are_enough_and_no_two_of_one_name():
    assert len(MUTATIONS) >= 25
    assert max(Counter(mutation.name for mutation in MUTATIONS).values()) == 1


def test_every_mutation_is_killed(full):
    """The tests of the short form find every one."""
    if not full:
        pytest.skip("minutes long: run with --full, or python3 -m tests.mutations")
    assert main([]) == 0
