"""On a phone: what is too small or too wide is found, and a canvas says what it shows."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from tests.browser.looks import PHONE, barriers
from tests.running import Service


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


@pytest.mark.full
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


def test_a_profile_that_nobody_has_computed_is_no_error(page: Page, site: Service, fitted: str, watch) -> None:
    """Of a model with effects a job makes it: the page says that there is none yet, not how a program asks for it."""
    page.route(
        re.compile(r"/figures/profile\.json"), lambda route: route.fulfill(status=422, json={"code": "too-long"})
    )
    page.goto(f"{site.address}/fits/{fitted}#parameters")
    page.evaluate("document.querySelector('#profile').dataset.unmade = 'None is computed yet.'")
    page.get_by_text("Profile likelihood of a parameter").click()
    note = page.locator("#profile .figure > [role=status]")
    expect(note).to_have_text("None is computed yet.", timeout=60_000)
    expect(note).not_to_have_class("error")
    watch.complaints.clear()  # the browser's own line on the refusal
