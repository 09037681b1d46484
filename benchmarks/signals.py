"""Signals of large data sets before a fit: the first plot, what a step weighs, and how zooming by wheel runs."""

from __future__ import annotations

import io
import json
import math
import re
import sqlite3
import statistics
import tempfile
import time
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import numpy as np

from app.matrices.levels import KEY
from app.storage import Storage
from benchmarks.pages import TOKEN, served
from benchmarks.table import Table
from benchmarks.uploads import RATE, RUNS, arrays, upload
from ident.decimation.levels import write_levels
from ident.run import Run
from tests.running import CHROMIUM

SECONDS = 30.0
LONG = 4_000_000  # samples of each channel of the long run
NAMES = {
    "command": "mm",
    "displacement": "mm",
    "velocity": "mm/s",
    "force": "kN",
    "load_pressure": "bar",
    "pressure_a": "bar",
    "pressure_b": "bar",
    "supply_pressure": "bar",
}
SPIKED, SPIKE = "displacement", 1e5  # mm: of one sample, a third of the way along
HUGE = 61_000_000  # samples of each channel of a run of 3.9 GB, which an upload may not have
MEMORY = 300  # MB
FIRST, UNMADE, WEIGHT, FRAME, SHARP = 0.3, 1.0, 200_000, 33.0, 300.0  # s, s, bytes, ms, ms
DRAWN = """async ([samples, rate]) => {
  const { src } = document.querySelector("script[src*='signals.js']");
  const { preview } = await import(src.replace("signals.js", "preview.js"));
  const { view } = document.querySelector("#signals .figure"), times = [];
  for (let turn = 0; turn < 200; turn++) {
    const length = samples / rate / 1.25 ** (turn % 40), begun = performance.now();
    preview(view, samples / rate / 3, samples / rate / 3 + length);
    times.push(performance.now() - begun);
  }
  return times;
}"""
IDLE = """async (seconds) => {
  const frames = [], begun = performance.now();
  for (let last = begun; last - begun < 1000 * seconds; ) {
    const now = await new Promise(requestAnimationFrame);
    frames.push(now - last);
    last = now;
  }
  return frames.slice(1);
}"""
ZOOM = """async (seconds) => {
  const plot = document.querySelector("#signals .plot"), canvas = plot.querySelector("canvas").getBoundingClientRect();
  const frames = [], begun = performance.now();
  let last = begun, turn = 0;
  while (performance.now() - begun < 1000 * seconds) {
    const inward = Math.floor((performance.now() - begun) / 1000 / (seconds / 2)) === 0;
    if (turn++ % 4 === 0) plot.dispatchEvent(new WheelEvent("wheel", { deltaY: inward ? -100 : 100, bubbles: true,
      cancelable: true, clientX: canvas.left + 0.5 * canvas.width, clientY: canvas.top + 60 }));
    const now = await new Promise(requestAnimationFrame);
    frames.push(now - last);
    last = now;
  }
  const rest = performance.now(), figure = document.querySelector("#signals .figure");
  await new Promise((done) => figure.addEventListener("arrived", done, { once: true }));
  await new Promise(requestAnimationFrame);
  return [frames.slice(1), performance.now() - rest];
}"""


