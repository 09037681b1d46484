"""The workbench: upload, fit, find what is missing, add it, look back, approve, find by serial number."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import expect

from tests.browser import story
from tests.browser.looks import everywhere
from tests.hidden_dead_zone import zipped

SEARCH = 1_200_000  # ms, for a search on 40 000 samples


def the_next_run_is_proposed(page):
    page.get_by_role("button", name="Propose a run").click()
    expect(page.locator(".next [data-text]")).to_contain_text("Run a ", timeout=story.LONG)
    with page.expect_download() as download:
        page.get_by_role("link", name="Download its command").click()
    assert download.value.suggested_filename.startswith("next-experiment-")


def an_own_effect_is_tried(page, watch, folder):
    """Refused at its character, then shown as mathematics."""
    own = page.locator("form[data-own]")
    for label, text in (("Name", "overlap"), ("Strength, symbol", "h"), ("Unit", "mm"), ("Largest", "1")):
        own.get_by_label(label, exact=True).fill(text)
    own.get_by_label("Equation").fill("w = w - clip(w, -h, q!)")
    own.get_by_role("button", name="Check").click()
    expect(own.locator("mark")).to_have_text("!", timeout=story.LONG)
    expect(own.get_by_role("alert")).to_contain_text("character 22")
    watch.complaints.clear()  # the browser's own line on the refusal
    own.get_by_label("Equation").fill("w = w - clip(w, -h, h)")
    own.get_by_role("button", name="Check").click()
    expect(own.locator("math")).to_have_count(1, timeout=story.LONG)
    everywhere(page, folder, "own")


def test_from_upload_to_a_mended_model_in_force(page, site, watch, tmp_path, screenshots):
    archive = tmp_path / "matrix.zip"
    archive.write_bytes(zipped("DZ-SHOP"))
    story.upload(page, site, archive)
    before = story.fit(page)
    card = story.search(page, screenshots and screenshots / "searching.png")
    expect(card).to_contain_text("dead zone")
    expect(page.locator(".verdict")).to_contain_text("The model lacks dead zone")
    assert card.locator("math").count() == 1
    expect(card.locator(".evidence canvas")).to_be_visible(timeout=story.LONG)
    assert re.search(r"80\.\d+ ± 0\.\d+ µm", card.inner_text())
    page.get_by_text("others that do not help beyond chance").click()
    everywhere(page, screenshots, "missing")
    if screenshots:
        page.locator("#missing").screenshot(path=screenshots / "cards.png")
    the_next_run_is_proposed(page)
    an_own_effect_is_tried(page, watch, screenshots)

    first, second = story.add(page, card, "dead zone")
    assert second < first / 2
    page.locator("#figure-ladder").scroll_into_view_if_needed()
    expect(page.locator("#figure-ladder canvas")).to_be_visible(timeout=story.LONG)
    everywhere(page, screenshots, "mended")
    expect(page.get_by_role("link", name="Undo: back to the fit before")).to_have_attribute(
        "href", before.removeprefix(site.address).partition("#")[0]
    )
    (found,) = story.approve(page, site, "DZ-SHOP")
    assert "dead_zone.half_width" in found["parameters"]


def test_a_measured_actuator_goes_the_same_way(page, site, measured_data, full, tmp_path, screenshots):
    """Swept sines of a servo-hydraulic machine: the search takes minutes, as in the tests at full length."""
    if not full:
        pytest.skip("minutes long: run with --full")
    story.upload(page, site, packed(measured_data / "mts_actuator", tmp_path))
    (serial,) = page.locator(".crumbs a:last-child").all_inner_texts()
    story.fit(page)
    expect(page.get_by_role("heading", name="Where does it fail?")).to_be_visible()
    page.locator("#figure-residual-map").scroll_into_view_if_needed()
    expect(page.locator("#figure-residual-map canvas")).to_be_visible(timeout=story.LONG)
    errors = page.locator("section:has-text('Error, eq. (17)') tbody tr").all_inner_texts()
    assert all(float(row.split("\t")[1].split()[0]) > 3 for row in errors), errors
    card = story.search(page, patience=SEARCH)
    everywhere(page, screenshots, "measured")
    first, second = story.add(page, card)
    assert second < first
    (found,) = story.approve(page, site, serial)
    assert [name for name in found["parameters"] if "." in name]


def packed(folder, target):
    """A matrix folder as one zip."""
    return Path(shutil.make_archive(str(target / "measured"), "zip", folder))


def test_a_search_can_be_cancelled_and_says_so(page, site):
    stored = site.client.post("/matrices", files={"files": ("matrix.zip", zipped("DZ-STOP"))}).json()
    fit = site.fit(stored["id"])
    assert site.ended(fit)["state"] == "succeeded"
    page.goto(f"{site.address}/fits/{fit}")
    page.get_by_role("button", name="Find what is missing").click()
    page.locator("#missing").get_by_role("button", name="Cancel").click(timeout=story.LONG)
    expect(page.locator("#missing")).to_contain_text("The last search was cancelled", timeout=story.LONG)
    expect(page.get_by_role("button", name="Find what is missing")).to_be_enabled()
    page.goto(f"{site.address}/jobs")
    page.locator("tbody tr").filter(has_text="diagnosis").first.get_by_role("link").first.click()
    expect(page).to_have_url(f"{site.address}/fits/{fit}#missing")
