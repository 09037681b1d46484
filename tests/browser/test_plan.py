"""A test planned in the browser, played on an independent reference, uploaded and fitted."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
import yaml
from playwright.sync_api import Page, expect

from tests.browser import story
from tests.browser.looks import everywhere, on_a_phone
from tests.reference.qian_reference import Cell, Plant, simulate
from tests.running import Service

OWN = """\
gains: [5, 10]
amplitudes: [0.5 mm, 2 mm]
specimens: [{mass: 0 kg}]
verify: {gains: [7]}
seconds: 1 s
"""
SPEED = 0.6  # m/s
NOISE = 0.005  # of the displacement's standard deviation
SEED = 562


def played(sent: bytes, folder: Path) -> Path:
    """The archive of a plan with what a reference answers to each command, within the speed that was stated."""
    rng, answered = np.random.default_rng(SEED), folder / "answered.zip"
    with zipfile.ZipFile(io.BytesIO(sent)) as plan, zipfile.ZipFile(answered, "w") as out:
        out.writestr("matrix.yaml", plan.read("matrix.yaml"))
        for run in yaml.safe_load(plan.read("matrix.yaml"))["runs"]:
            time, command = np.loadtxt(plan.open(f"commands/{run['id']}.csv"), delimiter=",", skiprows=1).T
            x = simulate(Plant(), Cell(0.0, 0.0, 0.0, run["gain"]), 1e-3 * command)
            assert np.abs(np.gradient(x)).max() * 4096 <= SPEED, run["id"]
            x += NOISE * x.std() * rng.standard_normal(len(x))
            header = "time_s,command_mm,displacement_mm"
            rows, text = np.column_stack([time, command, 1e3 * x]), io.StringIO()
            np.savetxt(text, rows, "%.9g", ",", header=header, comments="")
            out.writestr(run["file"], text.getvalue())
    return answered


@pytest.mark.full
def test_a_plan_is_played_uploaded_and_fitted(
    page: Page, site: Service, screenshots: Path | None, tmp_path: Path, watch
):
    """No run leaves the stated speed; the error on validation runs is the noise; the form keeps its values."""
    page.goto(f"{site.address}/plan")
    page.get_by_label("Program", exact=True).select_option("own")
    page.get_by_text("Custom lists (YAML)").click()
    page.get_by_label("Gains, amplitudes, specimens, kinds").fill(OWN)
    page.get_by_label("Speed", exact=True).fill("1 m/min/s")
    page.get_by_role("button", name="Plan the runs").click()
    expect(page.locator("form[data-plan] [role=alert]")).to_contain_text("speed", timeout=story.LONG)
    watch.complaints.clear()  # the browser's own line on the refusal
    page.get_by_label("Speed", exact=True).fill(f"{SPEED} m/s")
    page.get_by_role("button", name="Plan the runs").click()
    made = page.locator("#made")
    expect(made.get_by_role("heading")).to_contain_text("6 runs of own", timeout=story.LONG)
    expect(page.get_by_label("Program", exact=True)).to_have_value("own")
    everywhere(page, screenshots, "plan")
    on_a_phone(page, screenshots, "plan")
    with page.expect_download() as download:
        made.get_by_role("link", name="CSV").click()
    story.upload(page, site, played(Path(download.value.path()).read_bytes(), tmp_path))
    fit = story.fit(page).rpartition("/")[2].partition("#")[0]
    found = site.client.get(f"/fits/{fit}").json()
    assert 0.8 * NOISE < found["result"]["error"]["verify"] < 1.2 * NOISE
