"""What the service around the papers does: a service in this process, with records of the independent references."""

from __future__ import annotations

import atexit
import io
import json
import logging
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from contextlib import ExitStack
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import scipy.io
import yaml
from fastapi.testclient import TestClient

from app.main import create_app
from app.settings import Settings
from tests.app.conftest import archived, packed, zipped
from tests.app.test_stream import START, connected
from tests.papers.row import Measured, Row, counted
from tests.reference import first_order_reference as lag
from tests.reference import kononykhin_reference as bench
from tests.reference import nonlinear_reference as hidden
from tests.reference import outside_reference as outside
from tests.reference import qian_reference as qian
from tests.running import TOKEN

API = "/api/v1"
NOISE = 0.005


@cache
def service() -> TestClient:
    """A client of a service with a folder of its own, until the process ends."""
    logging.disable(logging.INFO)
    stack = ExitStack()
    atexit.register(stack.close)
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
    app = create_app(Settings(data=folder, token=TOKEN))
    headers = {"Authorization": f"Bearer {TOKEN}"}
    return stack.enter_context(TestClient(app, "http://127.0.0.1:8000", raise_server_exceptions=False, headers=headers))


def uploaded(archive: bytes) -> Any:
    """The answer to an upload."""
    return service().post(f"{API}/matrices", files={"files": ("matrix.zip", archive)})


def ended(answer: Any) -> dict[str, Any]:
    """The job of a 202, when it has ended."""
    place = answer.headers["Location"]
    service().get(f"{place}/events")
    job: dict[str, Any] = service().get(place).json()
    return job


@cache
def fitted(serial: str = "SW-1") -> str:
    """A finished fit of an actuator's nine runs."""
    matrix = uploaded(zipped(serial)).json()["id"]
    return str(ended(service().post(f"{API}/fits", json={"matrix": matrix}))["id"])


def upload() -> tuple[Measured, ...]:
    first, again = uploaded(zipped()), uploaded(zipped())
    bad = uploaded(b"no archive")
    stranger = service().get(f"{API}/matrices", headers={"Authorization": "Bearer nobody"})
    told = [
        first.status_code in (200, 201),
        again.status_code == 200,
        first.json()["id"] == again.json()["id"],
        bad.status_code == 422,
        stranger.status_code == 401,
    ]
    return (counted("answers as the contract has them", sum(told), 5),)


def queued() -> tuple[Measured, ...]:
    matrix = uploaded(zipped()).json()["id"]
    answer = service().post(f"{API}/fits", json={"matrix": matrix, "seed": 2})
    text = service().get(f"{answer.headers['Location']}/events").text
    result = service().get(f"{API}/fits/{answer.json()['id']}").json()["result"]
    off = abs(result["parameters"]["Z0"]["value"] / qian.Plant().Z0 - 1)
    return (
        counted("accepted, and succeeded", (answer.status_code == 202) + ('"succeeded"' in text), 2),
        Measured("events of progress", text.count("id: "), "", None, 4),
        Measured("Z0 found off by", 100 * off, "%", 1.0),
    )


def by_serial() -> tuple[Measured, ...]:
    fit = fitted()
    service().post(f"{API}/fits/{fit}/approve", json={"why": "a row"})
    found = service().get(f"{API}/parameter-sets", params={"serial": "SW-1", "Z0.min": "2.5e-6", "Z0.max": "2.7e-6"})
    none = service().get(f"{API}/parameter-sets", params={"serial": "SW-1", "Z0.min": "2.7e-6"})
    text = service().get(f"{API}/parameter-sets", params={"format": "csv"}).text
    told = [fit in [one["id"] for one in found.json()["items"]], not none.json()["items"], fit in text]
    return (counted("queries answered right", sum(told), 3),)


def figures() -> tuple[Measured, ...]:
    starts = {"json": b"{", "svg": b"<svg", "png": b"\x89PNG", "pdf": b"%PDF"}
    got = [service().get(f"{API}/fits/{fitted()}/figures/bode.{kind}").content for kind in starts]
    right = sum(content.startswith(start) for content, start in zip(got, starts.values(), strict=True))
    return (counted("formats of a Bode plot", right, 4),)


def approval() -> tuple[Measured, ...]:
    fit = fitted()
    given = service().post(f"{API}/fits/{fit}/approve", json={"why": "a row"}).json()["current"]
    taken = service().post(f"{API}/fits/{fit}/withdraw", json={"why": "leaks"}).json()["current"]
    lines = [line for line in service().get(f"{API}/audit").json()["items"] if fit in json.dumps(line)]
    service().post(f"{API}/fits/{fit}/approve", json={"why": "again"})
    return (
        counted("approved, then not", int(given is True) + int(taken is False), 2),
        Measured("lines in the audit", len(lines), "", None, 2),
    )


