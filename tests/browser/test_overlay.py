"""Fits that are ticked in a list are drawn over each other: Bode plot, time record, step response and residual."""

from __future__ import annotations

import json

import pytest
from playwright.sync_api import expect

from tests.browser.looks import everywhere, on_a_phone
from tests.browser.story import LONG


@pytest.mark.full
def test_three_fits_are_ticked_and_drawn_over_each_other(page, site, matrix, fitted, screenshots):
    quick = {"options": {"population": 20, "generations": 2}}
    others = [site.fit(matrix, **quick, **chosen) for chosen in ({"set": {"tau": "3 ms"}}, {"effects": ["dead_zone"]})]
    assert {site.ended(job)["state"] for job in others} == {"succeeded"}
    page.goto(f"{site.address}/matrices/{matrix}")
    button = page.get_by_role("button", name="Compare the ticked fits")
    expect(button).to_be_disabled()
    for fit in (fitted, *others):
        page.get_by_label(f"Compare fit {fit[:12]}").check()
    expect(page.locator("[data-ticked]")).to_have_text("3 fits are ticked.")
    everywhere(page, screenshots, "ticked")
    button.click()
    expect(page.locator("h1")).to_have_text("3 fits side by side")
    page.get_by_role("button", name="k", exact=False).and_(page.locator("[data-pick]")).first.click()
    for name in ("bode", "time", "step", "residual-spectrum"):
        page.locator(f"#tab-{name}").click()
        figure = page.locator(f"#figure-{name}")
        expect(figure.locator("canvas")).to_be_visible(timeout=LONG)
        expect(figure.locator(".plot")).to_have_attribute("aria-busy", "false", timeout=LONG)
        link = figure.get_by_role("link", name="JSON").get_attribute("href")
        drawn = json.loads(page.request.get(f"{site.address}{link}").body())
        told = json.dumps(drawn, ensure_ascii=False)
        assert all(f'"{letter}: qian2014' in told for letter in "ABC"), name
        assert f"run {page.locator('#pick-run').input_value()}" in told
        if screenshots:
            page.screenshot(path=screenshots / f"overlay-{name}.png", full_page=True)
    expect(page.locator("table", has_text="Click a run").locator("tbody tr").first).to_contain_text("points")
    runs = page.locator("section", has=page.get_by_role("heading", name="Runs", exact=True))
    with page.expect_download() as saved:
        runs.get_by_role("button", name="Download the table as a CSV file").click()
    lines = saved.value.path().read_text(encoding="utf-8-sig").splitlines()
    assert saved.value.suggested_filename == "runs.csv"
    assert lines[0].startswith('"Run","Use","A","B","C"')
    assert len(lines) == 1 + runs.locator("tbody tr").count()
    with page.expect_download() as saved:
        runs.get_by_role("button", name="Download the table as a JSON file").click()
    objects = json.loads(saved.value.path().read_text(encoding="utf-8"))
    assert (saved.value.suggested_filename, len(objects) + 1) == ("runs.json", len(lines))
    assert list(objects[0])[:5] == ["Run", "Use", "A", "B", "C"]
    page.locator("#tab-bode").click()
    everywhere(page, screenshots, "overlay")
    on_a_phone(page, screenshots, "overlay")
