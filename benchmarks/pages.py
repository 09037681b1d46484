"""The page of a stored fit of 84 runs in a browser: how soon it stands, what it weighs, how soon a band is drawn."""

from __future__ import annotations

import os
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx

from benchmarks.table import Table
from tests.running import CHROMIUM

FIRST, WEIGHT, REDRAW = 1.0, 200_000, 0.1  # s, bytes without Vega, s
VIEWS, BANDS, SECONDS = 5, 9, 2.0
TOKEN = "a-token-for-benchmarks"
SERVE = """
import sys
from pathlib import Path
from app.main import run
from app.settings import Settings
run(Settings(data=Path(sys.argv[1]), port=int(sys.argv[2]), token=sys.argv[3]))
"""
WEIGHED = """[...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource")]
  .filter(({ name }) => !name.includes("/vega-") && !name.includes("/api/"))
  .reduce((sum, { decodedBodySize }) => sum + decodedBodySize, 0)"""
BAND = """([low, high]) => new Promise((drawn) => {
  const began = performance.now();
  const form = document.querySelector("#pick");
  [form.elements.low.value, form.elements.high.value] = [low, high];
  form.dispatchEvent(new Event("change", { bubbles: true }));
  const look = () => {
    const figure = document.querySelector("[role=tabpanel]:not([hidden])");
    const wanted = `low=${low}&high=${high}`;
    const done = figure.dataset.drawn?.includes(wanted) && figure.querySelector(".plot").ariaBusy === "false";
    done ? requestAnimationFrame(() => drawn((performance.now() - began) / 1000)) : setTimeout(look, 2);
  };
  look();
})"""


@contextmanager
def served(folder: Path) -> Iterator[httpx.Client]:
    """A service on a folder of its own, and its client."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-c", SERVE, str(folder), str(port), TOKEN]
    service = subprocess.Popen(command, start_new_session=True)
    address = f"http://127.0.0.1:{port}"
    headers = {"Authorization": f"Bearer {TOKEN}"}
    try:
        with httpx.Client(base_url=address, headers=headers, timeout=600) as client:
            _wait(lambda: client.get("/api/v1/ready").status_code == 200)
            yield client
    finally:
        os.killpg(service.pid, signal.SIGKILL)
        service.wait()


def _wait(ready: Any) -> None:
    deadline = time.monotonic() + 600
    while time.monotonic() < deadline:
        try:
            if ready():
                return
        except httpx.TransportError:
            pass
        time.sleep(0.1)
    raise TimeoutError("the service did not come that far")


def stored(client: httpx.Client, folder: Path) -> str:
    """A fit of the simulated matrix."""
    matrix = folder / "matrix"
    simulate = [sys.executable, "-m", "app.cli", "simulate", str(matrix), "--seconds", f"{SECONDS:g}", "--seed", "1"]
    subprocess.run([*simulate, "--effect", "dead_zone"], check=True, capture_output=True)
    files = [path for path in matrix.rglob("*") if path.is_file()]
    parts = [("files", (str(path.relative_to(matrix)), path.read_bytes())) for path in files]
    made = client.post("/api/v1/matrices", files=parts).raise_for_status().json()["id"]
    job = str(client.post("/api/v1/fits", json={"matrix": made, "seed": 1}).raise_for_status().json()["id"])
    _wait(lambda: client.get(f"/api/v1/jobs/{job}").json()["state"] == "succeeded")
    return job


def _seen(client: httpx.Client, fit: str) -> tuple[list[float], float, float, dict[str, float]]:
    """Times (s) until the page stands and until its figures do, its bytes without Vega, median redraw by figure."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415  no other benchmark needs a browser

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        views: list[float] = []
        for _ in range(VIEWS):
            page = browser.new_context(viewport={"width": 1280, "height": 900}).new_page()
            page.goto(f"{client.base_url}/?token={TOKEN}")
            begun = time.perf_counter()
            page.goto(f"{client.base_url}/fits/{fit}")
            views.append(time.perf_counter() - begun)
            page.wait_for_selector("#figure-bode canvas", timeout=120_000)
            drawn = time.perf_counter() - begun
        weight = float(page.evaluate(WEIGHED))
        redraws = {}
        for name in ("bode", "time", "residual-curve"):
            page.click(f"#tab-{name}")
            page.select_option("#pick-run", index=40)
            page.wait_for_selector(f"#figure-{name} canvas", timeout=120_000)
            page.evaluate(BAND, [1, 90])
            redraws[name] = statistics.median(page.evaluate(BAND, [2 + k, 20 + k]) for k in range(BANDS))
        browser.close()
    return views, drawn, weight, redraws


def measure() -> Table:
    """First view, weight and redraw of one stored fit, in Chromium on loopback."""
    with tempfile.TemporaryDirectory() as name, served(Path(name) / "data") as client:
        fit = stored(client, Path(name))
        views, drawn, weight, redraws = _seen(client, fit)
    begun = statistics.median(views)
    rows = [
        ("page loaded, nothing in the browser's cache", f"{begun:.2f} s"),
        ("map and Bode plot drawn, from the same click", f"{drawn:.2f} s"),
        ("page, styles and scripts, without Vega and data of figures", f"{weight / 1000:.0f} kB"),
        *((f"a band is set until {figure} is redrawn", f"{1000 * taken:.0f} ms") for figure, taken in redraws.items()),
    ]
    return Table(
        "Pages",
        f"The page of a stored fit of 84 runs of {SECONDS:g} s at 1280 px in headless Chromium, on loopback.",
        ("what", "measured"),
        rows,
        f"loaded in {FIRST:g} s, {WEIGHT / 1000:g} kB, each figure redrawn in {1000 * REDRAW:g} ms",
        begun <= FIRST and weight <= WEIGHT and max(redraws.values()) <= REDRAW,
    )