def regression() -> tuple[Measured, ...]:
    service().post(f"{API}/fits/{fitted()}/approve", json={"why": "a row"})
    started = service().post(f"{API}/regressions", json={})
    for recheck in started.json()["rechecks"]:
        service().get(f"{API}/jobs/{recheck['job']}/events")
    found = service().get(started.headers["Location"]).json()
    suite = ElementTree.fromstring(
        service().get(f"{API}/regressions/{found['id']}", params={"format": "junit"}).content
    )
    count = len(started.json()["rechecks"])
    return (
        counted(
            "actuators found again as they were", int(suite.get("tests") or 0) - int(suite.get("failures") or 0), count
        ),
        Measured("rechecked", count, "", None, 1),
    )


def verdicts() -> tuple[Measured, ...]:
    service().post(f"{API}/fits/{fitted()}/approve", json={"why": "a row"})
    value, told = qian.Plant().Z0, []
    for factor, wanted in ((1.1, "pass"), (0.9, "fail")):
        limits = {"limits": {"Z0": {"upper": factor * value, "unit": "m^4/s"}}}
        service().put(f"{API}/limits/qian2014", json=limits)
        told.append(service().get(f"{API}/actuators/SW-1/verdict").json()["verdict"] == wanted)
    service().put(f"{API}/limits/qian2014", json={"limits": {}})
    told.append(service().get(f"{API}/actuators/nobody/verdict").status_code == 404)
    return (counted("verdicts: pass, fail, unknown serial", sum(told), 3),)


@cache
def story(serial: str, *effects: tuple[str, float]) -> dict[str, Any]:
    """Upload, fit, diagnose, add what is named, over HTTP: what was named, and errors over the noise floor."""
    truth = hidden.named(dict(effects))
    records = hidden.measure_all(truth, qian.trials()[::8], seconds=1.0, noise=NOISE, seed=750)
    matrix = uploaded(archived(packed(records, serial))).json()["id"]
    fit = ended(service().post(f"{API}/fits", json={"matrix": matrix}))["fit"]
    job = ended(service().post(f"{API}/diagnoses", json={"fit": fit, "propose": False}))
    found = service().get(f"{API}/diagnoses/{job['diagnosis']}").json()
    named, last = list(found["verdict"]["effects"]), fit
    if named:
        body = {"effect": named[0]} if len(named) == 1 else {"effects": named}
        last = ended(service().post(f"{API}/fits/{fit}/effects", json=body))["fit"]
    results = [service().get(f"{API}/fits/{one}").json()["result"] for one in (fit, last)]
    return {
        "named": set(named),
        "before": results[0]["error"]["fit"],
        "after": results[1]["error"]["fit"],
        "parameters": results[1]["parameters"],
    }


def of_story(found: Mapping[str, Any], effects: Mapping[str, float]) -> tuple[Measured, ...]:
    """The figures of a story: names, errors, strengths."""
    off = []
    for name, value in effects.items():
        effect, _, _ = name.partition(".")
        got = [one["value"] for key, one in found["parameters"].items() if key.startswith(f"{effect}.")]
        off.append(min((abs(abs(one) / value - 1) for one in got), default=np.nan))
    wanted = {name.partition(".")[0] for name in effects}
    return (
        counted(
            "effects named, and no other", len(found["named"] & wanted) - len(found["named"] - wanted), len(wanted)
        ),
        Measured("error before", 100 * found["before"], "%", None, 1.0),
        Measured("error with what was named", 100 * found["after"], "%", 0.55),
        Measured("strength, furthest", 100 * float(max(off)), "%", 5.0),
    )


TWO = {"dead_zone.h": 1.2e-4, "coulomb_friction.Fc": 40.0}
ONE = {"pressure_flow.r": 1.25e-7}


def two_hidden() -> tuple[Measured, ...]:
    return of_story(story("ROW-1", *TWO.items()), TWO)


def one_hidden() -> tuple[Measured, ...]:
    return of_story(story("ROW-2", *ONE.items()), ONE)


def in_the_browser() -> tuple[Measured, ...]:
    """The same by buttons: the story of the suite, in a process of its own."""
    command = [sys.executable, "-m", "pytest", "-x", "tests/browser/test_workbench.py", "-p", "no:cacheprovider"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=Path(__file__).parents[2])
    last = done.stdout.strip().splitlines()[-1]
    passed = int(last.split(" passed")[0].split()[-1]) if " passed" in last else 0
    return (
        Measured("stories by button that end as they should", passed, "", None, 1),
        Measured("that do not", int(done.returncode != 0), "", 0),
    )


