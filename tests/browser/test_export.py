"""An identified machine taken along, from the page that puts a fit to use."""

from __future__ import annotations

from playwright.sync_api import expect


def test_a_machine_is_downloaded_and_what_cannot_be_is_said_beside_the_form(page, watch, site, fitted):
    """A mass in metres is refused in place; without it the header comes, under the model's name."""
    page.goto(f"{site.address}/fits/{fitted}")
    page.get_by_role("link", name="Export as C, FMU or MAT").click()
    section = page.locator("#export")
    section.get_by_label("Mass moved").fill("3 m")
    section.get_by_role("button", name="Export the model").click()
    expect(section.get_by_role("alert")).to_contain_text("'m' is not a unit of mass")
    watch.complaints.clear()  # the browser notes the status of the refusal itself
    section.get_by_label("Mass moved").fill("3 kg")
    with page.expect_download() as told:
        section.get_by_role("button", name="Export the model").click()
    assert told.value.suggested_filename == "qian2014.h"
    assert " *   mL = 3\n" in told.value.path().read_text()
