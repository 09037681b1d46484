"""The page of measured machines can be made anew one machine after the other."""

from __future__ import annotations

from tests.measured.page import line, renewed

HEADER = ("machine", "errors")
PAGE = "By hand.\n\n<!-- table -->\n"


def test_a_machine_that_is_not_run_anew_keeps_its_row_and_its_text():
    first = renewed(
        PAGE, HEADER, {"a": line(("a", "1 %")), "b": line(("b", "2 %"))}, {"a": "**a.** Old.", "b": "**b.** B."}
    )
    second = renewed(
        first, HEADER, {"a": line(("a", "3 %")), "c": line(("c", "4 %"))}, {"a": "**a.** New.", "c": "**c.** C."}
    )
    table = "| machine | errors |\n| --- | --- |\n| a | 3 % |\n| b | 2 % |\n| c | 4 % |\n"
    assert second == f"{PAGE}\n{table}\n**a.** New.\n\n**b.** B.\n\n**c.** C.\n"