def outside_the_catalogue() -> tuple[Measured, ...]:
    """A drift of the gain in time, which no list holds."""
    plant, trials = qian.Plant(), [trial for trial in qian.trials() if trial.use == "fit"][::6]
    records = outside.measure_all(
        outside.Outside(gain_drift=0.3), [*trials, *qian.trials()[-3:]], plant, seconds=0.5, noise=NOISE, seed=2
    )
    matrix = uploaded(archived(packed(records, "ROW-3"))).json()["id"]
    fit = ended(service().post(f"{API}/fits", json={"matrix": matrix}))["fit"]
    job = ended(service().post(f"{API}/diagnoses", json={"fit": fit, "max_effects": 0, "propose": True}))
    found = service().get(f"{API}/diagnoses/{job['diagnosis']}").json()
    terms = [term["equation"] for term in found["proposals"]]
    return (
        counted("the term w·t is proposed", int(any("t * w" in term or "w * t" in term for term in terms)), 1),
        Measured("error with it", 100 * float(found["proposals"][0]["error"]["fit"]), "%", 0.52),
        counted("called unexplained until it is kept", int(found["verdict"]["unexplained"]), 1),
    )


def exports() -> tuple[Measured, ...]:
    asked = {"mass": "0.87 kg", "gain": "7", "sample_rate": "4096 Hz"}
    header, mat, fmu = (
        service().get(f"{API}/fits/{fitted()}/export.{kind}", params=asked) for kind in ("h", "mat", "fmu")
    )
    held = scipy.io.loadmat(io.BytesIO(mat.content))
    right = [
        "servoident_step" in header.text,
        held["A"].shape[0] >= 4,
        "modelDescription.xml" in zipfile.ZipFile(io.BytesIO(fmu.content)).namelist(),
    ]
    poles = np.linalg.eigvals(held["A"])
    of = service().get(f"{API}/fits/{fitted()}").json()["result"]["parameters"]
    p = {name: one["value"] for name, one in of.items()}
    inner = np.polymul([p["Ka"], p["Cl"]], [p["m0"] + 0.87, p["c0"], 0.0])
    closed = np.polyadd(np.polymul([p["tau"], 1.0], np.polyadd(inner, [qian.Plant().A ** 2, 0.0])), [p["Z0"] * 7.0])
    off = max(float(np.abs(poles - root).min() / abs(root)) for root in np.roots(closed))
    return (
        counted("formats: C, MAT, FMU", sum(right), 3),
        Measured("poles of the MAT file from eq. (10)", off, "", 1e-6),
    )


def reports() -> tuple[Measured, ...]:
    page, paper = (service().get(f"{API}/fits/{fitted()}/report.{kind}") for kind in ("html", "pdf"))
    return (counted("page and PDF", page.text.startswith("<!doctype html>") + paper.content.startswith(b"%PDF-"), 2),)


def side_by_side() -> tuple[Measured, ...]:
    pair = fitted(), fitted("SW-2")
    text = service().get(f"{API}/fits/{pair[0]}/beside", params={"other": pair[1]}).text
    chart = service().get(f"{API}/fits/{pair[0]}/figures/side-by-side.json", params={"other": pair[1]}).text
    told = [serial in shown for shown in (text, chart) for serial in ("SW-1", "SW-2")]
    return (counted("serial numbers in table and figure", sum(told), 4),)


