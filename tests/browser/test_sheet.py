"""A data sheet from the page of a fit: what is filled in stands on it, the approval is said, and it can be signed."""

from __future__ import annotations

import re

import pytest
import typst
from playwright.sync_api import expect

from tests.app.report.test_sheet import LEAST, inked
from tests.browser.looks import everywhere, on_a_phone


@pytest.mark.full
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


@pytest.mark.full
def test_a_report_printed_by_the_browser_fills_its_sheets_of_a4(page, site, fitted, tmp_path):
    """All but the last, as Typst draws the pages of the file that is printed."""
    page.goto(f"{site.address}/api/v1/fits/{fitted}/report.html")
    printed = page.pdf(path=tmp_path / "report.pdf", prefer_css_page_size=True)
    assert re.search(rb"/MediaBox \[0 0 59[45][.\d]* 84[12][.\d]*\]", printed)
    source, filled = tmp_path / "sheet.typ", []
    for number in range(1, 1 + max(map(int, re.findall(rb"/Count (\d+)", printed)))):
        source.write_text(f'#set page(width: 210mm, height: 297mm, margin: 0mm)\n#image("report.pdf", page: {number})')
        filled.append(inked(typst.compile(str(source), format="png", ppi=30.0)))
    assert len(filled) > 3
    assert min(filled[:-1]) > LEAST, [round(one, 2) for one in filled]
