"""Raw files, described on the page alone: from three CSV files to a fit."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from playwright.sync_api import expect

from ident.readers import read_matrix
from ident.synthesis.matrix import simulate_matrix
from tests.app.conftest import unpacked
from tests.browser.looks import everywhere
from tests.cases import CASES

SHORT = ("names",)
"""Cases that are described on the page in the short form."""


def raw_files(folder):
    """Three runs of the simulated actuator as a bench leaves them: a clock, two channels nobody named, in mm."""
    simulate_matrix(folder / "matrix", "qian2014", 1.0, 3, 0.005, {}, small=True)
    runs = read_matrix(folder / "matrix").runs[:3]
    for number, run in enumerate(runs):
        with (folder / f"run{number}.csv").open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["t", "AI0", "AI1"])
            times = np.arange(run.length) / run.sample_rate
            writer.writerows(zip(times, 1e3 * run.command, 1e3 * run.measured, strict=True))
    return [folder / f"run{number}.csv" for number in range(3)]


@pytest.mark.full
def test_three_raw_files_become_a_fit_without_a_description(page, watch, site, tmp_path, screenshots):
    """Chosen, named, their units said, checked, made a matrix, fitted: nothing but the page. Short: until the job."""
    page.goto(f"{site.address}/upload")
    page.get_by_label("Files").set_input_files(raw_files(tmp_path))
    page.get_by_role("button", name="Upload").click()
    expect(page.get_by_role("heading", name="Describe the raw files")).to_be_visible()
    expect(page.locator("img").first).to_have_js_property("naturalWidth", 160)
    missing = page.locator("[data-question]")
    expect(missing).to_have_count(3)
    make = page.get_by_role("button", name="Create data set")
    expect(make).to_be_disabled()
    everywhere(page, screenshots, "raw-files")

    page.get_by_label("Unit of the time, column 't'").select_option("s")
    page.get_by_label("Serial number").fill("SW-RAW")
    page.get_by_label("What AI0 is").select_option("command")
    page.get_by_label("What AI1 is").select_option("command")
    expect(page.locator("#draft [role=alert]")).to_contain_text("Two columns are the command")
    page.get_by_label("What AI1 is").select_option("displacement")
    expect(missing).to_have_count(2)
    page.get_by_label("Unit of AI0").select_option("mm")
    page.get_by_label("Unit of AI1").select_option("mm")
    page.get_by_label("run2.csv").check()
    page.get_by_label("Piston area").fill("497 mm^2")
    page.get_by_label("Piston area").press("Tab")
    expect(missing).to_have_count(0, timeout=60_000)  # a process of its own reads and checks the files
    expect(page.locator("[data-findings]")).to_contain_text("specimen is not given")
    everywhere(page, screenshots, "raw-files-described")

    assert not watch.complaints

    make.click()
    expect(page.get_by_role("heading", name="Test data of SW-RAW")).to_be_visible()
    page.get_by_role("button", name="Start the fit").click()
    page.wait_for_url("**/fits/*")
    job = page.url.rpartition("/")[2]
    assert site.ended(job)["state"] == "succeeded"
    expect(page.get_by_role("heading", name="Error, eq. (17)")).to_be_visible(timeout=60_000)  # it shows itself


@pytest.mark.full
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_files_of_any_form_are_described_each_by_its_own(page, watch, site, tmp_path, case, full):
    """Each has its columns, units and time on the page, as it states them; the matrix has the clock of each.

    Short: one of more than one file.
    """
    if not full and case.name not in SHORT:
        pytest.skip("with --full; over HTTP and with init it is read in the short form, too")
    page.goto(f"{site.address}/upload")
    page.get_by_label("Files").set_input_files(case.paths())
    page.get_by_role("button", name="Upload").click()
    page.get_by_label("Serial number").fill(f"CASE-{case.name}")
    for file in case.files:
        for column, unit, role in zip(file.columns, file.units, ("time", "command", "displacement"), strict=True):
            page.get_by_label(f"What {column} is{of(case, file)}").select_option(role)
            if unit:
                page.get_by_label(f"Unit of {column}{of(case, file)}").select_option(unit)
    first, where = case.files[0], f" of {case.files[0].name}" if len(case.files) > 1 else ""
    clock = page.get_by_label(f"What {first.columns[0]} is{of(case, first)}")
    clock.select_option("command")
    expect(page.locator("#draft [role=alert]")).to_contain_text(f"Two columns{where} are the command.")
    clock.select_option("time")
    expect(page.locator("[data-question]")).to_have_count(0, timeout=60_000)
    expect(page.locator("#draft [role=alert]")).to_be_empty()
    for plot in page.locator("#draft td img").all():
        expect(plot).to_have_js_property("naturalWidth", 160)  # the draft, and so its plots, end with the data set
    page.get_by_role("button", name="Create data set").click(timeout=60_000)
    expect(page.get_by_role("heading", name=f"Test data of CASE-{case.name}")).to_be_visible(timeout=60_000)
    made = page.url.rpartition("/")[2]
    described = site.client.get(f"/matrices/{made}/description").content
    content = {f"runs/{path.name}": path.read_bytes() for path in case.paths()}
    case.right(read_matrix(unpacked({"matrix.yaml": described, **content}, tmp_path)).runs)
    assert not watch.complaints


def of(case, file) -> str:
    """How a label names the file, where there are more."""
    return f", in {file.name}" if len(case.files) > 1 else ""


@pytest.mark.full
def test_files_with_the_same_columns_can_be_described_one_by_one(page, site, tmp_path):
    """Three files of one layout have one table, or, where asked for, one each: a unit is said of one of them alone."""
    page.goto(f"{site.address}/upload")
    page.get_by_label("Files").set_input_files(raw_files(tmp_path))
    page.get_by_role("button", name="Upload").click()
    expect(page.locator("table.columns-of-files")).to_have_count(1)
    page.get_by_role("link", name="Describe each file separately").click()
    expect(page.locator("table.columns-of-files")).to_have_count(3)
    page.get_by_label("Serial number").fill("SW-APART")
    for number in range(3):
        of = f", in run{number}.csv"
        for column, role in (("t", "time"), ("AI0", "command"), ("AI1", "displacement")):
            page.get_by_label(f"What {column} is{of}").select_option(role)
            unit = "mm" if role != "time" else "s"
            page.get_by_label(f"Unit of {column}{of}", exact=True).select_option(
                "cm" if number == 1 and unit == "mm" else unit
            )
    expect(page.locator("[data-question]")).to_have_count(0, timeout=60_000)
    text = page.locator("[data-description] pre").text_content()
    assert (text.count("unit: mm"), text.count("unit: cm"), text.count("unit: s")) == (4, 2, 3)
