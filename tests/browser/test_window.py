"""A browser that hangs holds no test up for ever."""

from __future__ import annotations

from tests.browser import window as module


def test_a_browser_that_hangs_is_ended_and_another_begun(page, site, window, monkeypatch):
    """What never comes is waited for, as a page is that does not close."""
    page.goto(f"{site.address}/")
    monkeypatch.setattr(module, "LONGEST", 0.5)
    with window.in_time():
        page.evaluate("() => new Promise(() => {})")
    assert window.page is not page
    window.page.goto(f"{site.address}/")
    assert "servoident" in window.page.content()
