"""Streams in a browser while a test runs: drawn, marked, recorded, kept as a data set."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread

import numpy as np
from playwright.sync_api import Page, expect
from websockets.sync.client import connect

from tests.browser.looks import everywhere, on_a_phone
from tests.browser.story import LONG
from tests.reference import first_order_reference as reference
from tests.running import Service

RATE, BLOCK = 4096, 256


@contextmanager
def streaming(site: Service, name: str) -> Iterator[None]:
    """A loop that is followed at the pace of its clock, over and over, until the block ends."""
    drawn, stop = reference.trial(4, 1.0), Event()
    samples = np.column_stack([drawn.r, drawn.y]).astype("<f8")

    def send() -> None:
        address = site.address.replace("http", "ws") + "/api/v1/stream/ekf"
        with connect(address, additional_headers={"Authorization": f"Bearer {site.token}"}) as stream:
            first = {"sample_rate": RATE, "alarms": True, "rig": {"stroke": "80 mm"}, "name": name}
            stream.send(json.dumps(first))
            at = 0
            while not stop.wait(BLOCK / RATE):
                stream.send(samples[at : at + BLOCK].tobytes())
                while isinstance(stream.recv(), str):
                    pass
                at = (at + BLOCK) % (len(samples) - BLOCK)

    sender = Thread(target=send, daemon=True)
    sender.start()
    try:
        yield
    finally:
        stop.set()
        sender.join()


def inked(page: Page) -> bool:
    """Whether every canvas has something drawn on it."""
    return bool(
        page.evaluate(
            """() => [...document.querySelectorAll(".stream canvas")].every((one) =>
             one.width && one.getContext("2d").getImageData(0, 0, one.width, one.height).data.some((value) => value))"""
        )
    )


def test_a_stream_is_drawn_marked_recorded_and_kept(page: Page, site: Service) -> None:
    """By the buttons of the page; the alarm of the stroke stands in its list."""
    page.goto(f"{site.address}/live")
    expect(page.locator("#none")).to_be_visible()
    with streaming(site, "rig-live"):
        stream = page.locator("[data-name=rig-live]")
        expect(stream.locator("[data-value=tau]")).to_contain_text("ms", timeout=LONG)
        expect(stream.locator("[data-value=alarm]")).to_contain_text("stroke", timeout=LONG)
        assert inked(page)
        stream.locator("[data-live-record]").click()
        expect(stream.locator("[data-value=recording]")).to_contain_text("recording")
        stream.locator("[name=text]").fill("oil is warm")
        stream.get_by_role("button", name="Set a mark").click()
        expect(stream.locator("[data-said]")).to_contain_text("oil is warm")
        stream.get_by_role("button", name="End the recording").click()
        expect(stream.locator("[data-value=recording]")).to_contain_text("ended")
    expect(page.locator("[data-name=rig-live] [data-value=state]")).to_contain_text("ended after")
    everywhere(page, None, "live")
    on_a_phone(page, None, "live")
    page.locator("[data-live-keep] [name=serial]").fill("LIVE-2")
    page.locator("[data-live-keep] [name=run]").fill("first")
    page.get_by_role("button", name="Keep as a data set").click()
    expect(page.locator("h1")).to_contain_text("LIVE-2", timeout=LONG)
