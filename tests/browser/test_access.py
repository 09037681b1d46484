"""Signing in and out, tokens and the audit, as people do it in a browser."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import BrowserContext, expect

from tests.browser.looks import everywhere
from tests.browser.window import Window


@pytest.fixture
def stranger(window: Window) -> Iterator[BrowserContext]:
    """Somebody else at the same browser, who has not signed in."""
    with window.stranger() as made:
        yield made


def test_the_admin_lets_somebody_in_and_out_again(page, site, stranger, screenshots):
    """A token is made on the page, shown once, signs a station in, which sees no more than it may, and is revoked."""
    page.goto(f"{site.address}/tokens")
    expect(page.get_by_role("heading", name="No tokens yet")).to_be_visible()
    page.get_by_label("Owner").fill("line 3, station 2")
    page.get_by_label("Role").select_option("line")
    page.get_by_role("button", name="Create the token").click()
    token = page.locator(".made code").inner_text()
    everywhere(page, screenshots, "token-made")
    page.get_by_role("link", name="Done").click()
    row = page.get_by_role("row", name=re.compile("line 3, station 2"))
    expect(row).to_contain_text("valid")
    assert token not in page.content()
    everywhere(page, screenshots, "tokens")

    theirs = stranger.new_page()
    theirs.goto(f"{site.address}/jobs")
    expect(theirs.get_by_role("heading", name="Sign in")).to_be_visible()
    everywhere(theirs, screenshots, "sign-in")
    theirs.get_by_label("Token").fill("wrong")
    theirs.get_by_role("button", name="Sign in").click()
    expect(theirs.get_by_role("alert")).to_contain_text("not valid")
    theirs.get_by_label("Token").fill(token)
    theirs.get_by_label("Token").press("Enter")
    expect(theirs.get_by_role("heading", name="Jobs", level=1)).to_be_visible()
    assert theirs.url == f"{site.address}/jobs"
    expect(theirs.get_by_role("navigation", name="Main")).not_to_contain_text("Admin")
    assert theirs.evaluate("document.cookie") == ""
    theirs.goto(f"{site.address}/tokens")
    expect(theirs.get_by_role("main")).to_contain_text("may not do this")
    everywhere(theirs, screenshots, "not-allowed")

    row.get_by_role("button", name="Revoke the token of line 3, station 2").click()
    row.get_by_role("button").click()
    expect(row).to_contain_text("revoked")
    theirs.goto(f"{site.address}/jobs")
    expect(theirs.get_by_role("heading", name="Sign in")).to_be_visible()


def test_the_audit_is_read_by_object(page, site, fitted, screenshots):
    """What was done to a fit, with who did it."""
    site.client.post(f"/fits/{fitted}/approve", json={"why": "as it is"})
    page.goto(f"{site.address}/audit")
    page.get_by_label("Object").fill(f"fits/{fitted}")
    page.get_by_role("button", name="Show").click()
    rows = page.locator("tbody tr")
    expect(rows).to_have_count(1)
    expect(rows).to_contain_text("approve fit")
    expect(rows).to_contain_text("start token")
    page.get_by_role("link", name="All changes").click()
    assert rows.count() > 1
    everywhere(page, screenshots, "audit")


def test_signing_out_ends_the_session(site, stranger):
    """Also where the cookie is kept."""
    theirs = stranger.new_page()
    theirs.goto(f"{site.address}/?token={site.token}")
    (cookie,) = stranger.cookies()
    assert (cookie["httpOnly"], cookie["sameSite"], site.token in cookie["value"]) == (True, "Strict", False)
    theirs.get_by_role("button", name="Sign out").click()
    expect(theirs.get_by_role("heading", name="Sign in")).to_be_visible()
    assert stranger.cookies() == []
    stranger.add_cookies([cookie])
    theirs.goto(site.address)
    expect(theirs.get_by_role("heading", name="Sign in")).to_be_visible()
