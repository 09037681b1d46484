"""Display units are chosen once, and pages and figures are in them."""

from __future__ import annotations

from playwright.sync_api import expect

from tests.browser.looks import everywhere, on_a_phone


def test_units_are_chosen_and_an_account_sees_them_in_every_browser(page, site, window, fitted, screenshots):
    page.goto(f"{site.address}/fits/{fitted}")
    expect(page.get_by_text(" lb", exact=False).first).to_have_count(0)
    page.get_by_role("link", name="Units", exact=True).click()
    expect(page.get_by_role("heading", name="Display units")).to_be_visible()
    everywhere(page, screenshots, "units")
    on_a_phone(page, screenshots, "units")
    page.get_by_label("Length").select_option("in")
    page.get_by_label("Mass").select_option("lb")
    page.get_by_role("button", name="Save the units").click()
    expect(page.get_by_text("Saved.")).to_be_visible()
    page.goto(f"{site.address}/fits/{fitted}#parameters")
    expect(page.get_by_text(" lb", exact=False).first).to_have_count(1)
    with window.stranger() as elsewhere:
        theirs = elsewhere.new_page()
        theirs.goto(f"{site.address}/?token={site.token}")
        theirs.goto(f"{site.address}/fits/{fitted}#parameters")
        expect(theirs.get_by_text(" lb", exact=False).first).to_have_count(1)
    page.goto(f"{site.address}/units")
    expect(page.get_by_label("Length")).to_have_value("in")
    page.get_by_label("Length").select_option("")
    page.get_by_label("Mass").select_option("")
    page.get_by_role("button", name="Save the units").click()
    expect(page.get_by_text("Saved.")).to_be_visible()
    page.goto(f"{site.address}/fits/{fitted}")
    expect(page.get_by_text(" lb", exact=False).first).to_have_count(0)