def live() -> tuple[Measured, ...]:
    drawn = lag.trial(4, 1.0)
    with connected(service(), {**START, "name": "row"}) as socket:
        socket.send_json({"r": drawn.r.tolist(), "y": drawn.y.tolist()})
        socket.receive_json()
    text = service().get(f"{API}/live/row/events", headers={"Last-Event-ID": "0"}).text
    bins = json.loads(text.split("data: ")[1].splitlines()[0])["bins"]
    parts = drawn.y[: 64 * (len(drawn.y) // 64)].reshape(-1, 64)
    same = bins["y_low"] == parts.min(axis=1).tolist() and bins["y_high"] == parts.max(axis=1).tolist()
    page = service().get("/live").text
    return (
        counted("bins are the extremes of what was sent, by NumPy", int(same), 1),
        counted("page", int("<h1>Live</h1>" in page), 1),
    )


@cache
def bench_fit() -> str:
    """A set of a bench, uploaded and fitted by the procedures."""
    truth = bench.scattered(4)
    files, runs = {}, []
    for record in bench.full_set(truth, 4, short=True):
        buffer = io.BytesIO()
        np.savez(buffer, i=record.current, x=record.position, a=record.pressure_a, b=record.pressure_b)
        files[f"{record.id}.npz"] = buffer.getvalue()
        channel = {
            "current": ("i", "%"),
            "displacement": ("x", "mm"),
            "pressure_a": ("a", "MPa"),
            "pressure_b": ("b", "MPa"),
        }
        runs.append({
            "id": record.id, "file": f"{record.id}.npz", "sample_rate": "1000 Hz", "kind": record.kind,
            "rated_current": "100 %", "channels": {n: {"column": c, "unit": u} for n, (c, u) in channel.items()},
            **({"frequency": f"{record.frequency} Hz"} if record.frequency else {}),
            **({"position_range": [f"{end} mm" for end in record.position_range]} if record.kind == "static" else {}),
        })  # fmt: skip
    actuator = {"serial": "ROW-K", "supply_pressure": "21 MPa", "stroke": "100 mm"}
    files["matrix.yaml"] = yaml.safe_dump({"actuator": actuator, "runs": runs}).encode()
    matrix = uploaded(archived(files)).json()["id"]
    body = {"matrix": matrix, "model": "kononykhin", "method": "gradient"}
    return str(ended(service().post(f"{API}/fits", json=body))["fit"])


def limits_of_a_line() -> tuple[Measured, ...]:
    truth = bench.scattered(4).dead_space / 100
    service().post(f"{API}/fits/{bench_fit()}/approve", json={"why": "a row"})
    told = []
    for factor, wanted in ((1.1, "pass"), (0.9, "fail")):
        limits = {"sheet.dead_space": {"upper": 100 * factor * truth, "unit": "%"}}
        put = service().put(f"{API}/limits/kononykhin", json={"limits": limits})
        told += [put.status_code == 200, service().get(f"{API}/actuators/ROW-K/verdict").json()["verdict"] == wanted]
    wrong = service().put(f"{API}/limits/kononykhin", json={"limits": {"sheet.dead_spice": {"upper": 1, "unit": "%"}}})
    service().put(f"{API}/limits/kononykhin", json={"limits": {}})
    return (counted("limits taken, judged, misspelt one refused", sum(told) + (wrong.status_code == 422), 5),)


def sheet_over_http() -> tuple[Measured, ...]:
    truth = bench.scattered(4)
    lines = {line["name"]: line for line in service().get(f"{API}/fits/{bench_fit()}/sheet").json()["lines"]}
    off = [
        lines["T"]["value"] / truth.T - 1,
        lines["dead_space"]["value"] / (truth.dead_space / 100) - 1,
        lines["hysteresis"]["value"] / (truth.B / 100) - 1,
    ]
    return (
        Measured("quantities of the sheet as JSON", len(lines), "", None, 12),
        Measured("T, B, dead space, furthest", 100 * float(np.abs(off).max()), "%", 5.0),
    )


ROWS = (
    Row("S1", "upload", "the same bytes again, a bad archive, a stranger", "–", "status codes", upload, long=True),
    Row("S2", "queue", "a search with its progress", "–", "the flat chain, seed 3", queued, long=True),
    Row("S3", "query", "sets by serial number and value, as CSV", "–", "what was stored", by_serial, long=True),
    Row("S4", "figures", "JSON, SVG, PNG, PDF", "–", "first bytes", figures, long=True),
    Row("S5", "approval", "approve, withdraw, audit", "–", "what was asked", approval, long=True),
    Row("S6", "regression", "recheck of approved sets, JUnit", "–", "the approved sets", regression, long=True),
    Row("S7", "verdict", "limits of a line", "–", "true value, seed 3", verdicts, long=True),
    Row(
        "S8",
        "story",
        "two hidden: a dead zone of 120 µm and friction of 40 N",
        "–",
        "flat nonlinear chain, seed 750",
        two_hidden,
        long=True,
    ),
    Row(
        "S9",
        "story",
        "one hidden: flow falls with the pressure",
        "–",
        "flat nonlinear chain, seed 750",
        one_hidden,
        long=True,
    ),
    Row("S10", "story", "the same in the browser", "–", "the story of the suite", in_the_browser, long=True),
    Row(
        "S11",
        "unknown terms",
        "a drift of the gain, which is unknown to the library",
        "–",
        "flat chain with a drift, seed 2",
        outside_the_catalogue,
        long=True,
    ),
    Row("S12", "export", "C, MAT, FMU", "–", "eq. (10) as a polynomial", exports, long=True),
    Row("S13", "report", "page and PDF", "–", "first bytes", reports, long=True),
    Row("S14", "comparison", "two actuators side by side", "–", "both serial numbers", side_by_side, long=True),
    Row("S15", "live", "a stream while a test runs", "–", "NumPy on what was sent", live, long=True),
    Row(
        "K25",
        "section 2",
        "limits of a line on dead space",
        "controlled in tests",
        "true value, seed 4",
        limits_of_a_line,
        long=True,
    ),
    Row(
        "K30",
        "section 6",
        "the sheet's numbers over HTTP",
        "–",
        "independent bench, seed 4",
        sheet_over_http,
        long=True,
    ),
)
