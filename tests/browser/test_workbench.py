"""The workbench, from the first page of the demo: find what is missing, add it, compare, approve, find by serial."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from tests.browser import story
from tests.browser.looks import everywhere
from tests.browser.window import Window, signed_in
from tests.hidden_dead_zone import zipped
from tests.running import LITTLE, Service, command, free_port

SOUND, LACKING = "SIM-0001", "SIM-0002"
NOISE = 0.5  # %, of each output of both
SEARCH = 1_200_000  # ms, for a search on 40 000 samples


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, full: bool) -> Iterator[Service]:
    """The demo, as a new user starts it; in the short form its diagnoses rank four effects."""
    data, first = tmp_path_factory.mktemp("demo"), "" if full else LITTLE
    with command("demo", "--port", free_port(), "--data", data, until="token=", first=first) as line:
        yield Service.that_said(line)


@pytest.fixture(scope="module")
def window(
    launch_browser: Callable[..., Browser], browser_type_launch_args: dict[str, object], site: Service
) -> Iterator[Window]:
    """A window of its own: the demo is not the service of the other files, and ends with these tests."""
    yield from signed_in(launch_browser, browser_type_launch_args, site)


def the_next_run_is_proposed(page):
    page.get_by_role("button", name="Propose a run").click()
    expect(page.locator(".next [data-text]")).to_contain_text("Run a ", timeout=story.LONG)
    with page.expect_download() as download:
        page.get_by_role("link", name="Download the command").click()
    assert download.value.suggested_filename.startswith("next-experiment-")


def an_own_effect_is_tried(page, watch):
    """Refused at its character, then shown as mathematics; with a curve as well."""
    story.section(page, "Model")
    page.get_by_text("Define your own effect").click()
    own = page.locator("form[data-own]")
    for label, text in (("Name", "overlap"), ("Strength, symbol", "h"), ("Unit", "mm"), ("Largest", "1")):
        own.get_by_label(label, exact=True).fill(text)
    own.get_by_label("Equation").fill("w = w - clip(w, -h, q!)")
    own.get_by_role("button", name="Check").click()
    expect(own.locator("mark")).to_have_text("!", timeout=story.LONG)
    expect(own.get_by_role("alert")).to_contain_text("character 22")
    watch.complaints.clear()  # the browser's own line on the refusal
    own.get_by_label("Equation").fill("w = w - clip(w, -h, h)")
    own.get_by_role("button", name="Check").click()
    expect(own.locator("math")).to_have_count(1, timeout=story.LONG)
    of_curve = {
        "symbol": "cv",
        "of the signal": "x",
        "knots with units": "-2 mm, 0 mm, 2 mm",
        "values there": "1, 0, 1",
        "unit": "1",
        "lowest": "0",
        "largest": "2",
    }
    for label, text in of_curve.items():
        own.get_by_label(f"Curve, {label}", exact=True).fill(text)
    own.get_by_label("Equation").fill("w = w - h * cv")
    own.get_by_role("button", name="Check").click()
    expect(own.locator("math")).to_have_count(2, timeout=story.LONG)


def the_first_page_says_what_to_do(page, screenshots):
    """A line for each of the two actuators, which changes by itself when a fit ends; the page of the failing fit."""
    sound, failing = (page.locator("tbody tr").filter(has_text=serial).locator(".next") for serial in (SOUND, LACKING))
    expect(page.locator("#main")).to_contain_text("actuators below are simulated")
    expect(sound).to_contain_text("The error is at the noise floor", timeout=story.LONG)
    expect(failing).to_contain_text(re.compile("The error is 2[0-9] times the noise floor"), timeout=story.LONG)
    everywhere(page, screenshots, "first")
    failing.get_by_role("link", name="Search for missing effects").click()
    expect(page.locator("h1")).to_contain_text(f"{LACKING}: ")
    expect(page.get_by_role("button", name="Search for missing effects")).to_be_in_viewport()


def the_error_falls_at_each_step(page):
    """Of what the search would add: from the fit as it is, with one effect, with both, which is noise."""
    cells = page.locator("table[aria-labelledby=steps] tbody td:nth-child(2)").all_inner_texts()
    errors = [float(cell.split()[0]) for cell in cells]
    assert len(errors) == 3
    assert all(after < before / 2 for before, after in pairwise(errors)), errors
    assert errors[-1] < 1.05 * NOISE


def the_first_page_leads_to_the_comparison(page, site):
    """With the error before and after, in the line and side by side."""
    page.goto(site.address)
    mended = page.locator("tbody tr").filter(has_text=LACKING).locator(".next")
    expect(mended.locator("xpath=..").locator(".parameters")).to_contain_text("Coulomb friction Fc")
    expect(mended).to_contain_text(re.compile(r"The error fell from 1\d\.\d % to 0\.\d+ %"))
    mended.get_by_role("link", name="Compare before and after").click()
    expect(page.locator("h1")).to_have_text("Two fits side by side")
    expect(page.locator("#main")).to_contain_text("+ Coulomb friction + dead zone")


def test_a_new_user_finds_what_is_missing_adds_it_and_sees_the_error_fall(page, site, watch, screenshots, full):
    page.goto(site.address)
    the_first_page_says_what_to_do(page, screenshots)
    before = page.url
    card = story.search(page, screenshots and screenshots / "searching.png")
    expect(page.locator(".verdict")).to_contain_text(re.compile("Missing: Coulomb friction .* and dead zone"))
    expect(card).to_contain_text("Coulomb friction")
    expect(card.locator(".evidence canvas")).to_be_visible(timeout=story.LONG)
    expect(
        page.get_by_role("button", name="Add all 2")
    ).to_be_in_viewport()  # the answer stays in sight as figures come
    assert card.locator("math").count() >= 1  # of a group an equation for each member
    the_error_falls_at_each_step(page)
    page.get_by_text("effects without significant improvement").click()
    if screenshots:
        page.locator("#missing").screenshot(path=screenshots / "cards.png")
    the_next_run_is_proposed(page)
    if full:
        an_own_effect_is_tried(page, watch)
    story.section(page, "Missing effects")
    everywhere(page, screenshots, "missing")

    first, second = story.add(page, page.locator("#missing"), "Coulomb friction, dead zone")
    assert first > 20 * NOISE
    assert second < 1.05 * NOISE
    expect(page.locator("#before")).to_contain_text(re.compile(r"1\d\.\d %"))
    added = page.locator("table.ladder tbody tr").last.inner_text()
    assert re.search(
        r"Coulomb friction, (59\.[89]|60\.[0-2])\d* ± 0\.\d+ N; dead zone, (39\d|40\d)\S* ± \S+ µm", added
    ), added
    story.section(page, "History")
    page.locator("#figure-ladder").scroll_into_view_if_needed()
    expect(page.locator("#figure-ladder canvas")).to_be_visible(timeout=story.LONG)
    everywhere(page, screenshots, "mended")
    expect(page.get_by_role("link", name="Open the previous fit")).to_have_attribute(
        "href", before.removeprefix(site.address).partition("#")[0]
    )
    mended = page.url
    the_first_page_leads_to_the_comparison(page, site)
    page.goto(mended)
    (found,) = story.approve(page, site, LACKING)
    assert "dead_zone.half_width" in found["parameters"]


def test_a_measured_actuator_goes_the_same_way(page, site, measured_data, full, tmp_path, screenshots):
    """Swept sines of a servo-hydraulic machine: the search takes minutes, as in the tests at full length."""
    if not full:
        pytest.skip("minutes long: run with --full")
    story.upload(page, site, packed(measured_data / "mts_actuator", tmp_path))
    (serial,) = page.locator(".crumbs a:last-child").all_inner_texts()
    story.fit(page)
    story.section(page, "Residuals")
    expect(page.get_by_role("heading", name="Residual analysis")).to_be_visible()
    page.locator("#figure-residual-map").scroll_into_view_if_needed()
    expect(page.locator("#figure-residual-map canvas")).to_be_visible(timeout=story.LONG)
    errors = page.locator("section:has-text('Error, eq. (17)') tbody tr").all_inner_texts()
    assert all(float(row.split("\t")[3].split()[0]) > 3 for row in errors), errors
    card = story.search(page, patience=SEARCH)
    everywhere(page, screenshots, "measured")
    first, second = story.add(page, card)
    assert second < first
    (found,) = story.approve(page, site, serial)
    assert [name for name in found["parameters"] if "." in name]


def packed(folder, target):
    """A matrix folder as one zip."""
    return Path(shutil.make_archive(str(target / "measured"), "zip", folder))


@pytest.mark.full
def test_a_search_can_be_cancelled_and_says_so(page, site):
    stored = site.client.post("/matrices", files={"files": ("matrix.zip", zipped("DZ-STOP"))}).json()
    fit = site.fit(stored["id"])
    assert site.ended(fit)["state"] == "succeeded"
    page.goto(f"{site.address}/fits/{fit}#missing")
    page.get_by_role("button", name="Search for missing effects").click()
    page.locator("#missing").get_by_role("button", name="Cancel").click(timeout=story.LONG)
    expect(page.locator("#missing")).to_contain_text("The last search was cancelled", timeout=story.LONG)
    expect(page.get_by_role("button", name="Search for missing effects")).to_be_enabled()
    page.goto(f"{site.address}/jobs")
    page.locator("tbody tr").filter(has_text="diagnosis").first.get_by_role("link").first.click()
    expect(page).to_have_url(f"{site.address}/fits/{fit}#missing")
