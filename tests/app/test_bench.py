"""Bench records over HTTP: upload, fit, figures and the acceptance sheet, what is missing, the page."""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
from pathlib import Path
from typing import Any

import pytest
import scipy.io
import typer
import yaml
from fastapi.testclient import TestClient

from app.cli.sheet import sheet as show_sheet
from ident.bench.outputs import model_of
from ident.bench.position_loop import margins
from ident.errors import Unusable
from ident.presets import PRESETS
from ident.readers.regulator_description import describe_regulator
from ident.synthesis.bench_matrix import write_bench
from tests.bench.sets import simulated
from tests.short_form import short_form

API = "/api/v1"
REGULATOR = "regulator: {kp: 8 %/mm, sample_time: 2 ms, delay: 1 ms, limit: 100 %, amplitudes: [2 %, 10 %]}"
OPTIONS = {"population": 16, "generations": 2, "elite": 3}


def ended(service: TestClient, answer: Any) -> dict[str, Any]:
    """The job of a 202, when it has ended."""
    assert answer.status_code == 202, answer.text
    service.get(f"{answer.headers['Location']}/events")
    job: dict[str, Any] = service.get(answer.headers["Location"]).json()
    assert job["state"] == "succeeded", job
    return job


@pytest.fixture(scope="module")
def fit(service: TestClient, tmp_path_factory: pytest.TempPathFactory, full: bool) -> str:
    """A fit of an uploaded set."""
    folder = Path(tmp_path_factory.mktemp("bench"))
    (folder / "runs").mkdir()
    with simulated(full):
        write_bench(folder, PRESETS["kononykhin"], seed=5, noise=0.005)
    with (folder / "matrix.yaml").open("a") as description:
        description.write(f"\n{REGULATOR}\n")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for path in sorted(folder.rglob("*.*")):
            archive.write(path, path.relative_to(folder))
    answer = service.post(f"{API}/matrices", files={"files": ("bench.zip", packed.getvalue())})
    assert answer.status_code == 201, answer.text
    wanted = {"matrix": answer.json()["id"], "model": "kononykhin", "options": OPTIONS}
    return str(ended(service, service.post(f"{API}/fits", json=wanted))["fit"])


def test_the_values_and_the_procedures_beside_them(service, fit):
    result = service.get(f"{API}/fits/{fit}").json()["result"]
    assert result["parameters"]["T"]["value"] == pytest.approx(0.02, rel=0.03)
    assert result["parameters"]["kp"]["value"] == pytest.approx(4.2e8, rel=0.03)
    assert any("Step by step" in note for note in result["notes"])


FIGURES, SHEET = [name for name in PRESETS["kononykhin"].display.figures if name != "evolution"], "acceptance-sheet"


@pytest.mark.parametrize("name", short_form(FIGURES, *FIGURES[:2]))
def test_every_figure_is_served(service, fit, name):
    """As SVG for the page and PDF for the file; the sheet says whether the limits of the set are kept."""
    drawn = service.get(f"{API}/fits/{fit}/figures/{name}.svg")
    assert drawn.status_code == 200, drawn.text
    assert "SIM-BENCH-0001" in drawn.text
    if name == SHEET:
        assert "acceptance test passed" in drawn.text
    assert service.get(f"{API}/fits/{fit}/figures/{name}.pdf").content.startswith(b"%PDF")


