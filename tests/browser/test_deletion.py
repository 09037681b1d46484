"""A fit is deleted on its page, which says what goes with it, or why it stays."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.browser.looks import everywhere, on_a_phone


@pytest.mark.full
def test_a_fit_is_deleted_on_its_page_and_its_data_set_stays(page, site, matrix, screenshots):
    fit = site.fit(matrix, options={"population": 20, "generations": 3, "elite": 2})
    assert site.ended(fit)["state"] == "succeeded"
    page.goto(f"{site.address}/fits/{fit}")
    page.get_by_text("Delete this fit", exact=True).click()
    expect(page.get_by_text("Nothing was made of this fit. The data set stays.")).to_be_visible()
    everywhere(page, screenshots, "deletion")
    on_a_phone(page, screenshots, "deletion")
    page.get_by_role("button", name="Delete the fit", exact=True).click()
    page.wait_for_url(f"**/matrices/{matrix}")
    assert site.client.get(f"/fits/{fit}").status_code == 404
    expect(page.locator(f"a[href='/fits/{fit}']")).to_have_count(0)
