"""What an identified actuator is good for, in a browser: controller, hybrid simulation, files, what if, tracking."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from tests.app.conftest import zipped
from tests.browser import story
from tests.browser.looks import PHONE, barriers, everywhere, on_a_phone
from tests.short_form import short_form

SERIAL = "SW-USE"


def test_the_story_from_upload_to_the_files_of_a_rig(page, site, fitted, tmp_path, screenshots, full):
    """A record of one second is simulated under the controller that was designed, and follows its reference.

    In the short form it begins with a fit that is there.
    """
    if full:
        archive = tmp_path / "matrix.zip"
        archive.write_bytes(zipped(SERIAL))
        page.goto(f"{site.address}/?token={site.token}")
        story.upload(page, site, archive)
        story.fit(page)
    else:
        page.goto(f"{site.address}/fits/{fitted}")
    page.get_by_role("link", name="Use it").click()
    expect(page.locator("h1")).to_contain_text(f"Use {SERIAL if full else 'SW/1 <b>'}: ")
    a_controller_is_designed(page)
    its_files_are_downloaded(page, tmp_path)
    a_record_is_simulated_under_it(page, tmp_path)
    every_figure_is_downloaded(page, full)
    everywhere(page, screenshots, "use-it")


def a_controller_is_designed(page: Page) -> None:
    section = page.get_by_role("region", name="Controller", exact=True)
    section.get_by_label("Structure", exact=True).select_option("two-degree")
    section.get_by_role("button", name="Design the controller").click()
    expect(section.locator("#controller")).to_contain_text("Gain margin", timeout=story.LONG)
    expect(section.get_by_role("row", name="Phase margin").first).to_contain_text("°")
    expect(section.locator("canvas")).to_be_visible(timeout=story.LONG)


def its_files_are_downloaded(page: Page, folder: Path) -> None:
    """What the JSON holds is a controller of the case's sample rate; the header is C."""
    found = {}
    for name, text in (("json", "JSON"), ("h", "C header .h"), ("mat", "MATLAB .mat")):
        with page.expect_download() as download:
            page.locator("#controller").get_by_role("link", name=text, exact=True).click()
        assert download.value.suggested_filename == f"controller.{name}"
        download.value.save_as(folder / name)
        found[name] = (folder / name).read_bytes()
    assert json.loads(found["json"])["sample_rate"] == 4096
    assert b"servoident_step" in found["h"]
    assert found["mat"].startswith(b"MATLAB 5.0")


def a_record_is_simulated_under_it(page: Page, folder: Path) -> None:
    """Of a ground motion of one's own, with the controller that is shown chosen by itself."""
    record = folder / "quake.txt"
    record.write_text("\n".join(f"{a:.5f}" for a in 0.1 * np.sin(2 * np.pi * 2 * np.arange(51) * 0.02)))
    section = page.get_by_role("region", name="Hybrid simulation", exact=True)
    expect(section.get_by_label("Controller", exact=True).locator("option:checked")).to_contain_text("two-degree")
    section.get_by_label("Ground motion").select_option("record")
    section.get_by_label("Acceleration record").set_input_files(record)
    section.get_by_role("button", name="Run the simulation").click()
    answer = section.locator("#simulation")
    expect(answer).to_contain_text("Stable", timeout=story.LONG)
    expect(answer).to_contain_text("quake.txt")
    cells = answer.get_by_role("row", name="Reference, RMS").get_by_role("cell").all_inner_texts()
    under, without = (float(text.split()[0]) for text in cells[:2])
    assert under < 0.5
    assert without > 20
    expect(answer.locator("canvas")).to_have_count(2, timeout=story.LONG)


def every_figure_is_downloaded(page: Page, full: bool) -> None:
    """In the theme of the page, by its first bytes; in the short form one as SVG, else all, as PNG and PDF too."""
    begin = {"svg": b"<svg", "png": b"\x89PNG", "pdf": b"%PDF"}
    figures = page.locator(".figure")
    assert figures.count() == 3
    for place in range(figures.count() if full else 1):
        for kind, first in begin.items() if full else [("svg", begin["svg"])]:
            link = figures.nth(place).locator(f"a[data-format={kind}]")
            answer = page.request.get(f"{page.url.split('/fits')[0]}{link.get_attribute('href')}")
            assert answer.status == 200
            assert answer.body().startswith(first)


@pytest.mark.full
def test_what_if_is_an_address_that_can_be_kept(page, site, fitted):
    """Sizes and gains go into the address; the answer has poles, factors and both figures."""
    page.goto(f"{site.address}/fits/{fitted}/use")
    section = page.get_by_role("region", name="What-if analysis", exact=True)
    section.get_by_label("Area").fill("239 mm^2")
    section.get_by_label("Mass").fill("2.06 kg")
    section.get_by_label("From", exact=True).fill("2")
    section.get_by_label("To", exact=True).fill("3")
    section.get_by_role("button", name="Compute the response").click()
    answer = page.locator("#what-if-answer")
    expect(answer).to_contain_text("∝ A")
    assert "stroke" not in page.url  # what is empty is left out
    expect(section.get_by_label("Area")).to_have_value("239 mm^2")
    expect(answer.locator("canvas")).to_have_count(2, timeout=story.LONG)
    link = answer.locator("#figure-what-if-root-locus a[data-format=svg]").get_attribute("href")
    assert page.request.get(f"{site.address}{link}").body().startswith(b"<svg")
    assert barriers(page) == []