def test_the_sheet_is_json_judged_by_the_limits_of_the_line(service, fit):
    """By those of its data set, until the line has its own, which the verdict takes, too; a query finds it by them."""
    sheet = service.get(f"{API}/fits/{fit}/sheet").json()
    lines = {line["name"]: line for line in sheet["lines"]}
    assert {"zero_shift", "dead_space", "gain", "asymmetry", "nonlinearity", "position_error"} <= lines.keys()
    result = service.get(f"{API}/fits/{fit}").json()["result"]
    assert lines["T"]["value"] == result["sheet"]["T"]["value"]
    assert lines["dead_space"]["upper"] is not None  # of limits.yaml
    assert sheet["verdict"] in ("pass", "unknown")
    serial, space = sheet["serial"], lines["dead_space"]["value"]
    service.post(f"{API}/fits/{fit}/approve", json={"why": "a test"})
    before = service.get(f"{API}/actuators/{serial}/verdict").json()
    assert {one["name"] for one in before["judged"]} >= {"sheet.dead_space"}
    limits = {"sheet.dead_space": {"upper": 50 * space, "unit": "%"}, "sheet.asymmetry": {"upper": 1, "unit": "1"}}
    put = service.put(f"{API}/limits/kononykhin", json={"limits": limits})
    assert put.status_code == 200, put.text
    line = next(one for one in service.get(f"{API}/fits/{fit}/sheet").json()["lines"] if one["name"] == "dead_space")
    assert (line["upper"], line["outcome"]) == (pytest.approx(space / 2), "outside")
    verdict = service.get(f"{API}/actuators/{serial}/verdict").json()
    assert verdict["verdict"] == "fail"
    assert any("sheet.dead_space" in reason for reason in verdict["reasons"])
    for low, count in ((0.9 * space, 1), (1.1 * space, 0)):
        asked = {"sheet.dead_space.min": low, "serial": serial, "current": True}
        assert len(service.get(f"{API}/parameter-sets", params=asked).json()["items"]) == count
    assert service.get(f"{API}/statistics", params={"parameter": "sheet.gain", "serial": serial}).json()["n"] == 1
    assert "sheet.dead_space" in service.get("/limits?model=kononykhin").text
    for name in ("sheet.dead_spice", "dead_space"):
        wrong = service.put(f"{API}/limits/kononykhin", json={"limits": {name: {"upper": 1, "unit": "%"}}})
        assert wrong.status_code == 422
    service.put(f"{API}/limits/kononykhin", json={"limits": {}})


def test_the_identification_is_sent_as_c_for_a_control_unit(service, fit, fitted):
    """A header for the records of the set, from the page of the fit's use; of another model it is refused."""
    sent = service.get(f"{API}/fits/{fit}/identification.h")
    assert sent.status_code == 200, sent.text
    assert "attachment" in sent.headers["Content-Disposition"]
    assert "static inline int servoident_identify(" in sent.text
    runs = service.get(f"{API}/fits/{fit}").json()["result"]["runs"]
    assert f"#define SERVOIDENT_RECORDS {len(runs)}\n" in sent.text
    assert f"/api/v1/fits/{fit}/identification.h" in service.get(f"/fits/{fit}/use").text
    refused = service.get(f"{API}/fits/{fitted}/identification.h")
    assert (refused.status_code, refused.json()["code"]) == (422, "no-export")


def test_a_diagnosis_of_a_sound_set_names_nothing(service, fit):
    """And no run is proposed after it: the reason is in the answer."""
    job = ended(service, service.post(f"{API}/diagnoses", json={"fit": fit}))
    found = service.get(f"{API}/diagnoses/{job['diagnosis']}").json()
    assert found["verdict"]["effects"] == []
    assert {c["effect"] for c in found["candidates"]} == {"command_delay", "second_lag", "stiction", "spring_load"}
    refused = service.get(f"{API}/diagnoses/{job['diagnosis']}/proposal")
    assert refused.status_code == 422
    assert "bench" in refused.json()["detail"]


def test_the_page_offers_what_a_bench_has(service, fit):
    """The sheet's tab, amplitudes in shares of the rated current, the effects of a bench, one's own; no budget."""
    page = service.get(f"/fits/{fit}").text
    assert "Acceptance sheet" in page
    assert "data-budget" not in page
    assert "Define your own effect" in page
    assert ">50 %<" in page
    assert '"spring_load"' in page
    assert re.findall(r'class="signal[^>]*>([^<]*)<', page) == ["e", "q", "w", "V0", "X"]


