"""How a page looks: in both themes, at a desk and on a phone nothing sticks out, and axe-core finds no barrier."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from axe_playwright_python.base import AXE_SCRIPT
from playwright.sync_api import Page, ViewportSize, expect

from tests.browser.story import LONG

WIDTHS = (1280, 820)
PHONE: ViewportSize = {"width": 390, "height": 844}
COLOURS = ("color-contrast", "link-in-text-block")  # axe's rules of colour: a theme changes nothing else
DRAWING = ".plot[aria-busy=true]:visible"


def drawn(page: Page, theme: str) -> None:
    """Wait until no figure in sight is half done, or of another theme: its canvas is another one after the change.

    The browser tells a page of a change with its next frame: until then a figure stands as it was, and is not busy.
    """
    old = f".figure:not([data-drawn*='theme={theme}']) .plot[aria-busy]:visible"
    for waiting in (old, DRAWING):
        expect(page.locator(waiting)).to_have_count(0, timeout=LONG)


def everywhere(page: Page, folder: Path | None, name: str, dark: bool = False) -> None:
    """Check the page as it is now, and leave screenshots of all of it in the folder, if there is one.

    Without a folder one width a theme does, and the dark one is for the pages of which it is asked: each draws every
    figure anew.
    """
    for theme, rules, width_of_it in zip(("light", "dark"), ((), COLOURS), WIDTHS, strict=True):
        if theme == "dark" and not (dark or folder):
            return
        page.emulate_media(color_scheme=theme)
        for width in WIDTHS if folder else (width_of_it,):
            page.set_viewport_size({"width": width, "height": 900})
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            drawn(page, theme)
            if folder:
                page.screenshot(path=folder / f"{name}-{width}-{theme}.png", full_page=True)
        found = barriers(page, rules)
        assert not found, "\n".join([f"{name}, {theme}", *found])


def on_a_phone(page: Page, folder: Path | None, name: str) -> None:
    """The page does not scroll sideways; what can be pressed is 24 px large, or has so much room; all of it is open."""
    page.set_viewport_size(PHONE)
    for closed in page.locator("details:not([open]) > summary").all():
        if closed.is_visible():
            closed.click()
    expect(page.locator(DRAWING)).to_have_count(0, timeout=LONG)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    assert barriers(page, ("target-size",)) == []
    if folder:
        page.screenshot(path=folder / f"phone-{name}.png", full_page=True)


def barriers(page: Page, rules: Sequence[str] = ()) -> list[str]:
    """Rule, element and reason of each violation, of all rules or some; the debugger puts axe in, past the policy."""
    options: dict[str, Any] = {"resultTypes": ["violations"], "selectors": False}
    if rules:
        options |= {"runOnly": {"type": "rule", "values": list(rules)}}
    if not page.evaluate("'axe' in globalThis"):
        page.evaluate(AXE_SCRIPT)
    found: list[dict[str, Any]] = page.evaluate(
        "options => axe.run(document, options).then(({ violations }) => violations)", options
    )
    return [f"{rule['id']}: {node['html'][:200]}: {node['failureSummary']}" for rule in found for node in rule["nodes"]]
