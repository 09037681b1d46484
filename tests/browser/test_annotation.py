"""A name, tags and a note are written on the page of a fit."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.browser.looks import everywhere


@pytest.mark.full
def test_a_fit_is_named_tagged_and_noted_on_its_page(page, site, fitted, matrix, screenshots):
    page.goto(f"{site.address}/fits/{fitted}")
    page.get_by_text("Name, tags and note", exact=True).click()
    page.get_by_label("Name of the fit").fill("cold oil")
    page.get_by_label("Tags, separated by commas").fill("acceptance, 20 degC")
    page.get_by_label("Note on the fit").fill("valve 3")
    page.get_by_role("button", name="Save name, tags and note").click()
    expect(page.get_by_role("heading", level=1)).to_contain_text("cold oil")
    expect(page.get_by_text("valve 3").first).to_be_visible()
    page.goto(f"{site.address}/matrices/{matrix}")
    expect(page.get_by_role("row").filter(has=page.get_by_role("link", name="cold oil"))).to_contain_text("20 degC")
    everywhere(page, screenshots, "annotation")
    site.client.put(f"/fits/{fitted}/annotation", json={}).raise_for_status()
