"""A matrix whose effect no list holds: something is left, a term is proposed, added by button, and it was that.

Kept under a name, it stands in the list of another actuator's fit.
"""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.browser import story
from tests.browser.looks import barriers, everywhere
from tests.hidden_bump import NOISE, zipped


@pytest.mark.full
def test_a_term_is_proposed_added_and_the_error_is_the_noise_s(page, site, screenshots):
    """What is kept is in the list of another actuator, where it is deleted."""
    stored = site.client.post("/matrices", files={"files": ("matrix.zip", zipped())}).json()
    fit = site.fit(stored["id"])
    assert site.ended(fit)["state"] == "succeeded"
    diagnosed(site, fit)
    page.goto(f"{site.address}/?token={site.token}")
    page.goto(f"{site.address}/fits/{fit}#missing")
    expect(page.locator("#left")).to_contain_text("Unmodelled dynamics remain")
    page.get_by_role("button", name="Search for unknown terms").click()
    card = page.locator(".card").filter(has_text="proposed by search")
    expect(card).to_be_visible(timeout=story.LONG)
    expect(card).to_contain_text("Acts at one part of the way")
    expect(card.locator("math")).to_have_count(1)
    expect(card.locator(".evidence canvas")).to_be_visible(timeout=story.LONG)  # the term through what is missing
    expect(page.locator("#left")).to_contain_text("Unmodelled dynamics remain")  # what is proposed is no finding
    if screenshots:
        everywhere(page, screenshots, "proposed")
    assert barriers(page) == []
    the_term_is_kept(page, card, screenshots)
    first, second = story.add(page, card)
    assert first > 5 * 100 * NOISE
    assert second < 1.05 * 100 * NOISE
    expect(page.locator("h1")).to_contain_text("proposed 1")
    another_actuator_has_it_in_the_list(page, site, screenshots)
    a_written_one_is_kept_too(page, site)
    it_is_deleted_from_the_list(page, site, screenshots)


def diagnosed(site, fit):
    """Nothing of the catalogue is added."""
    made = site.client.post("/diagnoses", json={"fit": fit, "max_effects": 0, "propose": False})
    assert site.ended(made.headers["Location"].rpartition("/")[2])["state"] == "succeeded"


def the_term_is_kept(page, card, screenshots):
    """Under the name that is typed over the one that was suggested; it says so, also when the page is opened again."""
    name = card.get_by_label("Save for other actuators as")
    expect(name).to_have_value("acts_at_one_part_of_the_way")
    name.fill("uneven_port")
    card.get_by_role("button", name="Save the effect term 1").click()
    expect(card.get_by_role("status")).to_contain_text("Saved as uneven_port")
    expect(name).to_be_hidden()
    if screenshots:
        page.reload()
        expect(card).to_contain_text("Saved as uneven_port")
        everywhere(page, screenshots, "kept")


def another_actuator_has_it_in_the_list(page, site, screenshots):
    """With its equation, what it means and where it comes from; added, it leaves the noise."""
    stored = site.client.post("/matrices", files={"files": ("matrix.zip", zipped("BUMP-2"))}).json()
    page.goto(f"{site.address}/matrices/{stored['id']}")
    page.get_by_text("Physical effects to add").click()
    expect(page.locator("#start").get_by_label("uneven port")).not_to_be_checked()
    story.fit(page)
    listed = page.get_by_role("region", name="Own effects")
    expect(listed).to_contain_text("uneven port")
    expect(listed).to_contain_text("Acts at one part of the way", ignore_case=True)
    expect(listed).to_contain_text("proposed by search")
    expect(listed.locator("math")).to_have_count(1)
    expect(page.locator("#missing").get_by_label("include own effects")).not_to_be_checked()
    if screenshots:
        everywhere(page, screenshots, "own-list")
    first, second = story.add(page, listed, "uneven port")
    assert first > 5 * 100 * NOISE
    assert second < 1.05 * 100 * NOISE
    expect(page.locator("h1")).to_contain_text("BUMP-2: ")
    expect(page.locator("h1")).to_contain_text("uneven port")
    expect(listed).to_contain_text("switched on")
    page.locator(".chain").get_by_role("link", name="spool").click()
    expect(page.locator("#place-spool .lives").first).to_contain_text("proposed by search")


def a_written_one_is_kept_too(page, site):
    """The form of an own effect has a button for it, which leaves the page as it is."""
    story.section(page, "Model")
    page.get_by_text("Define your own effect").click()
    own = page.locator("form[data-own]")
    for label, text in (("Name", "lapped"), ("Strength, symbol", "h"), ("Unit", "mm"), ("Largest", "1")):
        own.get_by_label(label, exact=True).fill(text)
    own.get_by_label("Equation").fill("w = w - clip(w, -h, h)")
    own.get_by_role("button", name="Save for other actuators").click()
    expect(own.locator("[data-kept]")).to_contain_text("Saved as lapped")
    expect(own.locator("math")).to_have_count(1)
    assert site.client.get("/own-effects/lapped").json()["origin"] == "written"


def it_is_deleted_from_the_list(page, site, screenshots):
    """The fit that has it stays."""
    fit = page.url
    page.get_by_role("link", name="Own effects", exact=True).click()
    expect(page.locator("h1")).to_have_text("Own effects")
    everywhere(page, screenshots, "own-effects")
    page.get_by_role("button", name="Delete the effect uneven port").click()
    expect(page.locator(".lives")).to_have_count(1)
    page.get_by_role("button", name="Delete the effect lapped").click()
    expect(page.locator("#main")).to_contain_text("No own effects yet")
    assert site.client.get("/own-effects").json()["items"] == []
    page.goto(fit)
    expect(page.locator("h1")).to_contain_text("uneven port")
