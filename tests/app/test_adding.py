"""Every name that a diagnosis gives is added to a fit: over HTTP, by the page's button, and from the command line.

Ten names of two machines: of the catalogue, of an own effect that was ranked, and of proposed terms. The diagnoses are
written here; the machine's own parameters are held, so that a fit searches for what was added and nothing else.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.diagnoses import repository as diagnoses
from app.jobs import repository as jobs
from ident.custom.definition import read_effect
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Baseline, Diagnosis, Ranked, Rung, Verdict
from ident.effects.effect import Effect
from ident.presets import PRESETS
from ident.synthesis.bench_matrix import write_bench
from tests.app.conftest import archived
from tests.app.test_diagnoses import OWN
from tests.bench.sets import simulated
from tests.hidden_dead_zone import HALF_WIDTH, files
from tests.reference import qian_reference as linear

API = "/api/v1"
SHORT = {"population": 12, "generations": 2, "elite": 3}
BENT = {
    "name": "proposed_1",
    "place": "spool",
    "equation": ["w = w - s * w * abs(w)"],
    "strength": {"symbol": "s", "unit": "1/m", "lower": -100.0, "upper": 100.0},
}
NOTCHED = {
    "name": "proposed_2",
    "place": "spool",
    "equation": ["w = w - s * clip(w, -h, h)"],
    "strength": {"symbol": "s", "unit": "1", "lower": 0.0, "upper": 1.5},
    "shape": {"h": {"unit": "m", "lower": 1e-5, "upper": 1e-3, "value": HALF_WIDTH}},
}
STANDS_ON = "null_bias"  # in addition to which the terms were found
SERVO = ("dead_zone", "sensor_lag", "backlash", "overlap", "proposed_1", "proposed_2")
BENCH = ("command_delay", "second_lag", "spring_load", "stiction")
NAMES = (*SERVO, *BENCH)
TO_THE_END = ("dead_zone", "proposed_2")
"""In the short form the others are queued, and cancelled once it is known what is fitted."""


ERRORS = {"fit": 0.01, "held_out": 0.01, "verify": None}
BASELINE = Baseline({"fit": 0.1, "held_out": 0.1, "verify": None})


def whole(name: str) -> list[str]:
    """The effects that are added by a name."""
    terms = [BENT["name"], NOTCHED["name"]]
    return [STANDS_ON, *terms[: terms.index(name) + 1]] if name in terms else [name]


@dataclass(frozen=True)
class Machine:
    """A matrix as a folder and on the service, what a fit of it holds, the fit, and its diagnosis as a file."""

    folder: Path
    model: str
    held: dict[str, float]
    fit: str
    diagnosis: Path


def machine(service: TestClient, folder: Path, model: str, held: dict[str, float], found: Diagnosis) -> Machine:
    """Upload a folder, fit the model with everything held, and store the diagnosis of that fit."""
    contents = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*.*")}
    stored = service.post(f"{API}/matrices", files={"files": ("m.zip", archived(contents))}).json()
    matrix, serial = stored["id"], stored["serial"]
    wanted = {"matrix": matrix, "model": model, "set": held, "options": SHORT}
    fit = ended(service, service.post(f"{API}/fits", json=wanted))["fit"]
    with service.app.state.context.sessions.begin() as session:
        job = jobs.add(session, f"diagnosis-of-{fit}", matrix, {}, fit, "diagnosis")
        job.state = "succeeded"
        session.flush()
        diagnoses.add(session, job, serial, found.to_json())
    file = folder.parent / f"{model}.json"
    file.write_text(json.dumps(found.to_json()))
    return Machine(folder, model, held, fit, file)


def ended(service: TestClient, answer: Any) -> dict[str, Any]:
    """The job of a 202, when it has ended well."""
    assert answer.status_code == 202, answer.text
    service.get(f"{API}/jobs/{answer.json()['id']}/events")
    job: dict[str, Any] = service.get(f"{API}/jobs/{answer.json()['id']}").json()
    assert job["state"] == "succeeded", job
    return job


def ranked(name: str, parameter: str, unit: str) -> Ranked:
    """A candidate that helps."""
    found = {f"{name}.{parameter}": ParameterEstimate(1e-4, unit, 1e-6)}
    return Ranked(effect=name, error=ERRORS, parameters=found, evidence={"beyond_chance": True})


@pytest.fixture(scope="module")
def servo(service: TestClient, tmp_path_factory: pytest.TempPathFactory) -> Machine:
    """A servo loop with a dead zone; an own effect was ranked, and a search proposes two terms."""
    folder = tmp_path_factory.mktemp("servo") / "matrix"
    for name, content in files("ADD-1").items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    held = {name: float(getattr(linear.Plant(), name)) for name in ("Z0", "tau", "Cl", "c0", "m0", "Ka")}
    parameters = {
        "dead_zone": ("half_width", "m"),
        "sensor_lag": ("time_constant", "s"),
        "backlash": ("half_width", "m"),
        "overlap": ("h", "m"),
    }
    terms = tuple(
        Proposal(
            place=("spool",), equation=one["equation"][0], effect=one, terms=count, beside=(STANDS_ON,), error=ERRORS
        )
        for count, one in enumerate((BENT, NOTCHED), 1)
    )
    found = Diagnosis(
        candidates=tuple(ranked(name, *of) for name, of in parameters.items()),
        verdict=Verdict(),
        proposals=terms,
        baseline=BASELINE,
        ladder=(Rung(error=ERRORS),),
        settings={"custom": [OWN]},
    )
    return machine(service, folder, "qian2014", held, found)


@pytest.fixture(scope="module")
def bench(service: TestClient, tmp_path_factory: pytest.TempPathFactory) -> Machine:
    """An actuator on a bench."""
    folder = tmp_path_factory.mktemp("bench") / "matrix"
    (folder / "runs").mkdir(parents=True)
    with simulated(full=False):
        write_bench(folder, PRESETS["kononykhin"], seed=6, noise=0.005)
    held = {parameter.name: parameter.value for parameter in PRESETS["kononykhin"].parameters}
    parameters = {
        "command_delay": ("delay", "s"),
        "second_lag": ("time_constant", "s"),
        "spring_load": ("rate", "Pa/m"),
        "stiction": ("pressure", "Pa"),
    }
    candidates = tuple(ranked(name, *of) for name, of in parameters.items())
    return machine(
        service,
        folder,
        "kononykhin",
        held,
        Diagnosis(model="kononykhin", candidates=candidates, verdict=Verdict(), baseline=BASELINE),
    )


@pytest.fixture(scope="module")
def asked(service: TestClient, servo: Machine, bench: Machine, full: bool) -> dict[str, dict[str, Any]]:
    """The settings with which each name was fitted that was added over HTTP, by nothing but its name."""
    found = {}
    for name in NAMES:
        of = servo if name in SERVO else bench
        answer = service.post(f"{API}/fits/{of.fit}/effects", json={"effect": name})
        assert answer.status_code == 202, answer.text
        if full or name in TO_THE_END:
            fit = service.get(f"{API}/fits/{ended(service, answer)['fit']}").json()
            assert sorted(fit["result"]["effects"]) == sorted(whole(name))
            assert fit["parent"] == of.fit
        else:
            service.delete(f"{API}/jobs/{answer.json()['id']}")
        found[name] = answer.json()["settings"]
    return found


def test_every_name_is_added_over_http(asked):
    assert len(asked) == 10
    for name, settings in asked.items():
        assert sorted(settings["effects"]) == sorted(whole(name))


class Buttons(HTMLParser):
    """The forms of a page that add something: what each sends, as missing.js reads it."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.sent: list[tuple[str, dict[str, Any]]] = []
        self._open = False
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        if tag == "form":
            self._open = "data-add" in given
            if self._open:
                self.sent.append((given["data-add"], {"effects": [], "custom": []}))
        elif tag == "input" and self._open and given.get("type") == "hidden":
            value = json.loads(given["value"]) if given["name"] == "custom" else given["value"]
            self.sent[-1][1][given["name"]].append(value)


