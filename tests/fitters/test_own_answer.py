"""The comparison of methods by their own answers: that these are the methods' own, and the page's."""

from __future__ import annotations

import pytest

from tests.acceptance.matrices import as_matrix
from tests.fitters.__main__ import PAGE, QIAN, renewed, table
from tests.fitters.own_answer import OwnAnswer, of_qian, off
from tests.reference import qian_reference


def test_an_own_answer_is_not_refined():
    """Of four short runs: the paper's search ends far above the noise, where a refined fit ends at it."""
    plant = qian_reference.Plant()
    records = qian_reference.measure_all(
        plant, qian_reference.trials()[:63:16], seconds=1.0, noise=0.005, seed=1, hold="linear"
    )
    few = as_matrix(records, "linear")
    found = of_qian(few, "paper-ga", 0, {"Z0": plant.Z0})
    assert found.error > 0.01
    assert found.evaluations > 1000
    assert found.seconds > 0


def test_a_table_has_medians_and_times_relative_to_ga():
    """Odd numbers of answers, so that a median is one of them; a page keeps what stands outside its marks."""
    rows = [("ga", [OwnAnswer(0.01, 0.2, 100, 2.0)] * 3), ("paper-ga", [OwnAnswer(e, 0.5, 10, 1.0) for e in (3, 1, 2)])]
    text = table(rows)
    assert "| `paper-ga` | 200 % | 50 % | 10 | 0.5 |" in text
    page = "before\n<!-- x -->\nold\n<!-- end of x -->\nafter"
    assert renewed(page, "x", text) == page.replace("old", text)
    with pytest.raises(ValueError, match="no marks"):
        renewed(page, "y", text)
    assert off({"a": 1.1, "b": 2.0}, {"a": 1.0, "b": 2.0}) == pytest.approx(0.1)


def test_the_page_has_a_row_for_each_method():
    """So that a method that is added is measured, too."""
    said = PAGE.read_text(encoding="utf-8").partition("<!-- fitters of qian2014 -->")[2].partition("<!-- end")[0]
    assert [f"| `{method}` |" in said for method in QIAN] == [True] * len(QIAN)
