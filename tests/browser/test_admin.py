"""The admin's and the line's pages in a browser: webhooks, retention, workers, statistics, limits; in both themes."""

from __future__ import annotations

import re
from datetime import timedelta

import pytest
from playwright.sync_api import Page, expect

from app.database import connect, sessions
from app.tables import FitRow, MatrixRow, before
from tests.app.webhooks.world import set_of
from tests.browser.looks import everywhere, on_a_phone
from tests.running import Process

OLD = before(timedelta(days=40))
SETS = ("f-BESIDE", "f-THIRD")


@pytest.fixture(scope="module")
def old(site: Process) -> str:
    """A matrix whose set was never approved, as it was 40 days ago, its serial number; and two actuators beside it."""
    engine = connect(f"sqlite:///{site.data / 'servoident.sqlite'}")
    with sessions(engine).begin() as session:
        set_of(session, "OLD-1")
        set_of(session, "BESIDE")
        set_of(session, "THIRD")
        session.flush()
        session.get_one(MatrixRow, "m-OLD-1").created_at = OLD
        session.get_one(FitRow, "f-OLD-1").created_at = OLD
    engine.dispose()
    return "OLD-1"


def test_a_webhook_is_made_shown_failing_and_revoked(page: Page, site: Process, old: str, screenshots) -> None:
    """Its secret is shown once; nobody listens at that port, which the last deliveries say."""
    page.goto(f"{site.address}/webhooks")
    expect(page.get_by_role("heading", name="No webhooks yet")).to_be_visible()
    page.get_by_label("URL to notify").fill("http://127.0.0.1:9/told")
    page.get_by_label("a job has ended").uncheck()
    page.get_by_role("button", name="Create the webhook").click()
    secret = page.locator(".made code").inner_text()
    assert len(secret) == 43
    page.get_by_role("link", name="Done").click()
    row = page.locator("table[data-sortable] tbody tr")
    expect(row).to_contain_text("in use")
    assert secret not in page.content()
    assert old
    site.client.post("/fits/f-BESIDE/approve", json={"why": "as it is"})
    site.client.post("/fits/f-BESIDE/withdraw")
    sent = page.locator("section", has=page.get_by_role("heading", name="Last deliveries")).locator("tbody tr")
    for _ in range(100):
        page.reload()
        if "not reached" in page.content():
            break
        page.wait_for_timeout(100)
    expect(sent).to_have_count(2)
    expect(sent.last).to_contain_text("set.approved")
    everywhere(page, screenshots, "webhooks")
    row = page.locator("table[data-sortable] tbody tr")
    row.get_by_role("button").click()
    row.get_by_role("button").click()
    expect(row).to_contain_text("revoked")
    expect(sent.first).to_contain_text("dropped")


def test_raw_runs_that_may_go_are_shown_and_removed(page: Page, site: Process, old: str, screenshots) -> None:
    """The button asks twice; then the page of the matrix says since when they are gone."""
    page.goto(f"{site.address}/retention")
    row = page.get_by_role("row", name=re.compile(old))
    expect(row).to_contain_text("never approved")
    everywhere(page, screenshots, "retention")
    page.get_by_role("button", name="Delete the raw data").click()
    expect(row).to_be_visible()
    page.get_by_role("button", name="Delete the raw data for good").click()
    expect(page.get_by_text("Nothing is eligible for deletion now.")).to_be_visible()
    page.goto(f"{site.address}/matrices/m-{old}")
    expect(page.get_by_text("Raw data deleted by the retention rule")).to_be_visible()
    expect(page.get_by_role("button", name="Start the fit")).to_have_count(0)


def test_a_backup_is_taken_by_a_button(page: Page, site: Process) -> None:
    page.goto(f"{site.address}/retention")
    with page.expect_download() as downloaded:
        page.get_by_role("button", name="Create a backup").click()
    assert downloaded.value.suggested_filename.endswith(".backup")
    assert downloaded.value.path().read_bytes().startswith(b"PK")


@pytest.mark.parametrize(
    ("path", "shows"),
    [
        ("/workers", "servoident-1"),
        ("/statistics?parameter=Z0&batch=B", "Sets2"),
        ("/limits?model=qian2014", "Z0"),
        ("/regressions", "Recheck"),
        ("/actuators/BESIDE", "verdict"),
    ],
)
def test_the_lines_pages_look_sound(page: Page, site: Process, old: str, screenshots, path: str, shows: str) -> None:
    """With two sets in force, their chart, a verdict, and who works."""
    assert old
    for fit in SETS:
        site.client.post(f"/fits/{fit}/approve", json={"why": "as it is"})
    page.goto(site.address + path)
    expect(page.get_by_role("main")).to_contain_text(re.compile(shows, re.I))
    name = re.sub(r"\W+", "-", path).strip("-")
    everywhere(page, screenshots, name)
    on_a_phone(page, screenshots, name)
    for fit in SETS:  # others look for theirs
        site.client.post(f"/fits/{fit}/withdraw")
