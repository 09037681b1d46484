"""One run whose unit is wrong, of a machine in open loop; the records are of labs with recursions of their own."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ident.checks.check import check
from ident.matrix import Matrix
from tests.blind.any_machine import Lab
from tests.short_form import short_form


def doubted(matrix: Matrix) -> list[str | None]:
    return [finding.run for finding in check(matrix) if finding.code == "scale"]


@pytest.mark.parametrize("seed", short_form([5, 17, 30], 5))
def test_millimetres_called_centimetres_are_doubted(seed):
    matrix = Lab.drawn(seed, hidden=True).measured()
    first, second, last = matrix.runs
    assert doubted(matrix) == []
    farther = replace(last, channels={**last.channels, last.output: 10.0 * last.measured})
    assert doubted(replace(matrix, runs=(first, second, farther))) == [last.id]
    assert doubted(replace(matrix, runs=(first, farther))) == [last.id]


@pytest.mark.full
def test_what_is_hidden_in_a_machine_makes_no_such_difference():
    for seed in range(4000, 4100):
        matrix = Lab.drawn(seed, hidden=True).measured()
        first, second, last = matrix.runs
        small = replace(
            last, channels={**last.channels, "command": 0.3 * last.command, last.output: 0.2 * last.measured}
        )
        assert doubted(replace(matrix, runs=(first, second, small))) == [], seed
