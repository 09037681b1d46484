"""What stands beside what: fields within their frame, headings above their column, room between panels."""

from __future__ import annotations

import re

from playwright.sync_api import FloatRect, Locator, Page

from tests.app.access.test_audit import RAW
from tests.browser.looks import PHONE
from tests.figures.test_thinning import contrast
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


def test_the_form_of_an_own_effect_stays_on_a_phone(page: Page, site: Service, fitted: str) -> None:
    page.set_viewport_size(PHONE)
    page.goto(f"{site.address}/fits/{fitted}#model")
    page.get_by_text("Define your own effect").click()
    frame, field = box(page.locator("#own")), box(page.get_by_label("Derivative of the state, per second"))
    assert field["x"] + field["width"] <= frame["x"] + frame["width"]
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]


def test_the_limits_of_a_rig_have_their_heading_below_the_fields_before_it(page: Page, site: Service) -> None:
    page.set_viewport_size(PHONE)
    page.goto(f"{site.address}/plan")
    field, heading = (
        box(page.get_by_label("Smallest share of a requested amplitude")),
        box(page.locator(".groups legend")),
    )
    assert heading["y"] - field["y"] - field["height"] >= 4


def test_the_name_of_a_planned_run_takes_one_line_of_a_phone(page: Page, site: Service) -> None:
    program = {"gains": [5], "amplitudes": ["0.02 in"], "seconds": "0.5 s"}
    plan = site.client.post("/plans", json={"program": program}).json()["id"]
    assert site.ended(plan)["state"] == "succeeded"
    page.set_viewport_size(PHONE)
    page.goto(f"{site.address}/plan?plan={plan}")
    for cell in (page.locator(".answer tbody th"), page.locator(".answer tbody td").nth(1)):
        assert cell.evaluate("cell => getComputedStyle(cell).whiteSpace") == "nowrap"


def test_a_long_sentence_has_half_of_a_phone_after_a_long_name(page: Page, site: Service) -> None:
    page.set_viewport_size(PHONE)
    page.goto(f"{site.address}/upload")
    facts = "<dl class=facts><dt>Critical delay of a perfect machine</dt><dd>none</dd></dl>"
    page.locator(".panel").last.evaluate("(panel, facts) => { panel.innerHTML = facts; }", facts)
    assert box(page.locator("main .facts dd"))["width"] >= box(page.locator("main .facts"))["width"] / 2


def test_the_share_of_the_noise_is_seen_in_both_themes(page: Page, site: Service, fitted: str) -> None:
    """Its square differs from the panel by a contrast of 3 and more (WCAG 1.4.11)."""
    page.goto(f"{site.address}/fits/{fitted}")
    of = "getComputedStyle(node, '::before')", "getComputedStyle(node.closest('.panel'))"
    colours = f"node => [{of[0]}.backgroundColor, {of[1]}.backgroundColor]"
    for theme in ("light", "dark"):
        page.emulate_media(color_scheme=theme)
        square, panel = page.locator(".budget li.noise").evaluate(colours)
        assert contrast(hexadecimal(square), hexadecimal(panel)) >= 3


def hexadecimal(colour: str) -> str:
    """#rrggbb of rgb(r, g, b)."""
    return "#" + "".join(f"{int(part):02x}" for part in re.findall(r"\d+", colour)[:3])
