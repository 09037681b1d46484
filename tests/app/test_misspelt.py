"""A misspelt name is answered with the nearest one: in every option that takes a name, and in the bodies of HTTP."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest
import yaml
from fastapi.testclient import TestClient

from app.cli.program import commands
from tests.app.conftest import archived, files, unpacked
from tests.conftest import Program
from tests.running import TOKEN

API = "/api/v1"
HELD = {"Z0": 2.592e-6, "Cl": 1e-11, "c0": 3200.0, "m0": 4.25, "Ka": 1.39e-13}
"""Of the machine; τ alone is searched."""
UNITS = ("--time", ":s", "--channel", "command=:mm", "--channel", "displacement=:mm")
SERVICE = ("--server", "http://misspelt")

MISSPELT: dict[tuple[str, str], list[tuple[tuple[str, ...], str]]] = {
    ("effects", "--signals"): [(("--signals", "qian2041"), "qian2014")],
    ("simulate", "--preset"): [(("OUT", "--preset", "qian2041"), "qian2014")],
    ("simulate", "--effect"): [
        (("OUT", "--effect", "deadzone"), "dead_zone"),
        (("OUT", "--effect", "dead_zone.halfwidth=1 mm"), "dead_zone.half_width"),
    ],
    ("simulate", "--set"): [
        (("OUT", "--preset", "first_order", "--set", "tua=3 ms", "--test", "amplitude=5 mm"), "tau")
    ],
    ("simulate", "--test"): [(("OUT", "--preset", "first_order", "--test", "amplitud=5 mm"), "amplitude")],
    ("init", "--channel"): [
        (("RAW", "--channel", "comand=u:mm"), "command"),
        (("RAW", "--channel", "command=comand:mm"), "command"),
    ],
    ("init", "--dialect"): [
        (("RAW", "--dialect", "delimiter=semicolo"), "semicolon"),
        (("RAW", "--dialect", "delimeter=semicolon"), "delimiter"),
    ],
    ("init", "--time"): [(("RAW", "--time", "tme:s"), "time")],
    ("init", "--output"): [(("RAW", "--output", "displacment"), "displacement")],
    ("init", "--hold"): [(("RAW", *UNITS, "--hold", "liner"), "linear")],
    ("init", "--verify"): [(("RAW", "--verify", "rwa"), "raw")],
    ("fit", "--model"): [(("MATRIX", "--model", "kononykin"), "kononykhin")],
    ("fit", "--effect"): [(("MATRIX", "--model", "qian2014", "--effect", "deadzone"), "dead_zone")],
    ("fit", "--custom"): [(("MATRIX", "--model", "qian2014", "--custom", "overlp"), "overlap")],
    ("fit", "--method"): [(("MATRIX", "--model", "qian2014", "--method", "paperga"), "paper-ga")],
    ("fit", "--bounds"): [(("MATRIX", "--model", "qian2014", "--bounds", "tua=1 ms:6 ms"), "tau")],
    ("fit", "--set"): [(("MATRIX", "--model", "qian2014", "--set", "M0=4"), "m0")],
    ("fit", "--load"): [(("MATRIX", "--model", "qian2014", "--load", "forse"), "force")],
    ("fit", "--option"): [(("MATRIX", "--model", "qian2014", "--option", "populaton=20"), "population")],
    ("fit", "--profile"): [(("MATRIX", "--model", "qian2014", "HELD", "--profile", "tua"), "tau")],
    ("profile", "--parameter"): [(("MATRIX", "--fit", "FIT", "--parameter", "tua"), "tau")],
    ("compare", "--figure"): [(("MATRIX", "--fit", "FIT", "--out", "OUT", "--figure", "bdoe"), "bode")],
    ("compare", "--option"): [(("MATRIX", "--fit", "FIT", "--out", "OUT", "--option", "axes=linear"), "axis")],
    ("diagnose", "--model"): [(("MATRIX", "--model", "first_ordr"), "first_order")],
    ("diagnose", "--effect"): [(("MATRIX", "--model", "qian2014", "--effect", "Sensor Lag"), "sensor_lag")],
    ("diagnose", "--custom"): [(("MATRIX", "--model", "qian2014", "--custom", "over_lap1"), "overlap")],
    ("diagnose", "--method"): [(("MATRIX", "--model", "qian2014", "--method", "cmaes"), "cma-es")],
    ("diagnose", "--bounds"): [(("MATRIX", "--model", "qian2014", "--bounds", "tu=1 ms:6 ms"), "tau")],
    ("diagnose", "--set"): [(("MATRIX", "--model", "qian2014", "--set", "KA=1e-13"), "Ka")],
    ("diagnose", "--load"): [(("MATRIX", "--model", "qian2014", "--load", "nnoe"), "none")],
    ("diagnose", "--option"): [(("MATRIX", "--model", "qian2014", "--option", "generation=3"), "generations")],
    ("signals", "--run"): [(("MATRIX", "--run", "RUN", "--out", "OUT"), "RUN")],
    ("track", "--run"): [(("MATRIX", "--run", "RUN"), "RUN")],
    ("plan", "--program"): [(("--program", "qain", "--out", "OUT"), "qian")],
    ("plan", "--format"): [(("--program", "qian", "--format", "csw", "--out", "OUT"), "csv")],
    ("plan", "--spread"): [(("--program", "qian", "--fit", "FIT", "--spread", "tua=0.1", "--out", "OUT"), "tau")],
    ("control", "--case"): [(("FIT", "--case", "qain", "--out", "OUT"), "qian")],
    ("control", "--part"): [(("FIT", "--case", "PARTS", "--part", "lefd", "--out", "OUT"), "left")],
    ("control", "--structure"): [(("FIT", "--case", "qian", "--structure", "feedbak", "--out", "OUT"), "feedback")],
    ("control", "--spread"): [(("FIT", "--case", "qian", "--spread", "tua=0.1", "--out", "OUT"), "tau")],
    ("hybrid", "--spread"): [(("FIT", "--case", "qian", "--spread", "tua=0.1"), "tau")],
    ("whatif", "--spread"): [(("FIT", "--choose", "phase_margin=50", "--spread", "tua=0.1"), "tau")],
    ("control", "--before-case"): [(("FIT", "--case", "qian", "--before-case", "qain", "--out", "OUT"), "qian")],
    ("control", "--over"): [
        (("FIT", "--case", "qian", "--at", "60 degC", "--over", "temprature", "--out", "OUT"), "temperature")
    ],
    ("hybrid", "--over"): [(("FIT", "--case", "qian", "--at", "60 degC", "--over", "temprature"), "temperature")],
    ("whatif", "--over"): [(("FIT", "--at", "60 degC", "--over", "temprature"), "temperature")],
    ("statistics", "--over"): [(("tau", "--over", "temprature", *SERVICE), "temperature")],
    ("verdict", "--over"): [(("NEAR-1", "--at", "60 degC", "--over", "temprature", *SERVICE), "temperature")],
    ("hybrid", "--isolator"): [
        (("FIT", "--case", "qian", "--isolator", "stifness=1 N/m"), "stiffness"),
        (("FIT", "--case", "PARTS", "--isolator", "mass=1 kg, part=lefd"), "left"),
    ],
    ("hybrid", "--before-case"): [(("FIT", "--case", "qian", "--before-case", "qain"), "qian")],
    ("hybrid", "--case"): [(("FIT", "--case", "benchmark202"), "benchmark2020")],
    ("hybrid", "--controller"): [(("FIT", "--case", "qian", "--controller", "kalmann"), "kalman")],
    ("hybrid", "--ground"): [(("FIT", "--case", "qian", "--ground", "blnw"), "blwn")],
    ("hybrid", "--effect"): [(("FIT", "--case", "qian", "--effect", "coulomb-friction2"), "coulomb_friction")],
    ("whatif", "--set"): [(("FIT", "--set", "tua=3 ms"), "tau")],
    ("whatif", "--fitted"): [(("FIT", "--fitted", "strok=100 mm"), "stroke")],
    ("whatif", "--choose"): [(("FIT", "--choose", "phase_marign=50"), "phase_margin")],
    ("whatif", "--regulator"): [(("FIT", "--regulator", "kp=1, dely=1 ms"), "delay")],
    ("whatif", "--specimen"): [(("FIT", "--specimen", "mas=1 kg"), "mass")],
    ("export", "--format"): [(("FIT", "--format", "fmuu", "--out", "OUT"), "fmu")],
    ("export", "--specimen"): [(("FIT", "--format", "c", "--specimen", "stifness=1 N/m", "--out", "OUT"), "stiffness")],
    ("serve", "--log"): [(("--log", "jsn"), "json")],
    ("worker", "--log"): [(("--executor", "w1", "--database", "postgresql://u@127.0.0.1:9/x", "--log", "txt"), "text")],
    ("regress", "--model"): [(("--model", "qian2041", *SERVICE), "qian2014")],
    ("query", "--model"): [(("--model", "qian2041", *SERVICE), "qian2014")],
    ("query", "--serial"): [(("--serial", "NEAR_1", *SERVICE), "NEAR-1")],
    ("query", "--batch"): [(("--batch", "B-1", *SERVICE), "B1")],
    ("query", "--range"): [(("--range", "dead_zone.halfwidth=0:1", *SERVICE), "dead_zone.half_width")],
    ("statistics", "parameter"): [(("error-fit", *SERVICE), "error.fit")],
    ("statistics", "--batch"): [(("tau", "--batch", "B-1", *SERVICE), "B1")],
    ("statistics", "--model"): [(("tau", "--model", "qian2041", *SERVICE), "qian2014")],
    ("limits", "model"): [(("qian2041", *SERVICE), "qian2014")],
    ("limits", "--limit"): [
        (("qian2014", "--limit", "tua=1:2 ms", *SERVICE), "tau"),
        (("qian2014", "--limit", "deadzone.half_width=0:1 mm", *SERVICE), "dead_zone"),
    ],
    ("revise", "changes"): [(("STORED", "CHANGES", *SERVICE), "RUN")],
    ("effects drop", "name"): [(("overlp",), "overlap"), (("overlp", *SERVICE), "overlap")],
    ("token new", "--role"): [(("--name", "bench", "--role", "admn", "--data", "OUT"), "admin")],
    ("", "--units"): [(("--units", "baar,l/min", "check", "MATRIX"), "bar")],
    ("webhook new", "--event"): [(("http://127.0.0.1:9", "--event", "job.endd", *SERVICE), "job.ended")],
}
"""For each argument or option that takes a name: what is given, and what it says was meant."""

PARTS = """
structure:
  mass: {matrix: [[80, 0], [0, 80]], unit: kg}
  stiffness: {matrix: [[90, -40], [-40, 90]], unit: kN/m}
  damping: {matrix: [[200, -50], [-50, 200]], unit: N*s/m}
