"""The workbench: upload, fit, find what is missing, add it, look back, approve, find by serial number."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from tests.hidden_dead_zone import zipped

pytestmark = pytest.mark.usefixtures("watch")
LONG = 120_000  # ms, for a machine that is busy with other things


def pictures(page, folder, name):
    """Screenshots of the whole page in both themes and two widths; nothing sticks out."""
    for theme in ("light", "dark"):
        page.emulate_media(color_scheme=theme)
        for width in (1280, 820):
            page.set_viewport_size({"width": width, "height": 900})
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            page.screenshot(path=folder / f"{name}-{width}-{theme}.png", full_page=True)


def the_next_run_is_proposed(page):
    page.get_by_role("button", name="Propose a run").click()
    expect(page.locator(".next [data-text]")).to_contain_text("Run a ", timeout=LONG)
    with page.expect_download() as download:
        page.get_by_role("link", name="Download its command").click()
    assert download.value.suggested_filename.startswith("next-experiment-")


def an_own_effect_is_tried(page, watch):
    """Refused at its character, then shown as mathematics."""
    own = page.locator("form[data-own]")
    for label, text in (("Name", "overlap"), ("Strength, symbol", "h"), ("Unit", "mm"), ("Largest", "1")):
        own.get_by_label(label, exact=True).fill(text)
    own.get_by_label("Equation").fill("w = w - clip(w, -h, q!)")
    own.get_by_role("button", name="Check").click()
    expect(own.locator("mark")).to_have_text("!", timeout=LONG)
    expect(own.get_by_role("alert")).to_contain_text("character 22")
    watch.complaints.clear()  # the browser's own line on the refusal
    own.get_by_label("Equation").fill("w = w - clip(w, -h, h)")
    own.get_by_role("button", name="Check").click()
    expect(own.locator("math")).to_have_count(1, timeout=LONG)


def test_from_upload_to_a_mended_model_in_force(page, site, watch, tmp_path, screenshots):
    archive = tmp_path / "matrix.zip"
    archive.write_bytes(zipped("DZ-SHOP"))
    page.goto(f"{site.address}/upload")
    page.get_by_label("A zip, or matrix.yaml and files").set_input_files(archive)
    page.get_by_role("button", name="Upload").click()
    page.get_by_role("button", name="Start").click()

    find = page.get_by_role("button", name="Find what is missing")
    expect(find).to_be_visible(timeout=LONG)
    before = page.url
    find.focus()
    page.keyboard.press("Enter")
    expect(page.get_by_role("progressbar", name="Progress of the diagnosis")).to_be_visible(timeout=LONG)
    expect(page.locator("#missing [data-stage]")).to_have_text(re.compile("trying|confirming"), timeout=LONG)
    page.locator("#missing").screenshot(path=screenshots / "searching.png")

    card = page.locator(".card").first
    expect(card).to_contain_text("dead zone", timeout=LONG)
    expect(page.locator(".verdict")).to_contain_text("The model lacks dead zone")
    expect(page.locator("#missing-title")).to_be_focused()
    assert card.locator("math").count() == 1
    expect(card.locator(".evidence canvas")).to_be_visible(timeout=LONG)
    assert re.search(r"80\.\d+ ± 0\.\d+ µm", card.inner_text())
    page.get_by_text("others that do not help beyond chance").click()
    pictures(page, screenshots, "missing")
    page.locator("#missing").screenshot(path=screenshots / "cards.png")
    the_next_run_is_proposed(page)
    an_own_effect_is_tried(page, watch)
    add = card.get_by_role("button", name="Add it (dead zone)")
    add.focus()
    page.keyboard.press("Enter")

    way = page.locator("table.ladder tbody tr")
    expect(way).to_have_count(2, timeout=LONG)
    assert page.url != before
    first, second = (float(text.split()[0]) for text in way.locator("td:nth-child(4)").all_inner_texts())
    assert second < first / 2
    page.locator("#figure-ladder").scroll_into_view_if_needed()
    expect(page.locator("#figure-ladder canvas")).to_be_visible(timeout=LONG)
    pictures(page, screenshots, "mended")
    expect(page.get_by_role("link", name="Undo: back to the fit before")).to_have_attribute(
        "href", before.removeprefix(site.address)
    )
    page.get_by_role("button", name="Approve as the parameters of DZ-SHOP").click()
    expect(page.locator(".head .state.approved")).to_contain_text("current parameter set")
    page.goto(f"{site.address}/?q=DZ-SHOP")
    expect(page.locator("tbody tr")).to_contain_text("approved")
    found = site.client.get("/parameter-sets", params={"serial": "DZ-SHOP", "current": True}).json()["items"]
    assert "dead_zone.half_width" in found[0]["parameters"]


def test_a_search_can_be_cancelled_and_says_so(page, site):
    stored = site.client.post("/matrices", files={"files": ("matrix.zip", zipped("DZ-STOP"))}).json()
    fit = site.fit(stored["id"])
    assert site.ended(fit)["state"] == "succeeded"
    page.goto(f"{site.address}/fits/{fit}")
    page.get_by_role("button", name="Find what is missing").click()
    page.locator("#missing").get_by_role("button", name="Cancel").click(timeout=LONG)
    expect(page.locator("#missing")).to_contain_text("The last search was cancelled", timeout=LONG)
    expect(page.get_by_role("button", name="Find what is missing")).to_be_enabled()
    page.goto(f"{site.address}/jobs")
    page.locator("tbody tr").filter(has_text="diagnosis").first.get_by_role("link").first.click()
    expect(page).to_have_url(f"{site.address}/fits/{fit}#missing")