def test_the_margins_of_a_position_loop_are_told_at_each_amplitude(service, fit, servoident, tmp_path):
    """Over HTTP, as a figure, on the page and from the command line: the same numbers, in every unit."""
    asked = {"kp": "8 %/mm", "sample_time": "2 ms", "delay": 0.001, "limit": "100 %", "amplitudes": ["2 %", 0.1]}
    found = service.post(f"{API}/fits/{fit}/position-loop", json=asked).json()
    assert [one["amplitude"] for one in found["amplitudes"]] == pytest.approx([0.02, 0.1])
    assert found["gain_margin"] == min(one["gain_margin"] for one in found["amplitudes"])
    assert found["state"] == "stable"
    drawn = service.get(f"{API}/fits/{fit}/position-loop/figures/margins.svg", params={"asked": json.dumps(asked)})
    assert "10.0 % of rated current" in drawn.text
    form = {**asked, "ask": "position-loop", "amplitudes": "2 %; 10 %"}
    page = service.get(f"/fits/{fit}/use", params=form)
    assert page.status_code == 200
    assert found["amplitudes"][0]["text"] in page.text
    refused = service.get(f"/fits/{fit}/use", params={"ask": "position-loop", "kp": ""})
    assert refused.status_code == 422
    assert "regulator kp" in refused.text
    (tmp_path / "fit.json").write_text(json.dumps(service.get(f"{API}/fits/{fit}").json()["result"]))
    given = (
        "--regulator",
        "kp=8 %/mm, sample_time=2 ms, delay=1 ms, limit=1",
        "--amplitude",
        "2 %",
        "--amplitude",
        "0.1",
    )
    done = servoident("whatif", tmp_path / "fit.json", *given, "--json", tmp_path / "loop.json")
    assert done.returncode == 0, done.stderr
    assert json.loads((tmp_path / "loop.json").read_text()) == found
    assert servoident("whatif", tmp_path / "fit.json", "--regulator", "kp=9000").returncode == 1  # unstable
    for wrong, said in (("sample_tme=2 ms", "sample_time"), ("ki=3", "no kp")):
        assert said in servoident("whatif", tmp_path / "fit.json", "--regulator", wrong).stderr
    assert "regulator" in servoident("whatif", tmp_path / "fit.json").stderr


def test_an_effect_of_the_bench_is_added_to_its_fit(service, fit, full):
    """Nothing of it is hidden in this set: the strength is nothing, and the error stays."""
    if not full:  # tests/bench adds one without the service, which adds one of another machine
        pytest.skip("ten seconds: run with --full")
    job = ended(service, service.post(f"{API}/fits/{fit}/effects", json={"effect": "spring_load"}))
    before, after = (service.get(f"{API}/fits/{one}").json()["result"] for one in (fit, job["fit"]))
    assert after["effects"] == ["spring_load"]
    assert abs(after["parameters"]["spring_load.rate"]["value"]) < 1e5
    assert after["error"]["fit"] == pytest.approx(before["error"]["fit"], rel=0.02)


def test_an_effect_in_another_unit_is_refused_at_once(service, fit):
    """Nothing is queued that a fit of the bench must refuse."""
    refused = service.post(f"{API}/fits/{fit}/effects", json={"effect": "dead_zone"})
    assert refused.status_code == 422
    assert "it redefines w in m, which is a plain number here" in refused.json()["detail"]


def test_the_actuator_of_a_bench_is_exported(service: TestClient, fit: str) -> None:
    """As C with its play, and as MAT with its blocks; a gain, which it has not, is refused."""
    assert " *   B = " in service.get(f"{API}/fits/{fit}/export.h", params={"sample_rate": "1 kHz"}).text
    held = service.get(f"{API}/fits/{fit}/export.mat").content
    assert len(scipy.io.loadmat(io.BytesIO(held), squeeze_me=True)["Speeds"]) == 13
    assert service.get(f"{API}/fits/{fit}/export.h", params={"gain": "2"}).json()["code"] == "no-export"