physical:
- {name: left, storey: 1, gain: 7, delay: 1, mass: 8 kg, stiffness: 17 kN/m}
- {name: right, storey: 2, gain: 5, delay: 1, mass: 6 kg, stiffness: 10 kN/m}
piston_area: 497 mm^2
ground: {kind: blwn, band: 20 Hz, amplitude: 0.1 g, duration: 1 s}
"""

ADDRESSES = {"--server", "--token", "--data", "--database", "--blobs", "--host", "--allow-host", "--proxy",
             "--webhook-host", "url"}  # fmt: skip
MADE_UP = {"--executor", "--why", "--name", "--expires", "--approved-after", "--confirm", "--laboratory",
           "--customer", "--order", "--operator", "--date", "--oil-temperature", "--note", "--tag"}  # fmt: skip
QUANTITIES = {"--rate", "--area", "--gain", "--noise", "--peak", "--amplitude", "--tolerance", "--axes", "--up-to",
              "--sample-rate", "--before-gain", "--at"}  # fmt: skip
DRAWN = {"fit", "matrix", "webhook", "token", "--by", "--object"}
"""Ids that the service drew: none is near another."""
FREE = ADDRESSES | MADE_UP | QUANTITIES | DRAWN | {"files", "source"}
"""Options that take text but no name of a list."""
FREE_OF = {
    ("init", "--serial"),
    ("simulate", "--serial"),
    ("limits", "--batch"),  # a new name may be given
    ("regress", "--serial"),
    ("regress", "--batch"),
    ("statistics", "--serial"),  # of a whole line
    ("verdict", "serial"),
    ("search", "text"),
}


def options(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, str]]:
    """Every argument and option that takes text, or a file that may be a name, by its command."""
    for parameter in command.params:
        kind = parameter.type_descriptor.annotation
        named = "NAME" in (parameter.metavar or "") or parameter.metavar in ("CHANGES.yaml", "FILES…")
        if kind is str or (getattr(kind, "__name__", "") == "list" and parameter.metavar != "FIT.json") or named:
            yield " ".join(path), parameter.opts[0] if parameter.opts else parameter.name
    for name, inner in getattr(command, "commands", {}).items():
        yield from options(inner, (*path, name))


def test_no_option_that_takes_a_name_escapes():
    """A new one is misspelt here, or said to take no name of a list."""
    found = set(options(commands()))
    free = {one for one in found if one[1] in FREE or one in FREE_OF}
    assert found - free == MISSPELT.keys()
    assert len(MISSPELT) > 50


@dataclass(frozen=True)
class Given:
    """What stands for the words in capitals of a case."""

    words: dict[str, tuple[str, ...]]
    run: str

    def arguments(self, texts: tuple[str, ...]) -> list[str]:
        """The arguments of a case."""
        return [word for text in texts for word in self.words.get(text, (text,))]


@pytest.fixture(scope="module")
def given(service: TestClient, servoident: Program, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Given]:
    """A matrix as a folder and stored, a fit of it as a file, an effect that is kept, here and by the service."""
    with pytest.MonkeyPatch.context() as own:  # what other tests keep is kept elsewhere
        for name in ("XDG_STATE_HOME", "XDG_DATA_HOME"):
            own.setenv(name, str(tmp_path_factory.mktemp("state")))
        yield made(service, servoident, tmp_path_factory.mktemp("misspelt"))


def made(service: TestClient, servoident: Program, place: Path) -> Given:
    """The same, its files in a folder."""
    folder = unpacked(files("NEAR-1"), place / "matrix")
    run = yaml.safe_load((folder / "matrix.yaml").read_text())["runs"][0]["id"]
    held = [text for name, value in HELD.items() for text in ("--set", f"{name}={value!r}")]
    stored = service.post(f"{API}/matrices", files={"files": ("m.zip", archived(files("NEAR-1")))}).json()["id"]
    fit = service.post(f"{API}/fits", json={"matrix": stored, "model": "qian2014", "set": HELD}).json()["id"]
    service.get(f"{API}/jobs/{fit}/events")
    (place / "fit.json").write_text(json.dumps(service.get(f"{API}/fits/{fit}").json()["result"]))
    own = place / "overlap.yaml"
    own.write_text(
        "{place: spool, equation: 'w = w - clip(w, -h, h)', strength: {symbol: h, unit: mm, lower: 0, upper: 1}}"
    )
    assert servoident("effects", "keep", own).returncode == 0
    definition = {"name": "overlap", "definition": yaml.safe_load(own.read_text())}
    assert service.post(f"{API}/own-effects", json=definition).status_code in (200, 201, 409)
    raw, changes = place / "raw.csv", place / "changes.yaml"
    raw.write_text("time,command,displacement\n" + "".join(f"{0.001 * k},{k % 7},{k % 5}\n" for k in range(64)))
    changes.write_text(yaml.safe_dump({"runs": {f"{run}x": {"gain": 7}}}))
    parts = place / "parts.yaml"
    parts.write_text(PARTS)
    words = {
        "PARTS": (str(parts),),
        "MATRIX": (str(folder),),
        "FIT": (str(place / "fit.json"),),
        "OUT": (str(place / "out"),),
        "RAW": (str(raw), "--serial", "RAW-1", "--out", str(place / "raw-out")),
        "HELD": tuple(held),
        "RUN": (f"{run}x",),
        "CHANGES": (str(changes),),
        "STORED": (stored,),
        "STORED_FIT": (fit,),
    }
    return Given(words, run)


CASES = [(command, *case) for (command, _), cases in MISSPELT.items() for case in cases]


@pytest.mark.parametrize(("command", "texts", "meant"), CASES, ids=[f"{c} {' '.join(t[:4])}" for c, t, _ in CASES])
def test_a_misspelt_name_is_answered_with_the_nearest(given, service, servoident, monkeypatch, command, texts, meant):
    """In one line, the last that is said, and instead of a list."""

    def asked(method: str, url: str, headers: Any, **content: Any) -> httpx.Response:
        content = {name: value for name, value in content.items() if name not in ("timeout", "verify")}
        return service.request(method, url.removeprefix(SERVICE[1]), headers=headers, **content)

    monkeypatch.setattr(httpx, "request", asked)
    monkeypatch.setenv("SERVOIDENT_TOKEN", TOKEN)
    done = servoident(*command.split(), *given.arguments(texts))
    said = done.stderr.splitlines()[-1]
    assert f"id you mean {given.run if meant == 'RUN' else meant}?" in said, done.stderr
    assert done.returncode == (0 if command in ("query", "regress") else 2)


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        (("fot",), "fit"),
        (("effects", "kep"), "keep"),
        (("fit", "m", "--efect", "x"), "--effect"),
        (("fit", "m", "--no-stroke-center"), "--no-stroke-centre"),
        (("check", "m", "--no-run-exclusio"), "exclusion"),
    ],
)
def test_commands_and_options_are_names_too(servoident, arguments, meant):
    done = servoident(*arguments)
    assert done.returncode == 2
    assert meant in done.stderr.splitlines()[-1]
    assert "id you mean" in done.stderr


BODIES = [
    ("/fits", {"matrix": "STORED", "modle": "qian2014"}, "model"),
    ("/fits", {"matrix": "STORED", "model": "qian2041"}, "qian2014"),
    ("/fits", {"matrix": "STORED", "effects": ["deadzone"]}, "dead_zone"),
    ("/fits", {"matrix": "STORED", "effects": ["overlp"]}, "overlap"),
    ("/fits", {"matrix": "STORED", "custom": ["overlp"]}, "overlap"),
    ("/fits", {"matrix": "STORED", "model": "qian2014", "bounds": {"tua": [1e-3, 2e-3]}}, "tau"),
    ("/fits", {"matrix": "STORED", "model": "qian2014", "set": {"M0": 4}}, "m0"),
    ("/fits", {"matrix": "STORED", "model": "qian2014", "options": {"populaton": 20}}, "population"),
    ("/fits", {"matrix": "STORED", "model": "qian2014", "method": "cmaes"}, "cma-es"),
    ("/fits", {"matrix": "STORED", "model": "qian2014", "preprocessing": {"stroke_center": False}}, "stroke_centre"),
    ("/fits", {"matrix": "STORED", "model": "motor", "preprocessing": {"comand_offset": False}}, "command_offset"),
    ("/diagnoses", {"matrix": "STORED", "preprocessing": {"inital_state": False}}, "initial_state"),
    ("/diagnoses", {"matrix": "STORED", "maxeffects": 2}, "max_effects"),
    ("/matrices/STORED/revisions", {"actuater": {}}, "actuator"),
    ("/webhooks", {"url": "http://127.0.0.1:9", "events": ["set.aproved"]}, "set.approved"),
]


@pytest.mark.parametrize(("path", "body", "meant"), BODIES, ids=[f"{path} {meant}" for path, _, meant in BODIES])
def test_so_it_is_in_the_body_of_a_request(given, service, path, body, meant):
    stored = given.words["STORED"][0]
    sent = json.loads(json.dumps(body).replace("STORED", stored))
    answer = service.post(f"{API}{path.replace('STORED', stored)}", json=sent)
    assert answer.status_code == 422, answer.text
    assert answer.json()["remedy"] == f"did you mean {meant}?"


@pytest.mark.parametrize(
    ("query", "meant"),
    [("bod.svg", "bode"), ("bode.svgg", "svg"), ("bode.svg?them=dark", "theme"), ("time.svg?ru=1", "run")],
)
def test_and_in_the_name_of_a_figure_and_of_its_options(given, service, query, meant):
    answer = service.get(f"{API}/fits/{given.words['STORED_FIT'][0]}/figures/{query}")
    assert answer.status_code in (404, 422)
    assert answer.json()["remedy"] == f"did you mean {meant}?"
