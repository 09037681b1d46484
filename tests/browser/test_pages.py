"""Every page in a browser: it opens, complains of nothing, asks no other origin, and shows what is stored."""

from __future__ import annotations

import json
import re

import pytest
from playwright.sync_api import Error, expect

from ident.words.duration import duration, time_left_said
from ident.words.engineering import power_of, scaled_unit
from tests.app.access.table import PAGES
from tests.app.access.test_audit import RAW
from tests.app.conftest import zipped
from tests.browser.looks import WIDTHS, barriers, drawn, everywhere, on_a_phone
from tests.running import Service
from tests.short_form import short_form

FIGURE = "#figure-residual-map"
SHORT = {"generations": 4, "population": 20, "elite": 3}  # of a search whose result is only to be there


SHOWN = [call for call in PAGES if call.method == "GET" and not re.search(r"\.svg|\.json", call.path)]
"""Every page of the service: the table of who may call what is complete, which tests/app/access holds."""
OF_A_DAY = {
    "/",
    "/actuators/{serial}",
    "/upload",
    "/matrices/{matrix}",
    "/jobs",
    "/fits/{fit}",
    "/fits/{fit}/use",
    "/statistics",
    "/limits",
    "/regressions",
}
"""Those looked at by all rules; the other tests do so with those that need more than is here."""
ELSEWHERE = {
    "/search", "/units", "/matrices/{matrix}/signals", "/live", "/jobs/{job}", "/compare", "/tokens", "/audit",
    "/regressions/{regression}", "/webhooks", "/retention", "/{path}", "/actuators/{serial}", "/workers", "/statistics",
    "/limits", "/regressions",
}  # fmt: skip
"""Those that a story opens; `app/access/test_offers` has fields and tables of all."""
DARK = {"/", "/upload"}
"""Of these a list and a form are looked at in the dark theme, too, with ``--full`` all."""


@pytest.fixture(scope="module")
def addresses(site: Service, matrix: str, fitted: str) -> dict[str, str]:
    """The address of each page, with something on it, by its route."""
    draft = site.client.post("/drafts", files={"files": ("run.csv", RAW)}).json()["id"]
    regression = site.client.post("/regressions", json={"serial": "nobody"}).json()["id"]
    job = site.client.post("/fits", json={"matrix": matrix, "seed": 21}).json()["id"]
    site.client.delete(f"/jobs/{job}")  # that of a finished fit leads to the fit
    site.ended(job)
    about = {
        "serial": "SW/1%20%3Cb%3E",
        "matrix": matrix,
        "fit": fitted,
        "draft": draft,
        "regression": regression,
        "job": job,
        "path": "nothing/here",
        "name": "cli",
    }
    return {call.path: f"{call.path.format(**about)}?{call.query.format(**about)}" for call in SHOWN}


@pytest.mark.parametrize(
    "path", short_form([call.path for call in SHOWN], *(call.path for call in SHOWN if call.path not in ELSEWHERE))
)
def test_a_page_fits_desk_tablet_and_phone_and_shuts_nobody_out(path, page, watch, site, addresses, screenshots, full):
    """Every field has a label and every column of a table a heading."""
    page.goto(site.address + addresses[path])
    expect(page.locator("h1")).to_have_count(1)
    unlabelled = page.evaluate(
        """[...document.querySelectorAll("input:not([type=hidden]), select")]
             .filter((field) => !field.hidden && field.labels.length === 0 && !field.ariaLabel)
             .map((field) => field.outerHTML)"""
    )
    assert unlabelled == []
    ragged = page.evaluate(
        """[...document.querySelectorAll("table")].filter((table) => [...table.tBodies[0].rows]
             .some((row) => row.cells.length !== table.tHead.rows[0].cells.length)).length"""
    )
    assert ragged == 0
    name = re.sub(r"\W+", "-", path).strip("-") or "actuators"
    if path in OF_A_DAY:
        everywhere(page, screenshots, name, dark=full or path in DARK)
    on_a_phone(page, screenshots, name)
    watch.complaints[:] = [said for said in watch.complaints if "404" not in said or path != "/{path}"]


