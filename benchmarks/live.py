"""Four streams on the live page in a browser: the time from one frame to the next, and of drawing one."""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event, Thread

import httpx
import numpy as np
from numpy.typing import NDArray

from benchmarks.pages import TOKEN, served
from benchmarks.table import Table
from tests.running import CHROMIUM

STREAMS, RATE, BLOCK, SECONDS = 4, 4096, 128, 60
GOAL, SHARE = 50.0, 0.95  # ms of a frame, and the share of frames that are no longer
FRAMES = """(seconds) => new Promise((done) => {
  const found = [];
  let last;
  const begun = performance.now();
  const frame = (now) => {
    if (last !== undefined) found.push(now - last);
    last = now;
    now - begun < 1000 * seconds ? requestAnimationFrame(frame) : done(found);
  };
  requestAnimationFrame(frame);
})"""


def _samples(seed: int) -> NDArray[np.float64]:
    """A loop of first order with τ of 15 ms that follows a sine of 1 Hz, ten seconds of it, with noise."""
    t = np.arange(10 * RATE) / RATE
    turn = 1 / (1 + 2j * np.pi * 0.015)
    y = 0.05 * np.imag(turn * np.exp(2j * np.pi * t))
    noise = 1.2e-4 * np.random.default_rng(seed).standard_normal(len(t))
    return np.column_stack([0.05 * np.sin(2 * np.pi * t), y + noise])


@contextmanager
def _streaming(client: httpx.Client) -> Iterator[None]:
    """Streams at the pace of their clocks, until the block ends."""
    from websockets.sync.client import connect  # noqa: PLC0415  no other benchmark needs it

    stop = Event()
    address = f"{client.base_url}/api/v1/stream/ekf".replace("http", "ws", 1)

    def send(number: int) -> None:
        samples = _samples(number).astype("<f8")
        with connect(address, additional_headers={"Authorization": f"Bearer {TOKEN}"}) as stream:
            stream.send(json.dumps({"sample_rate": RATE, "alarms": True, "name": f"rig-{number}"}))
            begun, sent = time.monotonic(), 0
            while not stop.wait(max(0.0, begun + sent / RATE - time.monotonic())):
                at = sent % len(samples)
                stream.send(samples[at : at + BLOCK].tobytes())
                while isinstance(stream.recv(), str):
                    pass
                sent += BLOCK

    senders = [Thread(target=send, args=(number,), daemon=True) for number in range(STREAMS)]
    for sender in senders:
        sender.start()
    try:
        yield
    finally:
        stop.set()
        for sender in senders:
            sender.join()


def _seen(client: httpx.Client, seconds: float) -> NDArray[np.float64]:
    """The times from frame to frame, ms, while all streams are drawn."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415  few benchmarks need a browser

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        page = browser.new_context(viewport={"width": 1280, "height": 900}).new_page()
        page.set_default_timeout(120_000)
        page.goto(f"{client.base_url}/?token={TOKEN}")
        page.goto(f"{client.base_url}/live")
        page.locator(".stream").nth(STREAMS - 1).wait_for()
        page.wait_for_timeout(10_000)  # until ten seconds are drawn
        found = page.evaluate(FRAMES, seconds)
        browser.close()
    return np.array(found)


def measure(seconds: float = SECONDS) -> Table:
    """The frames of the live page with four streams, in Chromium on loopback."""
    with tempfile.TemporaryDirectory() as name, served(Path(name) / "data") as client, _streaming(client):
        frames = _seen(client, seconds)
    within = float(np.mean(frames <= GOAL))
    rows = [
        ("frames a second", f"{1000 / frames.mean():.0f}"),
        ("from frame to frame, median", f"{np.median(frames):.0f} ms"),
        ("95 % of frames", f"{np.percentile(frames, 95):.0f} ms"),
        ("the longest", f"{frames.max():.0f} ms"),
        (f"frames of at most {GOAL:g} ms", f"{100 * within:.1f} %"),
    ]
    return Table(
        "Live page",
        f"{STREAMS} streams of {RATE:,} samples a second, {seconds:g} s at 1280 px in headless Chromium, on loopback.",
        ("what", "measured"),
        rows,
        f"{100 * SHARE:g} % of frames within {GOAL:g} ms",
        within >= SHARE,
    )
