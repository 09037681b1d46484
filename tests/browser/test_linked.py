"""Figures that follow what is picked out; the chain, two fits side by side, copies, own effects with a state."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from tests.browser.story import LONG
from tests.short_form import short_form

pytestmark = pytest.mark.usefixtures("watch")
MAP, BODE = "#figure-residual-map", "#figure-bode"


def opened(page, address):
    """The page of a fit with its map and its Bode plot drawn."""
    page.goto(address if "?" in address else f"{address}#residuals")
    for figure in (MAP, BODE):
        expect(page.locator(f"{figure} canvas")).to_be_visible(timeout=LONG)
        expect(page.locator(f"{figure} .plot")).to_have_attribute("aria-busy", "false", timeout=LONG)


def square(page, across, down):
    """A point of the map, as shares of its canvas."""
    canvas = page.locator(f"{MAP} canvas")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    return box["x"] + across * box["width"], box["y"] + down * box["height"]


def answered(page, figure, query):
    """Waits until a figure is drawn with these options; a download of it would be the same."""
    expect(page.locator(f"{figure} a[data-format=svg]")).to_have_attribute("href", re.compile(query), timeout=LONG)
    expect(page.locator(figure)).to_have_attribute("data-drawn", re.compile(query), timeout=LONG)


def test_a_square_of_the_map_is_followed_by_the_figures_and_the_address_keeps_it(page, site, fitted):
    opened(page, f"{site.address}/fits/{fitted}")
    before = page.locator(f"{BODE} canvas").screenshot()
    page.mouse.click(*square(page, 0.5, 0.7))
    run, low = page.get_by_label("Run", exact=True), page.get_by_label("From (Hz)")
    expect(run).not_to_have_value("")
    expect(low).not_to_have_value("")
    chosen = run.input_value()
    answered(page, BODE, f"run={chosen}.*low=")
    assert page.locator(f"{BODE} canvas").screenshot() != before
    assert f"run={chosen}" in page.url
    page.get_by_role("tab", name="Time record").click()
    answered(page, "#figure-time", f"run={chosen}.*low=")
    page.reload()
    expect(run).to_have_value(chosen)
    expect(page.get_by_role("tab", name="Time record")).to_have_attribute("aria-selected", "true")
    answered(page, "#figure-time", f"run={chosen}.*low=")
    page.get_by_role("button", name="Show all").click()
    expect(run).to_have_value("")
    assert "run=" not in page.url


def test_a_band_drawn_across_the_map_moves_the_bode_plot_without_the_service(page, site, watch, fitted):
    opened(page, f"{site.address}/fits/{fitted}")
    before = page.locator(f"{BODE} canvas").screenshot()
    asked = len([url for url in watch.requests if "bode.json" in url])
    start, end = square(page, 0.35, 0.7), square(page, 0.55, 0.7)
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end, steps=6)
    page.mouse.up()
    low, high = page.get_by_label("From (Hz)"), page.get_by_label("To (Hz)")
    expect(low).not_to_have_value("")
    assert 0 < float(low.input_value()) < float(high.input_value())
    expect(page.get_by_label("Run", exact=True)).to_have_value("")
    answered(page, BODE, "low=.*high=")
    assert page.locator(f"{BODE} canvas").screenshot() != before
    assert len([url for url in watch.requests if "bode.json" in url]) == asked


@pytest.mark.full
@pytest.mark.parametrize("name", ["bode", "time", "residual-curve", "sensitivity"])
def test_a_figure_that_follows_a_pick_shows_what_it_would_if_it_were_drawn_anew(name, page, site, fitted):
    figure, runs = f"#figure-{name}", [run["id"] for run in site.client.get(f"/fits/{fitted}").json()["result"]["runs"]]
    canvas = page.locator(f"{figure} canvas")
    page.goto(f"{site.address}/fits/{fitted}?figure={name}&run={runs[1]}")
    answered(page, figure, f"run={runs[1]}")
    before = drawing(canvas)
    canvas.evaluate("canvas => canvas.dataset.first = 'it stays'")
    page.get_by_label("Run", exact=True).select_option(runs[4])
    answered(page, figure, f"run={runs[4]}")
    if name != "sensitivity":  # which has no band
        for label, end in (("From (Hz)", "3"), ("To (Hz)", "40")):
            page.get_by_label(label).fill(end)
            page.keyboard.press("Tab")
        answered(page, figure, f"run={runs[4]}&low=3&high=40")
    followed = drawing(canvas)
    assert followed != before
    expect(canvas).to_have_attribute("data-first", "it stays")
    page.reload()
    answered(page, figure, f"run={runs[4]}")
    assert drawing(canvas) == followed


def drawing(canvas):
    """The picture, once it is there."""
    expect(canvas).to_be_visible(timeout=LONG)
    expect(canvas.locator("xpath=ancestor::*[@aria-busy]")).to_have_attribute("aria-busy", "false", timeout=LONG)
    return canvas.evaluate("canvas => canvas.toDataURL()")


def test_run_and_band_are_picked_by_keyboard_alone(page, site, fitted):
    opened(page, f"{site.address}/fits/{fitted}")
    page.get_by_text(re.compile("Table of the .* runs")).click()
    button = page.locator("[data-pick]").nth(1)
    button.focus()
    page.keyboard.press("Enter")
    expect(button).to_have_attribute("aria-pressed", "true")
    answered(page, BODE, f"run={button.inner_text()}")
    page.get_by_label("From (Hz)").focus()
    page.keyboard.type("2")
    page.keyboard.press("Tab")
    answered(page, BODE, "low=2")
    assert "low=2" in page.url
    page.get_by_label("To (Hz)").focus()
    page.keyboard.type("-1")  # which no logarithmic axis has: the field says so, and the figures stay
    page.keyboard.press("Tab")
    assert "high" not in page.url
    assert page.get_by_label("To (Hz)").evaluate("field => field.validationMessage")


@pytest.mark.full
def test_a_frequency_of_the_address_that_no_axis_has_is_none(page, site, fitted):
    opened(page, f"{site.address}/fits/{fitted}?low=-1&high=50")
    answered(page, BODE, "high=50")
    expect(page.get_by_label("From (Hz)")).to_have_value("")


def test_a_band_upside_down_is_refused_with_the_remedy(page, site, watch, fitted):
    page.goto(f"{site.address}/fits/{fitted}?figure=time&low=9&high=3")
    expect(page.locator("#figure-time [role=status]")).to_contain_text("0 <= low < high", timeout=LONG)
    watch.complaints.clear()  # the browser's own line on the refusal


def test_a_place_of_the_chain_lists_its_effects(page, site, fitted):
    page.goto(f"{site.address}/fits/{fitted}#model")
    place = page.get_by_role("link", name=re.compile("^spool: switched on none"))
    place.focus()
    page.keyboard.press("Enter")
    lives = page.locator("#place-spool")
    expect(lives).to_be_visible()
    expect(lives).to_contain_text("dead zone")
    assert lives.locator("math").count() >= 3
    expect(lives.get_by_role("button", name="Add the effect (dead zone)")).to_be_visible()
    expect(page.locator("#place-load")).to_be_hidden()


@pytest.fixture(scope="module")
def second(site, fitted):
    """Another fit of the same matrix."""
    job = site.client.post(f"/fits/{fitted}/effects", json={"effect": "dead_zone"}).json()["id"]
    assert site.ended(job)["state"] == "succeeded"
    return job


def test_two_fits_stand_side_by_side(page, site, fitted, second, screenshots):
    page.goto(f"{site.address}/fits/{second}")
    page.get_by_label("Compare with").select_option(f"{second},{fitted}")
    page.get_by_role("button", name="Compare fits").click()
    expect(page.locator("h1")).to_have_text("Two fits side by side", timeout=LONG)
    zone = page.locator("tr", has_text="dead zone: half of the overlap")
    expect(zone.locator("td").nth(1)).to_have_text("off")
    expect(zone.locator("td").nth(2)).to_contain_text(re.compile(r" ± .* µ?m$|⁻⁹ m"))
    page.locator("[data-pick]").first.click()
    answered(page, BODE, f"other={second}.*run=")
    expect(page.locator(f"{BODE} canvas")).to_be_visible(timeout=LONG)
    for theme in ("light", "dark"):
        page.emulate_media(color_scheme=theme)
        for width in (1280, 820) if screenshots else (820,):
            page.set_viewport_size({"width": width, "height": 900})
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            if screenshots:
                page.screenshot(path=screenshots / f"compare-{width}-{theme}.png", full_page=True)
    page.goto(f"{site.address}/fits/{second}#history")
    page.get_by_role("link", name="compare", exact=True).click()
    expect(page.locator("h1")).to_have_text("Two fits side by side", timeout=LONG)


@pytest.mark.parametrize("fits", short_form(["", "one", "none,nothing"], "none,nothing"))
def test_a_comparison_of_what_is_not_there_says_so(fits, page, site, watch):
    answer = page.goto(f"{site.address}/compare?fits={fits}")
    assert answer.status in (404, 422)
    expect(page.locator("main")).to_contain_text(re.compile("no fit|give 2", re.IGNORECASE))
    watch.complaints.clear()  # the browser notes the status itself


def test_a_value_is_copied_with_its_unit_and_a_table_with_tabs(page, site, fitted):
    page.goto(f"{site.address}/fits/{fitted}#parameters")
    stored = site.client.get(f"/fits/{fitted}").json()["result"]["parameters"]["tau"]
    button = page.get_by_role("button", name=re.compile("^Copy τ = "))
    button.focus()
    page.keyboard.press("Enter")
    expect(page.locator("[role=status]", has_text="is copied")).to_have_count(1)
    value, unit = page.evaluate("navigator.clipboard.readText()").split()
    assert unit == "s"
    page.get_by_role("link", name="Summary").click()
    error = page.get_by_role("button", name="Copy Error, estimation runs = ")
    assert error.evaluate("button => getComputedStyle(button).opacity") == "0"
    error.focus()
    page.keyboard.press("Enter")
    expect(error).to_have_css("opacity", "1")
    assert re.fullmatch(r"[\d.]+ %", page.evaluate("navigator.clipboard.readText()"))
    assert float(value) == pytest.approx(stored["value"], rel=1e-7)
    table = page.locator("table", has_text="Mean over runs")
    expect(table.get_by_role("columnheader", name="MAE")).to_have_count(1)  # they come with the simulation
    table.get_by_role("button", name=re.compile("Copy the table")).click()
    expect(page.locator("[role=status]", has_text="The table is copied")).to_have_count(1)
    rows = [line.split("\t") for line in page.evaluate("navigator.clipboard.readText()").splitlines()]
    assert rows[0] == ["Runs", "RMSE", "With the mean", "Eq. (17)", "Noise floor", "Ratio", "Offset", "MAE"]
    assert {len(row) for row in rows} == {8}


def test_an_own_effect_has_other_parameters_and_a_state(page, site, watch, fitted):
    page.goto(f"{site.address}/fits/{fitted}#own")
    own = page.locator("form[data-own]")
    for label, text in (("Name", "droop"), ("Strength, symbol", "d"), ("Unit", "1"), ("Largest", "1")):
        own.get_by_label(label, exact=True).fill(text)
    own.get_by_label("Block and its output signal").select_option("flow")
    own.get_by_label("Equation").fill("Q = Q * (1 - d * z)")
    own.get_by_role("button", name="Add a parameter").click()
    shape = own.locator(".shape")
    for label, text in (("Symbol", "T"), ("Unit", "ms"), ("Value", "20"), ("Lowest", "1"), ("Largest", "100")):
        shape.get_by_label(label).fill(text)
    own.get_by_label("State, symbol").fill("z")
    own.get_by_label("Derivative of the state").fill("(abs(Q) - z) / bad")
    own.get_by_role("button", name="Check").click()
    expect(own.locator(".at mark")).to_have_text("b", timeout=LONG)
    expect(own.get_by_role("alert")).to_contain_text("state rate, character 16")
    expect(own.get_by_label("Derivative of the state")).to_be_focused()
    watch.complaints.clear()  # the browser's own line on the refusal
    own.get_by_label("Derivative of the state").fill("(abs(Q) - z) / T")
    own.get_by_role("button", name="Check").click()
    expect(own.locator("math")).to_have_count(2, timeout=LONG)
    expect(own.locator("[role=alert]")).to_be_empty()
