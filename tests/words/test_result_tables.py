"""Results as tables of a notebook."""

from __future__ import annotations

from ident.words.result_tables import Listing, TabularResult, html


class Result(TabularResult):
    def listings(self):
        return [Listing("T < 1", ("run", "error"), [("<script>", "1 %")], ("error",)), "a & b"]


def test_a_result_shows_itself_with_every_text_escaped_and_without_a_colour_of_its_own():
    shown = Result()._repr_html_()
    assert "T &lt; 1" in shown
    assert '<td style="text-align: left">&lt;script&gt;</td>' in shown
    assert '<td style="text-align: right">1 %</td>' in shown
    assert "<p>a &amp; b</p>" in shown
    assert "color" not in shown
    assert shown == html(Result().listings())
