"""Signals as measured: zoomed with the wheel, moved with the mouse, and a range of them made the run that is fitted."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from tests.browser.looks import everywhere


def test_a_range_is_chosen_with_the_mouse_and_loses_its_trend(page, site, matrix, screenshots):
    page.goto(f"{site.address}/matrices/{matrix}")
    page.locator("#run-0 a").click()
    figure = page.locator("#figure-signals")
    canvas, start, length = (
        figure.locator("canvas"),
        figure.get_by_label("Start (s)"),
        figure.get_by_label("Length (s)"),
    )
    for drawn in (canvas, page.locator("#figure-spectra canvas")):
        expect(drawn).to_be_visible(timeout=120_000)  # the first figure of a service waits for Vega to be put together
    everywhere(page, screenshots, "signals")
    page.set_viewport_size({"width": 1280, "height": 900})
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.4 * box["height"])
    for _ in range(3):
        page.mouse.wheel(0, -100)
    expect(length).to_have_value(re.compile(r"^0\.256"))  # 0.5 s / 1.25³
    expect(canvas).to_have_attribute("aria-label", re.compile("signals as measured"))
    before = float(start.input_value())
    page.mouse.down()
    page.mouse.move(box["x"] + 0.7 * box["width"], box["y"] + 0.4 * box["height"], steps=3)
    page.mouse.up()
    assert 0 <= float(start.input_value()) < before - 0.02
    expect(figure.locator(".plot")).to_have_attribute("aria-busy", "false")

    page.get_by_label("Remove").select_option("line")
    page.get_by_role("button", name="Use only the range shown").click()
    page.wait_for_url(lambda url: "/signals" not in url)
    expect(page.get_by_text("· revision of")).to_be_visible()
    expect(page.locator("#run-0")).to_contain_text("0.2561 s at 4096 Hz")


@pytest.mark.full
def test_a_range_chosen_with_the_mouse_is_validation_data(page, site, matrix):
    """The end of the record, with a stated gap; the page of the data set lists both parts and edits the split."""
    page.goto(f"{site.address}/matrices/{matrix}")
    page.locator("#run-0 a").click()
    figure = page.locator("#figure-signals")
    canvas = figure.locator("canvas")
    expect(canvas).to_be_visible(timeout=120_000)
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + 0.95 * box["width"], box["y"] + 0.4 * box["height"])
    for _ in range(6):
        page.mouse.wheel(0, -100)
    expect(figure.get_by_label("Length (s)")).to_have_value(re.compile(r"^0\.131"))  # 0.5 s / 1.25⁶
    page.get_by_label("Gap to estimation data").fill("20 ms")
    page.get_by_role("button", name="Use the range shown for validation").click()
    page.wait_for_url(lambda url: "/signals" not in url)
    expect(page.locator("#run-1")).to_contain_text("validation")
    page.get_by_role("button", name=re.compile(r"^Edit .*\.validation$")).click()
    expect(page.get_by_label("Gap before them")).to_have_value("20 ms")
    expect(page.get_by_label("Validation samples, from and to")).to_have_value(re.compile(r"^\d+, \d+$"))
    page.get_by_label("Validation samples, from and to").fill("")
    page.get_by_label("Gap before them").fill("")
    page.get_by_role("button", name="Save as new revision").click()
    expect(page.get_by_role("button", name=re.compile(r"^Edit .*\.validation$"))).to_have_count(0, timeout=60_000)


def test_the_points_that_are_there_follow_the_wheel_before_the_service_answers(page, site, matrix):
    """The line is stretched about the pointer on the figure's canvas; the sharp points replace it once they come."""
    held = []
    page.goto(f"{site.address}/matrices/{matrix}")
    page.locator("#run-0 a").click()
    figure = page.locator("#figure-signals")
    canvas = figure.locator("canvas")
    expect(canvas).to_be_visible(timeout=120_000)
    expect(figure.locator(".plot")).to_have_attribute("aria-busy", "false")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.4 * box["height"])
    drawn = canvas.evaluate("canvas => canvas.toDataURL()")

    def hold(route):
        held.append(route)

    page.route("**/figures/signals.json*", hold)
    with page.expect_request("**/figures/signals.json*"):
        page.mouse.wheel(0, -100)
    stretched = canvas.evaluate("canvas => canvas.toDataURL()")
    assert stretched != drawn
    expect(figure.locator(".plot")).to_have_attribute("aria-busy", "true")
    for route in held:
        route.continue_()
    page.unroute("**/figures/signals.json*")
    expect(figure.locator(".plot")).to_have_attribute("aria-busy", "false")
    assert canvas.evaluate("canvas => canvas.toDataURL()") != stretched
