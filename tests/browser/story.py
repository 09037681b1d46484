"""The steps of the workbench's story, the same for simulated and measured matrices."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Locator, Page, expect

from tests.running import Service

LONG = 120_000  # ms, for a machine that is busy with other things


def upload(page: Page, site: Service, archive: Path) -> None:
    """One zip; the page of its matrix opens."""
    page.goto(f"{site.address}/upload")
    page.get_by_label("Files").set_input_files(archive)
    page.get_by_role("button", name="Upload").click()
    expect(page.locator("h1")).to_contain_text("Test data of", timeout=LONG)


def fit(page: Page) -> str:
    """One button; the address of the finished fit."""
    page.get_by_role("button", name="Start the fit").click()
    expect(page.locator("#next")).to_be_visible(timeout=LONG)
    return page.url


def section(page: Page, name: str) -> None:
    """One of the sections of a fit."""
    page.get_by_role("navigation", name="Sections of the fit").get_by_role("link", name=name).click()


def search(page: Page, searching: Path | None = None, patience: float = LONG) -> Locator:
    """By keyboard: find what is missing; the first card, once it is there."""
    page.get_by_role("button", name="Search for missing effects").focus()
    page.keyboard.press("Enter")
    expect(page.get_by_role("progressbar", name="Progress of the diagnosis")).to_be_visible(timeout=LONG)
    card = page.locator(".card").filter(has=page.get_by_role("button", name="Add the effect")).first
    sight = page.locator("#missing [data-sight]").filter(has_text="%")  # the list of the first sight, while it works
    expect(sight.or_(card).first).to_be_visible(timeout=patience)  # a quick search may be over before it is seen
    if searching is not None:
        page.locator("#missing").screenshot(path=searching)
    expect(card).to_be_visible(timeout=patience)
    expect(page.locator("#missing-title")).to_be_focused()
    return card


def add(page: Page, card: Locator, name: str = "") -> tuple[float, float]:
    """By keyboard: add what a card names; the ladder's error on verify runs before and after, in per cent."""
    before = page.url
    card.get_by_role("button", name=re.compile(rf"Add .*{name}")).first.focus()
    page.keyboard.press("Enter")
    way = page.locator("table.ladder tbody tr")
    expect(way).to_have_count(2, timeout=LONG)
    assert page.url != before
    first, second = (float(text.split()[0]) for text in way.locator("td:nth-child(4)").all_inner_texts())
    return first, second


def approve(page: Page, site: Service, serial: str) -> list[dict[str, object]]:
    """Approve the fit and find it by serial number on the page and over HTTP: the sets in force."""
    page.get_by_role("button", name=f"Approve for {serial}").click()
    expect(page.locator(".head .state.approved")).to_contain_text("current parameter set")
    page.goto(f"{site.address}/?q={serial}")
    expect(page.locator("tbody tr")).to_contain_text("approved")
    found: list[dict[str, object]] = site.client.get(
        "/parameter-sets", params={"serial": serial, "current": True}
    ).json()["items"]
    return found
