"""The page of a matrix and the way to it: dropped files, labels mended in place, a fit with what is chosen."""

from __future__ import annotations

from base64 import b64encode

import pytest
from playwright.sync_api import expect

from tests.app.conftest import archived, files
from tests.browser import story
from tests.browser.looks import everywhere

DROP = """(files) => {
  // What a browser hands over where a folder is dropped: entries, which a folder gives a batch at a time.
  const entry = (path) => path in files
    ? { isFile: true, fullPath: "/" + path, file: (done) => done(new File([read(files[path])], path)) }
    : { isFile: false, createReader: () => reader(path) };
  const read = (text) => Uint8Array.from(atob(text), (byte) => byte.charCodeAt(0));
  const reader = (folder) => {
    const below = Object.keys(files).filter((path) => path.startsWith(folder + "/"));
    const names = new Set(below.map((path) => path.slice(folder.length + 1).split("/")[0]));
    const batches = [[...names].map((name) => entry(folder + "/" + name)), []];
    return { readEntries: (done) => done(batches.shift()) };
  };
  const event = new Event("drop", { cancelable: true });
  event.dataTransfer = { items: [{ webkitGetAsEntry: () => entry(Object.keys(files)[0].split("/")[0]) }] };
  document.querySelector(".drop").dispatchEvent(event);
}"""


def test_a_wrong_unit_is_mended_in_place_for_all_runs(page, watch, site, tmp_path, screenshots):
    archive = tmp_path / "matrix.zip"
    wrong = {**files("SW-UNIT")}
    wrong["matrix.yaml"] = wrong["matrix.yaml"].replace(
        b"{column: displacement, unit: m}", b"{column: displacement, unit: mm}"
    )
    archive.write_bytes(archived(wrong))
    story.upload(page, site, archive)
    before, row = page.url, page.locator("#run-0")
    expect(row).to_contain_text("displacement is 0.0003")
    expect(row.locator("img")).to_have_js_property("naturalWidth", 160)
    everywhere(page, screenshots, "doubted")

    row.get_by_role("button", name="Edit").click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_label("Unit of displacement")).to_have_value("mm")
    everywhere(page, screenshots, "mend")
    dialog.get_by_role("button", name="Save as new revision").click()
    expect(dialog.get_by_role("alert")).to_contain_text("Nothing was changed")
    dialog.get_by_label("Unit of displacement").fill("furlongs")
    dialog.get_by_role("button", name="Save as new revision").click()
    expect(dialog.get_by_role("alert")).to_contain_text("furlongs")
    watch.complaints.clear()  # the browser notes the status of the refusal itself
    dialog.get_by_label("Unit of displacement").fill("m")
    dialog.get_by_label("Apply the change to all").check()
    dialog.get_by_role("button", name="Save as new revision").click()
    expect(page.get_by_text("· revision of")).to_be_visible()
    assert page.url != before
    expect(page.get_by_text("No errors, no warnings")).to_be_visible()
    expect(page.get_by_text("A newer revision exists")).to_have_count(0)
    newest = page.url
    page.goto(before)
    page.get_by_role("link", name="Open the newest revision").click()
    expect(page).to_have_url(newest)


@pytest.mark.full
def test_a_sign_is_turned_round_and_back_and_a_zero_is_stated(page, site, tmp_path):
    archive = tmp_path / "matrix.zip"
    archive.write_bytes(archived(files("SW-SIGN")))
    story.upload(page, site, archive)
    for turned in (True, False):
        before = page.url
        page.locator("#run-2").get_by_role("button", name="Edit").click()
        sign = page.get_by_role("dialog").locator("tr[data-channel=displacement]").get_by_role("checkbox")
        zero = page.get_by_label("Zero of displacement")
        expect(sign).to_be_checked(checked=not turned)
        expect(zero).to_have_value("" if turned else "true")
        sign.set_checked(turned)
        zero.select_option("set by hand for this run" if turned else "not stated")
        page.get_by_role("button", name="Save as new revision").click()
        expect(page).not_to_have_url(before)
        expect(page.locator("h1")).to_have_text("Test data of SW-SIGN")
        stored = site.client.get(f"/matrices/{page.url.rpartition('/')[2]}/description").json()["runs"][2]
        assert stored["channels"]["displacement"]["invert"] == str(turned).lower()
        assert stored["channels"]["displacement"].get("zeroed") == ("true" if turned else None)


@pytest.mark.usefixtures("running")
def test_a_fit_takes_what_is_chosen(page, site, matrix):
    page.goto(f"{site.address}/matrices/{matrix}")
    stored = site.client.get(f"/matrices/{matrix}").json()
    page.get_by_text("Model, method and bounds").click()
    page.get_by_role("textbox", name="tau from").fill("1 ms")
    page.get_by_role("button", name="Start the fit").click()
    expect(page.locator("#start").get_by_role("alert")).to_contain_text("Give both, or neither")
    page.get_by_role("textbox", name="tau to").fill("0.006")
    page.get_by_text("Preprocessing of the data").click()
    page.locator("#start").get_by_label("initial state").uncheck()
    page.get_by_text("Estimation and validation runs").click()
    page.locator("#start").get_by_label(stored["runs"][0]["id"]).uncheck()
    page.get_by_role("button", name="Start the fit").click()
    expect(page.locator("h1")).to_have_text("Fit of SW/1 <b>")
    job = site.client.get(f"/jobs/{page.url.rpartition('/')[2]}").json()
    assert job["settings"]["bounds"] == {"tau": [0.001, 0.006]}
    assert job["settings"]["preprocessing"] == {"initial_state": False}
    revised = site.client.get(f"/matrices/{job['matrix']}").json()
    assert revised["parent"] == matrix
    assert revised["runs"][0]["use"] == "verify"
    site.client.delete(f"/jobs/{job['id']}")


def test_a_dropped_folder_is_uploaded_with_its_paths(page, site):
    page.goto(f"{site.address}/upload")
    page.evaluate(DROP, {f"SW-DROP/{name}": b64encode(content).decode() for name, content in files("SW-DROP").items()})
    expect(page.locator("[data-chosen]")).to_contain_text("10 files")
    page.get_by_role("button", name="Upload").click()
    expect(page.locator("h1")).to_have_text("Test data of SW-DROP")


def test_an_upload_shows_how_far_it_is(page, site, tmp_path):
    archive = tmp_path / "matrix.zip"
    archive.write_bytes(archived(files("SW-SLOW")))
    held = []
    page.route("**/api/v1/matrices", lambda route: held.append(route))  # noqa: PLW0108  playwright wants a function
    page.goto(f"{site.address}/upload")
    bar = page.get_by_role("progressbar", name="Progress of the upload")
    expect(bar).to_be_hidden()
    page.get_by_label("Files").set_input_files(archive)
    page.get_by_role("button", name="Upload").click()
    expect(bar).to_be_visible()
    expect(page.locator("[data-stage]")).to_contain_text("sent")
    held[0].continue_()
    expect(page.locator("h1")).to_have_text("Test data of SW-SLOW")