def test_the_margin_of_a_produced_actuator_is_a_quantity_of_its_sheet(service: TestClient, fit: str) -> None:
    """Of the stated regulator: as the position loop of the fit has it, with limits, a verdict, statistics, a query.

    The margins of the fit's values are another way to the same number: the sheet is that of the procedures.
    """
    sheet = {line["name"]: line for line in service.get(f"{API}/fits/{fit}/sheet").json()["lines"]}
    asked = {"kp": "8 %/mm", "sample_time": "2 ms", "delay": "1 ms", "limit": "100 %", "amplitudes": ["2 %", "10 %"]}
    loop = service.post(f"{API}/fits/{fit}/position-loop", json=asked).json()
    gain, phase = sheet["gain_margin"], sheet["phase_margin"]
    assert (gain["unit"], phase["unit"]) == ("dB", "rad")
    assert gain["value"] == pytest.approx(loop["gain_margin"], abs=0.1)
    assert math.degrees(phase["value"]) == pytest.approx(loop["phase_margin"], abs=0.5)
    assert 0 < gain["std_error"] < 0.5
    true = model_of({p.in_equations: p.value for p in PRESETS["kononykhin"].parameters}, math.inf)
    regulator = describe_regulator(yaml.safe_load(REGULATOR)["regulator"])
    known = [margins(true, regulator.regulator, amplitude) for amplitude in regulator.amplitudes]
    assert abs(gain["value"] - min(one.gain_margin for one in known)) < 4 * gain["std_error"]
    assert abs(phase["value"] - math.radians(min(one.phase_margin for one in known))) < 4 * phase["std_error"]
    slow = {"sheet.T": {"upper": 10, "unit": "ms"}}
    assert service.put(f"{API}/limits/kononykhin", json={"limits": slow}).status_code == 200
    assert "acceptance test NOT passed" in service.get(f"{API}/fits/{fit}/figures/acceptance-sheet.json").text
    limits = {"sheet.gain_margin": {"lower": 6, "unit": "dB"}, "sheet.phase_margin": {"lower": 30, "unit": "deg"}}
    assert service.put(f"{API}/limits/kononykhin", json={"limits": limits}).status_code == 200
    judged = {line["name"]: line for line in service.get(f"{API}/fits/{fit}/sheet").json()["lines"]}
    assert judged["gain_margin"]["outcome"] == ("inside" if gain["value"] > 6 else "outside")
    assert judged["phase_margin"]["lower"] == pytest.approx(math.radians(30))
    assert service.post(f"{API}/fits/{fit}/approve", json={"why": "margin"}).json()["current"]
    told = service.get(f"{API}/actuators/SIM-BENCH-0001/verdict").json()["reasons"]
    assert any("sheet.gain_margin" in one and "dB" in one for one in told)
    found = service.get(f"{API}/statistics", params={"parameter": "sheet.gain_margin", "model": "kononykhin"}).json()
    assert (found["n"], found["unit"]) == (1, "dB")
    service.post(f"{API}/fits/{fit}/withdraw")
    service.put(f"{API}/limits/kononykhin", json={"limits": {}})


@pytest.mark.parametrize(
    ("block", "code"),
    [
        ("{ki: 1}", "missing-field"),
        ("{kp: 8 mm}", "wrong-dimension"),
        ("{kp: -1}", "bad-regulator"),
        ("{kp: 8, kd: 1}", "unknown-key"),
        ("{kp: 8, amplitudes: 2 %}", "not-a-list"),
        ("{kp: 8, amplitudes: [0 %]}", "bad-amplitude"),
    ],
)
def test_a_regulator_that_cannot_be_read_is_refused(block: str, code: str) -> None:
    """With the field at fault."""
    with pytest.raises(Unusable) as refused:
        describe_regulator(yaml.safe_load(block))
    assert refused.value.code == code
    assert refused.value.where.startswith("regulator")


def test_the_command_shows_the_sheet_of_a_stored_fit(
    service: TestClient, fit: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In the units of the sheet, with the outcome that the line gives; exit status 1 where it does not pass."""
    monkeypatch.setattr("app.cli.sheet.request", lambda _, __, method, path: service.request(method, API + path))
    service.put(f"{API}/limits/kononykhin", json={"limits": {"sheet.T": {"upper": 10, "unit": "ms"}}})
    with pytest.raises(typer.Exit) as ended:
        show_sheet(fit)
    assert ended.value.exit_code == 1
    said = capsys.readouterr().out
    assert re.search(r"gain_margin +\d+\.\d+ +\d\.\d+ +dB", said)
    assert re.search(r"(?m)^T +\S+ +\S+ +ms +– +10 +FAIL", said)
    assert "SIM-BENCH-0001: fail" in said
    service.put(f"{API}/limits/kononykhin", json={"limits": {}})
