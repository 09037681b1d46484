"""The keys / and ? work on every page, and not in a field."""

from __future__ import annotations

import re

from playwright.sync_api import expect

from tests.browser.looks import everywhere, on_a_phone


def test_a_fit_is_found_by_its_tag_from_any_page_with_the_keyboard(page, site, fitted, screenshots):
    site.client.put(f"/fits/{fitted}/annotation", json={"tags": ["endurance"]}).raise_for_status()
    page.goto(f"{site.address}/jobs")
    page.keyboard.press("?")
    keys = page.get_by_role("dialog", name="Keys")
    expect(keys).to_be_visible()
    everywhere(page, screenshots, "keys")
    page.keyboard.press("Escape")
    expect(keys).to_be_hidden()
    page.keyboard.press("/")
    page.wait_for_url("**/search")
    field = page.get_by_label("Serial number, name, batch, tag or note")
    expect(field).to_be_focused()
    page.keyboard.type("end/urance?")
    expect(field).to_have_value("end/urance?")
    field.fill("endurance")
    page.keyboard.press("Enter")
    expect(page.get_by_role("row").filter(has_text="endurance")).to_have_count(1)
    everywhere(page, screenshots, "search")
    on_a_phone(page, screenshots, "search")
    page.get_by_role("link", name=fitted[:8]).click()
    page.wait_for_url(re.compile(f"/fits/{fitted}"))
    site.client.put(f"/fits/{fitted}/annotation", json={}).raise_for_status()
