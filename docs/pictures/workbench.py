"""Remake the pictures of the pages in README: `python -m docs.pictures.workbench` (some minutes; needs chromium).

A matrix is simulated with a dead zone and dry friction that the model does not know, and led through the pages of a
service of its own, as the tests do it: uploaded, fitted, asked what is missing, mended. The first page is the demo's.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from playwright.sync_api import Browser, Page, expect, sync_playwright

from docs.pictures.remake import packed
from ident.synthesis.matrix import simulate_matrix
from tests.browser import story
from tests.browser.conftest import CHROMIUM
from tests.browser.looks import drawn
from tests.running import Service, command, free_port, process

HERE = Path(__file__).parent
HIDDEN = {"dead_zone.half_width": 6e-5, "coulomb_friction.force": 150.0}
FIGURE = "#figure-residual-curve"


def main() -> None:
    """Simulate, serve, photograph."""
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        folder = Path(name)
        simulate_matrix(folder / "matrix", seconds=1, seed=1, effects=HIDDEN)
        archive = Path(shutil.make_archive(str(folder / "matrix"), "zip", folder / "matrix"))
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        with process(folder / "data") as service:
            page = browser.new_page(viewport={"width": 1280, "height": 900}, color_scheme="light")
            page.set_default_timeout(story.LONG)
            page.goto(f"{service.address}/?token={service.token}")
            photograph(page, service, archive)
        first_page(browser, folder)
        browser.close()


def first_page(browser: Browser, folder: Path) -> None:
    """The demo's, once both of its actuators are identified."""
    with command("demo", "--port", free_port(), "--data", folder / "demo", until="token=") as line:
        service = Service.that_said(line)
        page = browser.new_page(viewport={"width": 1280, "height": 670}, color_scheme="light")
        page.goto(f"{service.address}/?token={service.token}")
        page.get_by_role("link", name="Search for missing effects").wait_for(timeout=story.LONG)
        keep("first", page.screenshot())


def photograph(page: Page, service: Service, archive: Path) -> None:
    """The way of a matrix through the pages, a picture at each station."""
    story.upload(page, service, archive)
    expect(page.locator("#run-8 img")).to_have_js_property("naturalWidth", 160)
    keep("matrix", page.screenshot(clip={"x": 0, "y": 0, "width": 1280, "height": 720}))
    story.fit(page)
    page.get_by_role("link", name="Residuals").click()
    page.locator("#tab-residual-curve").click()
    page.locator(f"{FIGURE} canvas").wait_for()
    drawn(page, "light")
    keep("fails", page.locator("section[aria-labelledby=fails]").screenshot())
    card = story.search(page, patience=10 * story.LONG)
    card.locator(".evidence .plot").scroll_into_view_if_needed()
    card.locator(".evidence canvas").wait_for()
    for theme, name in (("light", "missing"), ("dark", "missing-dark")):
        page.emulate_media(color_scheme=theme)
        drawn(page, theme)
        keep(name, first_cards(page))
    page.emulate_media(color_scheme="light")
    story.add(page, card)
    page.get_by_role("link", name="History").click()
    page.locator("#figure-ladder").scroll_into_view_if_needed()
    page.locator("#figure-ladder canvas").wait_for()
    drawn(page, "light")
    keep("ladder", page.locator("section[aria-labelledby=ladder-title]").screenshot())


def first_cards(page: Page) -> bytes:
    """The verdict and the first row of cards: the rest is more of the same."""
    page.evaluate("scrollTo(0, 0)")
    whole, card = page.locator("#missing").bounding_box(), page.locator(".cards > .card").first.bounding_box()
    assert whole is not None
    assert card is not None
    return page.screenshot(full_page=True, clip={**whole, "height": card["y"] + card["height"] + 8 - whole["y"]})


def keep(name: str, png: bytes) -> None:
    """Store a picture, as small as it gets."""
    (HERE / f"workbench-{name}.png").write_bytes(packed(png))


if __name__ == "__main__":
    main()
