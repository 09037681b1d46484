"""Three files of three kinds become a fit by whoever knows the bench, and of the program only what its pages say."""

from __future__ import annotations

import re

import numpy as np
import pytest
from nptdms import ChannelObject, TdmsWriter
from playwright.sync_api import expect

from ident.readers import read_matrix
from ident.synthesis.matrix import simulate_matrix
from tests.browser.looks import everywhere, on_a_phone
from tests.browser.story import LONG

KNOWN = {
    "command": "AI0",
    "displacement": "AI1",
    "unit of command": "mm",
    "unit of displacement": "mm",
}
"""What a person knows of the third file, which states its sample rate, and neither its channels nor their units."""
MOST = 12  # actions


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Decimal commas below a preamble in Windows-1252, units in names, and a TDMS."""
    folder = tmp_path_factory.mktemp("kinds")
    simulate_matrix(folder / "matrix", "qian2014", 1.0, 3, 0.005, {}, small=True)
    first, second, third = read_matrix(folder / "matrix").runs[:3]
    times = np.arange(first.length) / first.sample_rate

    def rows(run, delimiter, scale):
        for row in zip(scale * times, 1e3 * run.command, 1e3 * run.measured, strict=True):
            yield delimiter.join(f"{value:.6f}" for value in row)

    head = ["Prüfstand 4", "Prüfer: Müller", "", "Zeit;Sollwert;Weg", "s;mm;mm"]
    commas = [line.replace(".", ",") for line in rows(first, ";", 1.0)]
    (folder / "morning.csv").write_bytes("\r\n".join([*head, *commas, ""]).encode("cp1252"))
    (folder / "noon.txt").write_text("\n".join(["t_ms,cmd_mm,pos_mm", *rows(second, ",", 1e3), ""]))
    with TdmsWriter(folder / "evening.tdms") as writer:
        step = {"wf_increment": 1.0 / third.sample_rate}
        of_third = (("AI0", 1e3 * third.command), ("AI1", 1e3 * third.measured))
        writer.write_segment([ChannelObject("Bench", name, values, step) for name, values in of_third])
    return [folder / name for name in ("morning.csv", "noon.txt", "evening.tdms")]


def answered(question) -> None:
    """One question by what is known of the bench, chosen by the words of the page alone."""
    text = question.locator("label").text_content().lower()
    field = question.locator("select, input")
    known = re.search(r"unit of \w+|is the (\w+)", text)
    assert known, f"the page asks what nobody said that it would: {text}"
    wanted = KNOWN[known[1] or known[0]]
    options = field.locator("option").all_text_contents()
    field.select_option(label=next(one for one in options if one.endswith(wanted)))


def test_three_files_of_three_kinds_become_a_fit_in_twelve_actions(page, site, files, screenshots):
    page.goto(f"{site.address}/upload")
    page.get_by_label("Files").set_input_files(files)
    page.get_by_role("button", name="Upload").click()
    page.get_by_label("Serial number").fill("SW-KINDS")
    actions = 3
    make, questions = page.get_by_role("button", name="Create data set"), page.locator("[data-question]")
    expect(questions.or_(page.locator("[data-findings] li")).first).to_be_visible(timeout=LONG)
    everywhere(page, screenshots, "import")
    on_a_phone(page, screenshots, "import")
    while questions.count():
        asked = questions.first.get_attribute("data-question")
        answered(questions.first)
        actions += 1
        expect(page.locator(f'[data-question="{asked}"]')).to_have_count(0, timeout=LONG)
    expect(make).to_be_enabled(timeout=LONG)
    make.click()
    page.get_by_role("button", name="Start the fit").click(timeout=LONG)
    page.wait_for_url("**/fits/*")
    assert actions + 2 <= MOST
    job = page.url.rpartition("/")[2]
    found = site.client.get(f"/jobs/{job}").json()
    runs = site.client.get(f"/matrices/{found['matrix']}").json()["runs"]
    site.client.delete(f"/jobs/{job}")
    site.ended(job)
    assert [run["id"] for run in runs] == ["evening", "morning", "noon"]
    assert {round(run["sample_rate"], 3) for run in runs} == {
        read_matrix(files[0].parent / "matrix").runs[0].sample_rate
    }


@pytest.mark.full
def test_another_dialect_is_previewed_and_what_was_said_of_other_files_stays(page, site, files):
    """A menu changes what the service reads; a delimiter that no line has shows the lines and the problem."""
    page.goto(f"{site.address}/upload")
    page.get_by_label("Files").set_input_files(files)
    page.get_by_role("button", name="Upload").click()
    page.get_by_label("What Bench/AI0 is").select_option("command")
    first = page.get_by_role("group", name="First lines of morning.csv")
    expect(first).to_contain_text("Prüfer: Müller")
    page.get_by_label("Encoding, in morning.csv").select_option("dos-850")
    expect(first).to_contain_text("Pr³fer: M³ller", timeout=LONG)
    page.get_by_label("Delimiter, in morning.csv").select_option("pipe")
    expect(page.locator('[data-question="dialect morning.csv"]')).to_contain_text("cannot be read", timeout=LONG)
    expect(first).to_contain_text("Zeit;Sollwert;Weg")
    expect(page.get_by_label("What Bench/AI0 is")).to_have_value("command")
    page.get_by_label("Delimiter, in morning.csv").select_option("semicolon")
    expect(page.get_by_label("What Weg is")).to_have_value("displacement", timeout=LONG)
    page.get_by_label("Lines above the samples, in morning.csv").fill("8")
    page.keyboard.press("Tab")
    expect(page.get_by_role("columnheader", name="morning.csv, ")).to_contain_text("4093 samples", timeout=LONG)
