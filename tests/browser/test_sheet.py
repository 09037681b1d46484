"""A data sheet from the page of a fit: what is filled in stands on it, the approval is said, and it can be signed."""

from __future__ import annotations

from playwright.sync_api import expect

from tests.browser.looks import everywhere, on_a_phone


def test_a_data_sheet_is_filled_in_approved_and_ready_to_be_signed(page, site, matrix, screenshots):
    fit = site.fit(matrix, options={"population": 20, "generations": 2}, seed=3)
    assert site.ended(fit)["state"] == "succeeded"
    site.client.post(f"/fits/{fit}/approve", json={"why": "meets the limits"}).raise_for_status()
    page.goto(f"{site.address}/fits/{fit}")
    page.get_by_text("Report as a data sheet").click()
    everywhere(page, screenshots, "sheet-form")
    on_a_phone(page, screenshots, "sheet-form")
    page.get_by_label("Operator").fill("A. Kern")
    page.get_by_label("Oil temperature").fill("42 degC")
    page.get_by_role("button", name="Open the HTML report").click()
    expect(page.locator("dl").first).to_contain_text("A. Kern")
    expect(page.locator("dl").first).to_contain_text("42.0 °C")
    expect(page.locator("dl").first).to_contain_text("meets the limits")
    expect(page.get_by_role("row", name="Approved")).to_be_visible()
    everywhere(page, screenshots, "sheet")