@pytest.mark.parametrize("of", ["servo", "bench"])
def test_every_name_is_added_by_the_page_s_button(service, servo, bench, asked, of):
    """A button for each; what it sends is fitted as what was added over HTTP by the name alone."""
    chosen, names = (servo, SERVO) if of == "servo" else (bench, BENCH)
    page = service.get(f"/fits/{chosen.fit}").text
    section = page[page.index('id="missing"') :]
    buttons = {tuple(sorted(body["effects"])): (address, body) for address, body in Buttons(section).sent}
    for name in names:
        address, body = buttons[tuple(sorted(whole(name)))]
        answer = service.post(address, json=body)
        assert answer.status_code == 202, answer.text
        service.delete(f"{API}/jobs/{answer.json()['id']}")
        assert answer.json()["settings"] == asked[name], name


@pytest.mark.full
def test_every_name_is_added_from_the_command_line(servo, bench, asked, servoident, tmp_path, full, monkeypatch):
    """With the very settings of the service; in the short form two of the fits are made, the others only asked for."""
    seen = list(_fitted(servoident, monkeypatch, servo, bench, tmp_path, full))
    assert [name for name, _ in seen] == list(NAMES)
    for name, settings in seen:
        there = {key: asked[name][key] for key in settings}
        assert defined(settings) == defined(there), name
        assert {**settings, "custom": []} == {**there, "custom": []}, name


def defined(settings: dict[str, Any]) -> list[Effect]:
    """The own effects of a fit; one that was kept says so as its source, and the service shows what is not stated."""
    stated = [{key: entry for key, entry in one.items() if entry} for one in settings["custom"]]
    return [replace(read_effect(one), source="") for one in stated]


def _fitted(
    servoident: Any, monkeypatch: pytest.MonkeyPatch, servo: Machine, bench: Machine, place: Path, full: bool
) -> Iterator[tuple[str, dict[str, Any]]]:
    """The settings of each fit that the command line makes, or would make."""
    from ident import workflows

    for name in NAMES:
        of = servo if name in SERVO else bench
        more = ["--custom", of.diagnosis, "--terms", name[-1]] if name.startswith("proposed_") else ["--effect", name]
        if name == OWN["name"]:
            (place / "own.json").write_text(json.dumps(OWN))
            assert servoident("effects", "keep", place / "own.json").returncode == 0
        held = [text for parameter, value in of.held.items() for text in ("--set", f"{parameter}={value!r}")]
        options = [text for option, value in SHORT.items() for text in ("--option", f"{option}={value}")]
        with monkeypatch.context() as patch:
            caught: list[Any] = []
            if not full and name not in ("dead_zone", "command_delay"):
                patch.setattr(
                    workflows, "identify", lambda _matrix, settings, _report, to=caught: to.append(settings) or 1 / 0
                )
            out = place / f"{name}.json"
            done = servoident("fit", of.folder, "--model", of.model, *more, *held, *options, "--json", out)
        if caught:
            yield name, json.loads(json.dumps(caught[0].to_json()))
        else:
            assert done.returncode == 0, done.stderr
            yield name, json.loads(out.read_text())["settings"]
