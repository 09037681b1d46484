"""Every page on a phone: nothing sticks out, what can be pressed is large enough, and a canvas says what it shows."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from tests.app.access.table import PAGES
from tests.app.access.test_audit import RAW
from tests.browser.looks import DRAWING, barriers
from tests.running import Service

PHONE = {"width": 390, "height": 844}
SHOWN = [call for call in PAGES if call.method == "GET" and not re.search(r"\.svg|\.json", call.path)]
"""Every page of the service: the table of who may call what is complete, which tests/app/access holds."""


@pytest.fixture(scope="session")
def addresses(site: Service, matrix: str, fitted: str) -> dict[str, str]:
    """The address of each page, with something on it, by its route."""
    draft = site.client.post("/drafts", files={"files": ("run.csv", RAW)}).json()["id"]
    regression = site.client.post("/regressions", json={"serial": "nobody"}).json()["id"]
    job = site.client.post("/fits", json={"matrix": matrix, "seed": 21}).json()["id"]
    site.ended(job)
    about = {
        "serial": "SW/1%20%3Cb%3E", "matrix": matrix, "fit": fitted, "draft": draft, "regression": regression,
        "job": job, "path": "nothing/here", "name": "cli",
    }  # fmt: skip
    return {call.path: f"{call.path.format(**about)}?{call.query.format(**about)}" for call in SHOWN}


@pytest.mark.parametrize("path", [call.path for call in SHOWN])
def test_a_page_fits_a_phone(path, page, watch, site, addresses, screenshots):
    """The page does not scroll sideways; what can be pressed is 24 px large, or has so much room."""
    page.set_viewport_size(PHONE)
    page.goto(site.address + addresses[path])
    expect(page.locator("h1")).to_have_count(1)
    for closed in page.locator("details:not([open]) > summary").all():
        if closed.is_visible():
            closed.click()
    expect(page.locator(DRAWING)).to_have_count(0, timeout=120_000)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    assert barriers(page, ("target-size",)) == []
    if screenshots:
        name = re.sub(r"\W+", "-", path).strip("-")
        page.screenshot(path=screenshots / f"phone-{name}.png", full_page=True)
    watch.complaints[:] = [said for said in watch.complaints if "404" not in said or path != "/{path}"]


def test_what_is_too_small_or_too_wide_for_a_phone_is_found(page: Page, site: Service) -> None:
    page.set_viewport_size(PHONE)
    page.goto(f"{site.address}/upload")
    assert barriers(page, ("target-size",)) == []
    page.evaluate("document.querySelector('button[type=submit]').style.cssText = 'width: 400px'")
    assert page.evaluate("document.documentElement.scrollWidth") > PHONE["width"]
    page.evaluate(
        """for (const number of [1, 2]) {
             const small = document.querySelector("main").appendChild(document.createElement("button"));
             small.textContent = number; small.style.cssText = "all: unset; font-size: 9px";
           }"""
    )
    assert {barrier.split(":")[0] for barrier in barriers(page, ("target-size",))} == {"target-size"}


def test_a_figure_says_that_it_is_drawn_and_then_what_is_drawn(page: Page, site: Service, fitted: str) -> None:
    """While it is on its way a word stands in its place; its canvas is an image, named by the figure's heading."""
    held = []
    page.route(re.compile(r"/figures/residual-map\.json"), lambda route: held.extend([route]))
    page.goto(f"{site.address}/fits/{fitted}#residuals")
    plot = page.locator("#figure-residual-map .plot")
    plot.scroll_into_view_if_needed()
    expect(plot).to_have_attribute("aria-busy", "true")
    assert page.evaluate(
        "getComputedStyle(document.querySelector('#figure-residual-map .plot'), '::before').content"
    ) == ('"Drawing…"')
    page.wait_for_timeout(50)
    for route in held:
        route.continue_()
    image = plot.get_by_role("img", name=re.compile("where the error is, by run and frequency"))
    expect(image).to_be_visible(timeout=60_000)
    assert page.evaluate(
        "getComputedStyle(document.querySelector('#figure-residual-map .plot'), '::before').content"
    ) == ("none")


def test_every_canvas_has_a_name_that_follows_what_it_shows(page: Page, site: Service, fitted: str) -> None:
    """Each figure of a fit, tab by tab; the name of a run's plot names the run that was chosen."""
    page.goto(f"{site.address}/fits/{fitted}#residuals")
    for tab in page.locator("[role=tab]").all():
        tab.click()
        drawn = page.locator(f"#{tab.get_attribute('aria-controls')} canvas")
        expect(drawn).to_have_attribute("aria-label", re.compile(r"SW/1 <b> · .{10,}"), timeout=60_000)
        expect(drawn).to_have_attribute("role", "img")
    page.locator("#tab-time").click()
    run = page.locator("#pick-run option").nth(3).inner_text()
    page.locator("#pick-run").select_option(run)
    expect(page.locator("#figure-time canvas")).to_have_attribute(
        "aria-label", re.compile(re.escape(run)), timeout=60_000
    )