def a_figure_and_the_ground_follow_the_system_theme(page):
    for theme in ("light", "dark"):
        page.emulate_media(color_scheme=theme)
        expect(page.locator(f"{FIGURE} .plot")).to_have_attribute("aria-busy", re.compile("true|false"))
        drawn(page, theme)
        expect(page.locator(f"{FIGURE} a[data-format=svg]")).to_have_attribute("href", re.compile(f"theme={theme}"))
        expect(page.locator(f"{FIGURE} canvas")).to_be_visible()
        ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert (sum(map(int, re.findall(r"\d+", ground))) < 200) == (theme == "dark")


def the_run_table_sorts_by_number(page):
    page.get_by_text("Table of the 12 runs").click()
    page.get_by_role("button", name="Eq. (17)", exact=True).click()
    texts = page.locator("table:has([data-pick]) tbody td:nth-child(4)").all_inner_texts()
    errors = [float(text.split()[0]) for text in texts]
    assert errors == sorted(errors)
    assert len(errors) == 12


def the_figures_are_reached_by_keyboard(page, full):
    tabs = page.locator("[role=tablist] [role=tab]")
    names = [tab.removeprefix("tab-") for tab in tabs.evaluate_all("tabs => tabs.map(tab => tab.id)")]
    assert {"bode", "time", "evolution", "residual-curve", "sensitivity"} <= set(names)
    tabs.first.focus()
    for name in names[1:] if full else names[1:2]:
        page.keyboard.press("ArrowRight")
        expect(page.locator(f"#tab-{name}")).to_be_focused()
        expect(page.locator(f"#figure-{name} canvas")).to_be_visible(timeout=60_000)
        for width in WIDTHS if full else WIDTHS[-1:]:  # none stands out of its place
            page.set_viewport_size({"width": width, "height": 900})
            drawn, room = page.locator(f"#figure-{name} .plot").evaluate("plot => [plot.scrollWidth, plot.clientWidth]")
            assert drawn <= room, f"{name} at {width} px"


def test_residuals_follow_the_theme_are_sorted_by_number_and_reached_by_keyboard(page, site, fitted, full):
    page.goto(f"{site.address}/fits/{fitted}#residuals")
    a_figure_and_the_ground_follow_the_system_theme(page)
    the_run_table_sorts_by_number(page)
    the_figures_are_reached_by_keyboard(page, full)


def test_what_is_pressed_before_the_scripts_have_come_is_heard(page, site, fitted):
    held = []
    page.route(re.compile(r"/own\.js"), lambda route: held.extend([route]))  # a bound method cannot be marked
    page.goto(f"{site.address}/fits/{fitted}#own", wait_until="commit")
    own = page.locator("form[data-own]")
    fields = {"Name": "overlap", "Strength, symbol": "h", "Unit": "mm", "Largest": "1", "Equation": "w = w - h"}
    for label, text in fields.items():
        own.get_by_label(label, exact=label != "Equation").fill(text)
    for _ in range(2):
        own.get_by_role("button", name="Check").click()
    expect(own.locator("math")).to_have_count(0)
    held[0].continue_()
    expect(own.locator("math")).to_have_count(1)
    assert page.url == f"{site.address}/fits/{fitted}#own"


def test_a_running_fit_is_told_to_everybody(page, site, running, screenshots):
    page.goto(f"{site.address}/fits/{running}")
    expect(page.locator("[data-step]")).to_contain_text("of 10000", timeout=60_000)
    expect(page.get_by_role("progressbar", name="Progress of the fit")).to_be_visible()
    expect(page.locator("[data-elapsed]")).to_have_text(re.compile(r"\d+ s$"))
    expect(page.locator("[data-left]")).to_have_text(re.compile(r"^(not known yet|about \d.*)$"))
    everywhere(page, screenshots, "running")
    on_a_phone(page, screenshots, "running")
    page.goto(f"{site.address}/jobs")
    row = page.get_by_role("row").filter(has_text=running[:12])
    expect(row).to_contain_text(re.compile(r"not known yet|about \d"))
    everywhere(page, screenshots, "jobs-running")