def long_run() -> bytes:
    """An archive of one run of eight channels: noise that wanders, and one sample that stands out."""
    random = np.random.default_rng(5)
    arrays_ = {name: np.cumsum(random.normal(size=LONG)).astype(np.float32) for name in NAMES}
    arrays_[SPIKED][LONG // 3] += SPIKE
    file, buffer = io.BytesIO(), io.BytesIO()
    np.savez(file, **arrays_)
    channels = {name: {"column": name, "unit": unit} for name, unit in NAMES.items()}
    run = {"id": "long", "file": "runs/long.npz", "sample_rate": "4096 Hz", "channels": channels}
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("matrix.yaml", json.dumps({"actuator": {"serial": "LONG-1"}, "runs": [run]}))
        archive.writestr("runs/long.npz", file.getvalue())
    return buffer.getvalue()


def _stored(client: httpx.Client, archive: bytes) -> str:
    """The id of a matrix that is uploaded."""
    answer = client.post("/api/v1/matrices", files={"files": ("matrix.zip", archive)}).raise_for_status()
    return str(answer.json()["id"])


def _plot(client: httpx.Client, matrix: str, **options: Any) -> tuple[float, int, bool]:
    """How long a plot takes, s, its bytes, and whether it has the sample that stands out."""
    begun = time.perf_counter()
    answer = client.get(f"/api/v1/matrices/{matrix}/figures/signals.json", params={"live": "1", **options})
    taken = time.perf_counter() - begun
    drawn = answer.raise_for_status().json()["datasets"]
    place = list(NAMES).index(SPIKED)
    values = [row["y"] for row in drawn.get(f"channel{place}", ())]
    return taken, len(answer.content), max(values, default=0.0) > 10 * statistics.median(map(abs, values or [1.0]))


def _memory(client: httpx.Client) -> float:
    """The memory that the services' processes hold, MB, by the kernel; what is mapped from files is not theirs."""
    port = re.search(r":(\d+)$", str(client.base_url))
    assert port is not None
    held = 0.0
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if port[1].encode() in (process / "cmdline").read_bytes():
                status = (process / "status").read_text()
                held += int(re.search(r"RssAnon:\s+(\d+)", status)[1]) / 1024  # type: ignore[index]
        except (OSError, TypeError):
            continue
    return held


def _without_levels(folder: Path, matrix: str) -> None:
    """Forget the levels of a matrix, as of one that an earlier version stored."""
    with sqlite3.connect(folder / "servoident.sqlite") as database:
        (text,) = database.execute("SELECT source FROM matrices WHERE id = ?", (matrix,)).fetchone()
        source = {key: value for key, value in json.loads(text).items() if key != "levels"}
        database.execute("UPDATE matrices SET source = ? WHERE id = ?", (json.dumps(source), matrix))


def _lengthened(folder: Path, matrix: str) -> None:
    """Exchange the levels of a matrix of one run for those of a run of HUGE samples."""
    random = np.random.default_rng(6)
    channels: dict[str, np.memmap[Any, Any]] = {}
    for name in NAMES:
        channels[name] = np.memmap(folder / f"{name}.raw", np.float64, "w+", shape=(HUGE,))
        np.cumsum(random.standard_normal(HUGE, dtype=np.float32), out=channels[name])
    channels[SPIKED][HUGE // 3] += SPIKE
    storage = Storage(folder / "blobs")
    with (folder / "levels").open("w+b") as file:
        write_levels([Run("long", "", RATE, channels, dict.fromkeys(NAMES, "m"))], file)
        file.seek(0)
        sha256 = storage.put(file)
    for name in ("levels", *(f"{channel}.raw" for channel in NAMES)):
        (folder / name).unlink()
    with sqlite3.connect(folder / "servoident.sqlite") as database:
        (source, summary) = map(
            json.loads, database.execute("SELECT source, summary FROM matrices WHERE id = ?", (matrix,)).fetchone()
        )
        source[KEY] = sha256
        summary["runs"][0] |= {"samples": HUGE, "duration": HUGE / RATE}
        database.execute(
            "UPDATE matrices SET source = ?, summary = ? WHERE id = ?",
            (json.dumps(source), json.dumps(summary), matrix),
        )


@dataclass(frozen=True)
class Zoomed:
    """What a browser measured (ms): 95 % of the frames of the page at rest and while the wheel turns for 10 s.

    `drawing` is the median time that the script takes for a frame, `sharp` how long after rest the points are there.
    """

    idle: float
    frame: float
    drawing: float
    sharp: float


def _zoomed(client: httpx.Client, matrix: str) -> Zoomed:
    """Zoom by wheel at 1280 px in headless Chromium."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415  no other benchmark needs a browser

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        page = browser.new_context(viewport={"width": 1280, "height": 900}).new_page()
        page.goto(f"{client.base_url}/?token={TOKEN}")
        page.goto(f"{client.base_url}/matrices/{matrix}/signals?run=long")
        for figure in ("signals", "spectra"):
            page.wait_for_selector(f"#figure-{figure} canvas", timeout=120_000)
        idle = page.evaluate(IDLE, 5)
        frames, sharp = page.evaluate(ZOOM, 10)
        drawing = page.evaluate(DRAWN, [LONG, RATE])
        browser.close()
    at_rest, turning = (float(np.quantile(each, 0.95)) for each in (idle, frames))
    return Zoomed(at_rest, turning, float(np.median(drawing)), float(sharp))


def _read_once(archive: bytes) -> float:
    """How long numpy takes to read every run of an archive once, s."""
    begun = time.perf_counter()
    with zipfile.ZipFile(io.BytesIO(archive)) as files:
        for name in files.namelist():
            if name.endswith(".npz"):
                with np.load(io.BytesIO(files.read(name))) as run:
                    for channel in run:
                        run[channel].sum()
    return time.perf_counter() - begun


def _steps(client: httpx.Client, matrix: str, samples: int) -> list[tuple[float, int, bool]]:
    """Zooms to the sample that stands out, from the whole record to about 100 samples, each half as long."""
    place, whole = samples / 3 / RATE, samples / RATE
    return [
        _plot(client, matrix, start=place * (1 - 0.5**k), seconds=whole * 0.5**k)
        for k in range(round(math.log2(samples / 100)) + 1)
    ]


def measure() -> Table:
    """The first plot with levels and without, zooms, weight, frames and memory, on loopback."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "data"
        many = upload(SECONDS, "npz", "MANY-1")
        with served(folder) as client:
            _plot(client, _stored(client, upload(0.5, "npz", "SMALL-1")))  # what draws is imported
            matrix = _stored(client, many)
            once = statistics.median(_read_once(many) for _ in range(3))
            first = [_plot(client, matrix, run=f"r{number}") for number in range(5)]
            _without_levels(folder, matrix)
            unmade, *_ = _plot(client, matrix, run="r9")
            long = _stored(client, long_run())
            steps = _steps(client, long, LONG)
            wheel = _zoomed(client, long)
        _lengthened(folder, long)
        with served(folder) as client:
            _plot(client, matrix, run="r0")
            before = _memory(client)
            huge = _steps(client, long, HUGE)
            held = _memory(client)
    plotted, weight = (
        statistics.median(taken for taken, *_ in first),
        max(size for _, size, _ in (*first, *steps, *huge)),
    )
    seen = sum(spike for *_, spike in (*steps, *huge))
    slow, slower = (max(taken for taken, *_ in each) for each in (steps, huge))
    rows = [
        (f"read all {RUNS} runs once with numpy ({arrays(SECONDS) / 1e6:.0f} MB of samples)", f"{once:.2f} s"),
        ("first plot of any run, with levels", f"{plotted:.3f} s, {plotted / once:.2f} of it"),
        ("first plot with no levels stored, which makes them", f"{unmade:.2f} s, {unmade / once:.2f} of it"),
        (f"a zoom of 8 channels of {LONG / 1e6:.0f} million samples, the slowest", f"{slow:.3f} s"),
        (f"of {HUGE / 1e6:.0f} million samples (3.9 GB)", f"{slower:.3f} s, {slower / slow:.1f} times"),
        ("memory of the service after these, and before", f"{held:.0f} MB, {before:.0f} MB"),
        ("a step, the largest", f"{weight / 1000:.0f} kB"),
        ("steps that show the sample that stands out", f"{seen} of {len(steps) + len(huge)}"),
        ("frames of the page at rest, 95 % within", f"{wheel.idle:.0f} ms"),
        (
            "10 s of zoom by wheel in and out, 95 % of frames within",
            f"{wheel.frame:.0f} ms, {wheel.frame / wheel.idle:.1f} times",
        ),
        ("of which the script draws for (median)", f"{wheel.drawing:.1f} ms"),
        ("sharp again after rest", f"{wheel.sharp:.0f} ms"),
    ]
    soon = plotted <= FIRST and unmade <= UNMADE and wheel.frame <= FRAME and wheel.sharp <= SHARP
    return Table(
        "Signals",
        f"{RUNS} runs of {SECONDS:g} s of two channels, and a run of {len(NAMES)} channels, on loopback; "
        "the wheel at 1280 px in headless Chromium. Steps halve a stretch from the whole record to 100 samples.",
        ("what", "measured"),
        rows,
        f"first plot in {FIRST:g} s with levels and {UNMADE:g} s without, {WEIGHT / 1000:g} kB a step, {MEMORY} MB, "
        f"95 % of frames within {FRAME:g} ms, sharp in {SHARP:g} ms, one sample seen in every step",
        soon and weight <= WEIGHT and held <= MEMORY and seen == len(steps) + len(huge),
    )