def test_a_run_is_followed(page, site, fitted):
    """Half a second of a fourth-order loop: no first-order loop holds, and the figure shows it."""
    page.goto(f"{site.address}/fits/{fitted}/use")
    section = page.get_by_role("region", name="Tracking", exact=True)
    section.get_by_role("button", name="Track the run").click()
    expect(section).to_contain_text("A first-order loop is not valid")
    expect(section.get_by_role("row", name="time constant")).to_contain_text("±")
    expect(section.locator("canvas")).to_be_visible(timeout=story.LONG)


@pytest.mark.parametrize(
    ("query", "said"),
    short_form(
        [
            ("ask=what-if&area=239", "unit"),
            ("ask=what-if&stroke=4%20in", "stroke"),
            ("ask=tracking&run=none", "no run"),
        ],
        ("ask=what-if&area=239", "unit"),
    ),
)
def test_what_cannot_be_answered_is_said_in_its_section(query, said, page, site, watch, fitted):
    """With the field still as it was written."""
    answer = page.goto(f"{site.address}/fits/{fitted}/use?{query}")
    assert answer.status == 422
    expect(page.get_by_role("alert").filter(has_text=said)).to_be_visible()
    watch.complaints.clear()  # the browser notes the status itself


def test_a_case_that_cannot_be_read_is_refused_beside_its_form(page, site, watch, fitted):
    page.goto(f"{site.address}/fits/{fitted}/use")
    section = page.get_by_role("region", name="Controller", exact=True)
    section.get_by_label("Case", exact=True).select_option("own")
    section.get_by_label("Custom case").fill("structure: {mass: 87.5 kg, stiffness: 87.5 s, damping: 0 N*s/m}")
    section.get_by_role("button", name="Design the controller").click()
    expect(section.get_by_role("alert")).to_contain_text("structure stiffness", timeout=story.LONG)
    watch.complaints.clear()  # the browser's own line on the refusal


BEAM = """
structure:
  mass: [87.5 kg, 87.5 kg]
  stiffness: {matrix: [[175, -87.5], [-87.5, 87.5]], unit: kN/m}
  damping: {ratio: 5 %}
physical:
  - {name: left, storey: 1, mass: 8 kg, stiffness: 17.5 kN/m}
  - {name: right, storey: 2, mass: 6 kg, stiffness: 10 kN/m, gain: 5}
gain: 7
piston_area: 497 mm^2
ground: {kind: blwn, band: 20 Hz, amplitude: 0.1 g, duration: 2 s}
"""


@pytest.mark.full
def test_two_actuators_of_an_own_case_have_a_column_and_figures_each(page, site, fitted, screenshots):
    """A case whose physical part is a list: scores side by side, two figures a part, the map over their delays."""
    page.goto(f"{site.address}/fits/{fitted}/use")
    section = page.get_by_role("region", name="Hybrid simulation", exact=True)
    section.get_by_label("Case", exact=True).select_option("own")
    section.get_by_label("Custom case").fill(BEAM)
    section.get_by_label("Controller", exact=True).select_option("none")
    section.get_by_label("also compute a stability map").check()
    section.get_by_role("button", name="Run the simulation").click()
    answer = section.locator("#simulation")
    expect(answer.get_by_role("columnheader", name="right")).to_be_visible(timeout=story.LONG)
    assert len(answer.get_by_role("row", name="Reference, RMS").get_by_role("cell").all_inner_texts()) == 3
    figures = answer.locator(".figure")
    expect(figures).to_have_count(5)
    for figure in figures.all():
        figure.scroll_into_view_if_needed()
        expect(figure.locator("canvas")).to_be_visible(timeout=story.LONG)
    everywhere(page, screenshots, "use-two-actuators")
    on_a_phone(page, screenshots, "use-two-actuators")


@pytest.mark.full
def test_a_shaking_table_has_its_spectrum_and_its_command(page, site, fitted, screenshots, full):
    """Each score stands beside its name on a phone, too; in the long form the page looks right in both themes."""
    asked = {"payload": {"mass": "8.75 kg"}, "band": ["0.5 Hz", "20 Hz"], "gain": 7, "piston_area": "497 mm^2"}
    motion = {"kind": "blwn", "amplitude": "0.05 g", "duration": "2 s"}
    body = {"fit": fitted, "case": asked, "ground": motion, "controller": "feedforward"}
    job = site.client.post("/hybrid-simulations", json=body).json()["id"]
    assert site.ended(job)["state"] == "succeeded"
    page.goto(f"{site.address}/fits/{fitted}/use?simulation={job}")
    answer = page.locator("#simulation")
    row = answer.get_by_role("row", name="Acceleration spectrum")
    expect(row).to_contain_text("against the record, 1 to 20 Hz")
    expect(answer.get_by_role("link", name="Download the command of the table as CSV")).to_be_visible()
    on_a_phone(page, screenshots, "use-table")
    value = row.get_by_role("cell").first.bounding_box()
    assert value is not None
    assert value["x"] + value["width"] < PHONE["width"]
    if full:
        everywhere(page, screenshots, "use-table")