def test_a_script_says_durations_as_the_service_does(page, site):
    page.goto(site.address)
    at = page.locator("script[src*='/static/']").first.get_attribute("src").rpartition("/")[0]
    seconds = [0.4, 7.6, 23, 47, 59.9, 60, 94, 131, 1000, 3600, 5000, 8430]
    said = page.evaluate(
        f"async (all) => {{ const words = await import('{at}/words.js');"
        " return all.map((s) => [words.duration(s), words.timeLeft({ seconds: s, lower: s / 2, upper: 2 * s })]); }",
        seconds,
    )
    assert said == [[duration(s), time_left_said(s, s / 2, 2 * s)] for s in seconds]


def test_the_title_of_the_tab_tells_how_far_a_job_is_and_how_it_ended(page, site, running):
    page.goto(f"{site.address}/fits/{running}")
    expect(page).to_have_title(re.compile(r"^(\d+ %|\d.* left) · "))
    page.get_by_role("button", name="Cancel").click()
    expect(page).to_have_title(re.compile(r"^cancelled · "), timeout=60_000)
    page.keyboard.press("Tab")
    expect(page).not_to_have_title(re.compile(r"^cancelled · "))


def test_the_verdict_of_the_catalogue_is_told_while_terms_are_searched_for(page, site, running):
    """By the events that tell how far the job is; before there is one nothing is shown."""
    job = site.client.get(f"/jobs/{running}").json()
    job["progress"] |= {"stage": "terms", "verdict": "The model lacks dead zone <b>."}
    told = {"content_type": "text/event-stream", "body": f"event: running\ndata: {json.dumps(job)}\n\n"}
    held = []
    page.route("**/events", lambda route: held.append(route))  # noqa: PLW0108  a builtin cannot be marked as heard
    with page.expect_request("**/events"):
        page.goto(f"{site.address}/fits/{running}")
    verdict = page.locator(".live [data-verdict]")
    expect(verdict).to_be_hidden()
    held[0].fulfill(**told)
    expect(verdict).to_contain_text("The model lacks dead zone <b>.")


def test_the_policy_allows_no_inline_and_no_evaluated_script(page, watch, site):
    policy = page.goto(site.address).headers["content-security-policy"]
    assert "default-src 'none'; script-src 'self'; style-src 'self';" in policy
    assert "unsafe" not in policy
    with pytest.raises(Error, match="Content Security Policy"):
        page.add_script_tag(content="document.title = 'ran'")
    assert page.evaluate("document.title") != "ran"
    watch.complaints.clear()  # the browser notes what it refused


def test_what_shuts_somebody_out_is_found(page, site):
    page.goto(f"{site.address}/upload")
    assert barriers(page) == []
    page.evaluate("document.querySelector('label[for=files]').remove()")
    page.evaluate("document.querySelector('h1').remove()")  # only of moderate impact
    assert [barrier.split(":")[0] for barrier in barriers(page)] == ["label", "page-has-heading-one"]


def the_stored_parameters_and_errors_are_shown(page, result):
    for name, entry in result["parameters"].items():
        cells = page.locator(f"tr:has(th[title='{name}']) td").all_inner_texts()
        power = power_of(entry["value"])
        assert float(cells[1].replace("−", "-")) * 10**power == pytest.approx(entry["value"], rel=2e-4)
        assert float(cells[2]) * 10**power == pytest.approx(entry["std_error"], rel=0.5)
        assert cells[3] == scaled_unit(entry["unit"], power)
    errors = page.locator("section:has-text('Error, eq. (17)') tbody tr").all_inner_texts()
    assert len(errors) == 2
    for row, use in zip(errors, ("fit", "verify"), strict=True):
        assert f"{100 * result['error'][use]:.3g}" in row


