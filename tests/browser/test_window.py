"""A browser that hangs holds no test up for ever."""

from __future__ import annotations

from tests.browser import window


def test_a_browser_that_hangs_is_ended_and_another_begun(page, site, of_file, monkeypatch):
    """What never comes is waited for, as a page is that does not close."""
    page.goto(f"{site.address}/")
    before = of_file.context
    monkeypatch.setattr(window, "LONGEST", 0.5)
    with of_file.in_time():
        page.evaluate("() => new Promise(() => {})")
    assert of_file.context is not before
    fresh = of_file.context.new_page()
    fresh.goto(f"{site.address}/")
    assert "servoident" in fresh.content()
