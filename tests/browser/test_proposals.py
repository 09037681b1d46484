"""A matrix whose effect no list holds: something is left, a term is proposed, added by button, and it was that."""

from __future__ import annotations

from playwright.sync_api import expect

from tests.browser import story
from tests.browser.looks import everywhere
from tests.hidden_leak import NOISE, zipped


def test_a_term_is_proposed_added_and_the_error_is_the_noise_s(page, site, screenshots):
    stored = site.client.post("/matrices", files={"files": ("matrix.zip", zipped())}).json()
    fit = site.fit(stored["id"])
    assert site.ended(fit)["state"] == "succeeded"
    # By the catalogue alone something is left; then the search goes on where it ended.
    made = site.client.post("/diagnoses", json={"fit": fit, "max_effects": 0})
    found = site.ended(made.headers["Location"].rpartition("/")[2])
    assert found["state"] == "succeeded"
    page.goto(f"{site.address}/?token={site.token}")
    page.goto(f"{site.address}/fits/{fit}#missing")
    expect(page.locator("#left")).to_contain_text("Something is left")
    page.get_by_role("button", name="Search for what no list holds").click()
    card = page.locator(".card").filter(has_text="proposed by search")
    expect(card).to_be_visible(timeout=story.LONG)
    expect(card).to_contain_text("Leakage in one direction")
    expect(card.locator("math")).to_have_count(1)
    expect(page.locator("#left")).to_contain_text("Something is left")  # what is proposed is no finding
    everywhere(page, screenshots, "proposed")
    first, second = story.add(page, card)
    assert first > 5 * 100 * NOISE
    assert second < 1.05 * 100 * NOISE
    expect(page.locator("h1")).to_contain_text("proposed 1")