def test_a_fit_has_its_stored_numbers_in_tabs_that_the_address_keeps_and_a_summary_of_a_screen(page, site, fitted):
    """By a link, by going back, by a place inside one; without scripts every section stands there."""
    page.set_viewport_size({"width": 1280, "height": 800})
    page.goto(f"{site.address}/fits/{fitted}")
    the_stored_parameters_and_errors_are_shown(page, site.client.get(f"/fits/{fitted}").json()["result"])
    summary, model = page.locator("#summary"), page.locator("#model")
    expect(page.locator("[data-white]")).to_contain_text(re.compile("^(pass|fail) on estimation data"), timeout=60_000)
    expect(page.locator("#nrmse-verify")).to_contain_text("%")
    expect(page.locator("figure.budget")).to_be_visible(timeout=60_000)
    box = summary.bounding_box()
    assert box["y"] + box["height"] <= 800
    page.get_by_role("navigation", name="Sections of the fit").get_by_role("link", name="Model").click()
    expect(model).to_be_visible()
    expect(summary).to_be_hidden()
    expect(page.locator("form[data-own]")).to_be_hidden()  # until it is asked for
    assert page.url.endswith("#model")
    page.reload()
    expect(model).to_be_visible()
    page.go_back()
    expect(summary).to_be_visible()
    page.goto(f"{site.address}/fits/{fitted}#own")
    expect(page.locator("form[data-own]")).to_be_visible()
    shown = page.request.get(f"{site.address}/fits/{fitted}").text()
    assert not re.search(r"data-section[^>]* hidden", shown)


@pytest.mark.full
def test_a_figure_follows_its_options_and_the_theme(page, site, fitted):
    page.emulate_media(color_scheme="light")
    page.goto(f"{site.address}/fits/{fitted}#residuals")
    page.locator("#tab-bode").click()
    link = page.locator("#figure-bode a[data-format=svg]")
    expect(link).to_have_attribute("href", re.compile("theme=light"))
    page.locator("#bode-axis").select_option("linear")
    expect(link).to_have_attribute("href", re.compile("axis=linear"))
    page.locator("#theme").select_option("dark")
    expect(link).to_have_attribute("href", re.compile("theme=dark"))
    expect(page.locator("#figure-bode .plot")).to_have_attribute("aria-busy", "false", timeout=60_000)
    answer = page.request.get(site.address + link.get_attribute("href"))
    assert answer.headers["content-type"].startswith("image/svg+xml")
    page.reload()
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"


@pytest.mark.usefixtures("matrix")
def test_a_serial_number_with_markup_is_text(page, site):
    page.goto(site.address)
    page.get_by_label("Serial number, name or batch").fill("SW/1 <b>")
    page.keyboard.press("Enter")
    page.get_by_role("link", name="SW/1 <b>").click()
    expect(page.locator("h1")).to_have_text("SW/1 <b>")


def test_a_search_without_a_hit_says_so(page, site):
    page.goto(f"{site.address}/?q=nowhere")
    expect(page.locator("main")).to_contain_text("No actuator has “nowhere”")


@pytest.mark.parametrize(
    "path", short_form(["/nothing/here", "/fits/none", "/matrices/none", "/actuators/none"], "/nothing/here")
)
def test_what_is_not_there_is_said_on_a_page_with_a_way_on(path, page, watch, site, screenshots):
    answer = page.goto(site.address + path)
    assert answer.status == 404
    expect(page.locator("h1")).to_have_text("Not found")
    expect(page.get_by_role("link", name="All actuators")).to_be_visible()
    everywhere(page, screenshots, f"problem-{path.split('/')[1]}")
    watch.complaints.clear()  # the browser notes the status itself


