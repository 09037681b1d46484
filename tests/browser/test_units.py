"""Display units are chosen once, and pages and figures are in them."""

from __future__ import annotations

from playwright.sync_api import expect

from tests.browser.looks import everywhere, on_a_phone


def test_units_are_chosen_and_a_fit_and_its_signals_are_shown_in_them(page, site, fitted, screenshots):
    page.goto(f"{site.address}/fits/{fitted}")
    expect(page.get_by_text(" lb", exact=False).first).to_have_count(0)
    page.get_by_role("link", name="Units", exact=True).click()
    everywhere(page, screenshots, "units")
    on_a_phone(page, screenshots, "units")
    page.get_by_label("Length").select_option("in")
    page.get_by_label("Mass").select_option("lb")
    page.get_by_role("button", name="Save the units").click()
    expect(page.get_by_text("Saved.")).to_be_visible()
    page.goto(f"{site.address}/fits/{fitted}#parameters")
    expect(page.get_by_text(" lb", exact=False).first).to_have_count(1)
    page.goto(f"{site.address}/units")
    expect(page.get_by_label("Length")).to_have_value("in")
    page.get_by_label("Length").select_option("")
    page.get_by_label("Mass").select_option("")
    page.get_by_role("button", name="Save the units").click()
    page.goto(f"{site.address}/fits/{fitted}")
    expect(page.get_by_text(" lb", exact=False).first).to_have_count(0)
