"""What stands beside what: fields within their frame, headings above their column, room between panels."""

from __future__ import annotations

from playwright.sync_api import FloatRect, Locator, Page

from tests.app.access.test_audit import RAW
from tests.browser.looks import PHONE
from tests.running import Service


def box(place: Locator) -> FloatRect:
    """The rectangle of an element that is shown."""
    found = place.bounding_box()
    assert found is not None
    return found


def test_the_fields_of_files_keep_the_same_margin_on_both_sides_of_a_phone(page: Page, site: Service) -> None:
    page.set_viewport_size(PHONE)
    page.goto(f"{site.address}/upload")
    frame, field = box(page.locator(".drop")), box(page.get_by_label("Files"))
    left = field["x"] - frame["x"]
    assert frame["x"] + frame["width"] - field["x"] - field["width"] >= left > 0


def test_the_lines_of_a_raw_file_have_their_heading_above_them_and_the_area_shows_its_hint(page: Page, site: Service):
    draft = site.client.post("/drafts", files={"files": ("run.csv", RAW)}).json()["id"]
    page.goto(f"{site.address}/drafts/{draft}")
    lines = page.locator(".lines")
    text = "node => { const range = document.createRange(); range.selectNodeContents(node);"
    text += " return range.getBoundingClientRect().x; }"
    heading = lines.get_by_role("columnheader", name="Text").evaluate(text)
    assert abs(heading - box(lines.locator("code").first)["x"]) < 1
    area = page.get_by_label("Piston area")
    assert area.evaluate("field => { field.value = field.placeholder; return field.scrollWidth <= field.clientWidth; }")


def test_the_panels_of_a_summary_do_not_touch_on_a_phone(page: Page, site: Service, fitted: str) -> None:
    page.set_viewport_size(PHONE)
    page.goto(f"{site.address}/fits/{fitted}")
    first, second = (box(panel) for panel in page.locator("#summary .columns > .panel").all())
    assert second["y"] - first["y"] - first["height"] >= 8