@pytest.mark.full
def test_the_whole_way_from_upload_to_approval(page, site, tmp_path):
    archive = tmp_path / "matrix.zip"
    archive.write_bytes(zipped("SW-NEW"))
    page.goto(f"{site.address}/upload")
    page.get_by_label("Files").set_input_files(archive)
    page.get_by_role("button", name="Upload").click()
    expect(page.locator("h1")).to_have_text("Test data of SW-NEW")
    page.get_by_text("Model, method and bounds").click()
    page.get_by_label("Seed").fill("3")
    page.get_by_role("button", name="Start the fit").click()
    page.get_by_role("button", name="Approve for SW-NEW").click(timeout=120_000)
    expect(page.locator(".head .state.approved")).to_contain_text("current parameter set")
    assert site.client.get("/actuators/SW-NEW").json()["current"] is not None
    page.goto(f"{site.address}/?q=SW-NEW")
    expect(page.locator("tbody tr")).to_contain_text("approved")
    expect(page.locator("tbody tr")).to_contain_text("Z₀")
    expect(page.locator("svg.spark")).to_have_count(0)


@pytest.mark.full
def test_drift_is_seen_once_a_second_set_is_approved(page, site, screenshots):
    stored = site.client.post("/matrices", files={"files": ("matrix.zip", zipped("SW-DRIFT"))}).json()
    for seed, bounds in enumerate(({}, {"tau": ["3.7 ms", "4 ms"]}, {"tau": ["3.65 ms", "4 ms"]})):
        fit = site.fit(stored["id"], seed=seed, bounds=bounds, options=SHORT)
        assert site.ended(fit)["state"] == "succeeded"
        assert site.client.post(f"/fits/{fit}/approve", json={"why": "as it came"}).status_code == 200
    page.goto(f"{site.address}/?q=SW-DRIFT")
    page.get_by_label("Drift of").select_option("tau")
    page.get_by_role("button", name="Search").click()
    expect(page.locator("svg.spark")).to_have_accessible_name(
        re.compile("^τ over 3 approved sets, from .* ms to .* ms, ")
    )
    everywhere(page, screenshots, "drift")
    page.get_by_role("link", name="SW-DRIFT").click()
    expect(page.get_by_role("heading", name="Drift of the approved parameters")).to_be_visible()
    expect(page.locator("svg.spark")).to_have_count(7)
    everywhere(page, screenshots, "drifts")


@pytest.mark.usefixtures("running")
def test_a_waiting_fit_can_be_cancelled(page, site, matrix):
    """It waits behind one that searches for longer than the test takes."""
    waiting = site.client.post("/fits", json={"matrix": matrix, "seed": 12}).json()
    page.goto(f"{site.address}/fits/{waiting['id']}")
    page.get_by_role("button", name="Cancel").click()
    expect(page.locator("main")).to_contain_text("The job was cancelled. Nothing was stored.", timeout=60_000)
    assert site.client.get(f"/jobs/{waiting['id']}").json()["state"] == "cancelled"


def test_a_refused_upload_says_what_where_and_the_remedy(page, watch, site, tmp_path):
    bad = tmp_path / "matrix.zip"
    bad.write_bytes(b"not a zip at all")
    page.goto(f"{site.address}/upload")
    page.get_by_label("Files").set_input_files(bad)
    page.get_by_role("button", name="Upload").click()
    said = page.get_by_role("alert")
    expect(said).not_to_be_empty()
    assert said.inner_text().endswith(".")
    assert "Traceback" not in page.content()
    watch.complaints.clear()  # the browser notes the status itself


def test_what_is_left_is_told_in_its_unit_and_a_profile_is_drawn_when_it_is_opened(page, site, fitted, full):
    """With its downloads, in the full form in both themes; the choice of a parameter draws another."""
    page.goto(f"{site.address}/fits/{fitted}#parameters")
    expect(page.locator('[data-size="use:fit"][data-of="mae"]')).to_have_text(re.compile(r"\d.*m$"), timeout=60_000)
    figure = page.locator("#figure-profile")
    expect(figure).to_be_hidden()
    page.locator("#profile summary").click()
    for theme in ("light", "dark") if full else ("light",):
        page.emulate_media(color_scheme=theme)
        expect(figure.locator("a[data-format=pdf]")).to_have_attribute("href", re.compile(f"theme={theme}"))
        expect(figure.locator("canvas")).to_be_visible(timeout=60_000)
    figure.get_by_label("Parameter").select_option("tau")
    expect(figure.locator("a[data-format=svg]")).to_have_attribute("href", re.compile("parameter=tau"))
