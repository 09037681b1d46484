"""The production line in a browser: approve, set a limit, read the statistics, recheck, withdraw."""

from __future__ import annotations

from playwright.sync_api import Page, expect

from tests.running import Service


def test_a_set_is_approved_judged_rechecked_and_withdrawn(page: Page, site: Service, fitted: str) -> None:
    """Every step by the buttons of the pages."""
    page.goto(f"{site.address}/fits/{fitted}")
    if page.locator("[data-approve$='/withdraw']").count() == 0:
        page.fill("#why", "sound")
        page.click("[data-approve$='/approve'] button")
    expect(page.locator("[data-approve$='/withdraw']")).to_be_visible()
    page.goto(f"{site.address}/limits?model=qian2014")
    row = page.locator("tr[data-name=tau]")
    row.locator("[name=upper]").fill("9")
    row.locator("[name=unit]").fill("ms")
    page.click("form[data-limits] button")
    expect(row.locator("td").last).to_contain_text("start token")
    serial = site.client.get(f"/fits/{fitted}").json()["serial"]
    page.goto(f"{site.address}/statistics?parameter=tau")
    expect(page.locator("main dl.facts")).to_contain_text("of model qian2014")
    page.goto(f"{site.address}/regressions")
    page.fill("#serial", serial)
    page.click("form[data-regression] button")
    expect(page.locator("h1")).to_contain_text("Regression ")
    expect(page.locator("p[role=status]")).to_contain_text("1 same", timeout=120_000)
    page.goto(f"{site.address}/fits/{fitted}")
    page.fill("#why", "leaks")
    page.click("[data-approve$='/withdraw'] button")
    expect(page.locator("[data-approve$='/approve']")).to_be_visible()
    found = site.client.get(f"/actuators/{serial.replace('/', '%2F')}/verdict")
    assert found.json()["reasons"] == ["no parameter set is approved: approve a fit"]
