"""What an identified actuator is good for, over HTTP: controllers, hybrid simulations, what-if, tracking."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import pytest
import scipy.io
from fastapi.testclient import TestClient

from app.hybrid.work import HYBRID
from app.jobs import repository
from app.jobs.steps import Runs
from ident.fit.result import FitResult
from ident.hybrid.case import qian
from ident.hybrid.controller import SampledController
from ident.hybrid.ground_motion import GroundMotion
from ident.hybrid.hybrid_simulation import simulate_hybrid
from tests.app.conftest import archived
from tests.app.test_bad_inputs import kept, refused_by_service
from tests.app.test_diagnoses import ended
from tests.fit import rig

API = "/api/v1"
QUIET = "\n".join(["a header", *(f"{0.3 * np.sin(0.9 * k):.6f}" for k in range(120))])
RECORD = {"text": QUIET, "name": "Small shake", "unit": "m/s^2", "step": "0.01 s"}
STRUCTURE = {"mass": "87.5 kg", "stiffness": "87.5 kN/m", "damping": "3.5 kN*s/m"}
PHYSICAL = {"mass": "8.75 kg", "stiffness": "17.5 kN/m"}
OWN = {"structure": STRUCTURE, "physical": PHYSICAL, "gain": 2, "piston_area": "497 mm^2"}
FORMATS = (("json", b"{"), ("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF"))


@pytest.fixture(scope="module")
def controller(service: TestClient, fitted: str) -> dict[str, Any]:
    """A controller with two degrees of freedom for Qian's case."""
    body = {"fit": fitted, "case": "qian", "structure": "two-degree"}
    answer = service.post(f"{API}/controllers", json=body)
    assert answer.status_code == 201, answer.text
    assert answer.headers["Location"] == f"{API}/controllers/{answer.json()['id']}"
    found: dict[str, Any] = answer.json()
    return found


@pytest.fixture(scope="module")
def simulation(service: TestClient, fitted: str, controller: dict[str, Any]) -> dict[str, Any]:
    """A hybrid simulation of 1.19 s with it, and its map."""
    body = {"fit": fitted, "case": OWN, "ground": RECORD, "controller": controller["id"], "map": True}
    job = ended(service, service.post(f"{API}/hybrid-simulations", json=body))
    assert (job["kind"], job["state"], job["parent"], job["fit"]) == ("hybrid simulation", "succeeded", fitted, None), (
        job
    )
    assert job["settings"]["controller"] == controller["name"]
    assert (job["settings"]["ground"], job["hybrid_simulation"]) == ("Small shake", job["id"])
    assert job["progress"]["done"] == job["progress"]["total"] > 0
    found: dict[str, Any] = service.get(f"{API}/hybrid-simulations/{job['id']}").json()
    return found


def test_a_controller_is_kept_and_its_three_forms_are_one(service, controller, fitted):
    one = service.get(f"{API}/controllers/{controller['id']}.json")
    read = SampledController.from_json(one.json())
    assert "attachment" in one.headers["Content-Disposition"]
    assert one.json()["design"]["structure"] == "two-degree"
    assert controller["design"] == one.json()["design"]
    held = scipy.io.loadmat(io.BytesIO(service.get(f"{API}/controllers/{controller['id']}.mat").content))
    header = service.get(f"{API}/controllers/{controller['id']}.h").text
    for name in ("A", "B", "C", "D"):
        np.testing.assert_array_equal(held[name], getattr(read, name))
    assert f"{read.A[0, 0]:.17e}" in header
    listed = service.get(f"{API}/controllers", params={"fit": fitted}).json()["items"]
    assert [one["id"] for one in listed].count(controller["id"]) == 1
    assert {one["fit"] for one in listed} == {fitted}
    assert service.get(f"{API}/controllers", params={"fit": "none"}).json()["items"] == []
    for missing in (f"{controller['id']}.exe", "none.json", "none"):
        assert service.get(f"{API}/controllers/{missing}").status_code == 404


def test_the_same_key_makes_one_controller(service, fitted):
    body, headers = {"fit": fitted, "case": OWN}, {"Idempotency-Key": "a controller"}
    first, again = (service.post(f"{API}/controllers", json=body, headers=headers) for _ in range(2))
    assert first.json() == again.json()
    other = service.post(f"{API}/controllers", json=body | {"seed": 1}, headers=headers)
    refused_by_service(other, "key-in-use", 409)


def test_a_simulation_says_what_the_library_says(service, simulation, controller, fitted):
    """Record, case and controller come through HTTP, the queue and the database to the last digit."""
    fit = FitResult.from_json(service.get(f"{API}/fits/{fitted}").json()["result"])
    ground = GroundMotion("record", "Small shake", QUIET, factor=1.0, step=0.01)
    case = qian().__class__(**{**vars(qian()), "name": "own case", "ground": ground})
    acting = SampledController.from_json(service.get(f"{API}/controllers/{controller['id']}.json").json())
    expected = simulate_hybrid(fit, case, acting).to_json()
    assert expected["samples"] == 4875
    for name in expected.keys() - {"seconds", "command_rms", "largest_pole", "scores"}:
        assert simulation[name] == expected[name], name
    assert simulation["command_rms"] == pytest.approx(expected["command_rms"])
    assert simulation["scores"] == pytest.approx(expected["scores"])
    assert simulation["scores"]["reference_rms"] < simulation["without"]["scores"]["reference_rms"] / 10
    assert (simulation["fit"], simulation["controller_id"]) == (fitted, controller["id"])
    assert np.shape(simulation["map"]["stable"]) == (20, 20)


def test_every_figure_is_drawn(service, simulation, controller, fitted, matrix):
    """One in every format, the others, which are drawn by the same hand, each in one of them."""
    asked = {"asked": json.dumps({"gain": [2, 3]})}
    places = [(f"/hybrid-simulations/{simulation['id']}", name, {}) for name in simulation["figures"]]
    places += [(f"/controllers/{controller['id']}", "closed-loop", {})]
    places += [(f"/fits/{fitted}/what-if", name, asked) for name in ("response", "root-locus")]
    places += [(f"/matrices/{matrix}/track", "tracking", {})]
    assert simulation["figures"] == ["displacement", "response", "map"]
    for number, (place, name, query) in enumerate(places):
        for kind, start in FORMATS if not number else FORMATS[number % 4 :][:1]:
            answer = service.get(f"{API}{place}/figures/{name}.{kind}", params=query | {"theme": "dark"})
            assert answer.content.startswith(start), (place, name, kind, answer.text)
        assert service.get(f"{API}{place}/figures/none.svg").status_code == 404
        assert service.get(f"{API}{place}/figures/{name}.gif").status_code == 404
        refused_by_service(service.get(f"{API}{place}/figures/{name}.svg?theme=pink"), "unknown-theme")


@pytest.mark.full
def test_what_a_feedforward_is_worth_is_kept_and_drawn(service, tmp_path):
    """Of a rig of fifth order of which two parameters are fitted: limit, draws and their band; figure and page."""
    truth = rig.machine(0)
    folder = rig.written(tmp_path, truth, 0, seconds=3.0)
    archive = archived({path.name: path.read_bytes() for path in folder.iterdir()})
    matrix = service.post(f"{API}/matrices", files={"file": ("rig.zip", archive)}).json()["id"]
    few = {"population": 16, "generations": 3, "elite": 3}
    known = {name: value for name, value in truth._asdict().items() if name not in ("kep", "wn")}
    fit = ended(service, service.post(
        f"{API}/fits", json={"matrix": matrix, "model": "strano", "set": known, "options": few}
    ))  # fmt: skip
    assert fit["state"] == "succeeded", fit
    case = {
        "structure": {"mass": "20 t", "stiffness": "0.8 MN/m", "damping": {"ratio": "20 %"}},
        "physical": {"mass": "500 kg", "stiffness": "10 %"}, "gain": 100, "piston_area": "9050 mm^2",
        "supply_pressure": "210 bar",
        "ground": {"kind": "sine", "frequency": "0.8 Hz", "amplitude": "0.1 g", "duration": "2 s"},
    }  # fmt: skip
    body = {"fit": fit["id"], "case": case, "controller": "feedforward"}
    job = ended(service, service.post(f"{API}/hybrid-simulations", json=body))
    assert job["state"] == "succeeded", job
    found = service.get(f"{API}/hybrid-simulations/{job['id']}").json()
    assert found["figures"] == ["displacement", "response", "feedforward"]
    told = found["feedforward"]
    assert (told["draws"], told["gain"]) == (100, 100)
    assert told["limit"] > 200
    assert told["both_rms"] < told["feedback_rms"] / 20
    beside = ended(
        service, service.post(f"{API}/hybrid-simulations", json=body | {"isolator": {"stiffness": "1 MN/m"}})
    )
    unknown = service.get(f"{API}/hybrid-simulations/{beside['id']}").json()["feedforward"]
    assert unknown["both_rms"] > 2 * told["both_rms"]
    refused_by_service(
        service.post(f"{API}/hybrid-simulations", json=body | {"isolator": {"mass": "1 m"}}), "wrong-dimension"
    )
    drawn = service.get(f"{API}/hybrid-simulations/{job['id']}/figures/feedforward.svg")
    assert b"below the stability limit" in drawn.content
    assert "Effect of the feedforward" in service.get(f"/fits/{fit['id']}/use?simulation={job['id']}").text


def test_the_kept_record_shows_the_reference(service, simulation):
    """The figure of a stored simulation is of the displacements that were computed."""
    drawn = service.get(f"{API}/hybrid-simulations/{simulation['id']}/figures/displacement.json").json()
    curves = {row["s"] for row in drawn["datasets"]["whole"]}
    assert {f"measured, {simulation['controller']}", "measured, no controller"} <= curves
    largest = {s: max(abs(row["y"]) for row in drawn["datasets"]["whole"] if row["s"] == s) for s in curves}
    (reference,) = (size for s, size in largest.items() if s.startswith("reference"))
    followed = largest[f"measured, {simulation['controller']}"] / reference
    assert followed == pytest.approx(1, abs=simulation["scores"]["reference_peak"] + 0.01)


@pytest.mark.usefixtures("simulation")
def test_the_page_of_a_fit_counts_what_goes_with_it(service, fitted):
    assert "hybrid simulations: " in service.get(f"/fits/{fitted}").text


@pytest.mark.full
def test_other_motions_effects_and_controllers(service, fitted, controller):
    """Live compensation against noise, a controller's own JSON against a sine, with an effect switched on."""
    file = service.get(f"{API}/controllers/{controller['id']}.json").json()
    bodies = (
        {"controller": "kalman", "ground": {"kind": "blwn", "duration": "1 s", "seed": 3}},
        {"controller": file, "case": OWN | {"ground": {"kind": "sine", "frequency": "2 Hz", "duration": "1 s"}},
         "effects": ["coulomb_friction"], "set": {"dead_zone.half_width": "1 um"}, "spread": {"share": "20 %"},
         "before": {"gain": 1, "fit": fitted, "case": OWN}},
    )  # fmt: skip
    found = []
    for body in bodies:
        job = ended(service, service.post(f"{API}/hybrid-simulations", json={"fit": fitted} | body))
        assert job["state"] == "succeeded", job
        found.append(service.get(f"{API}/hybrid-simulations/{job['id']}").json())
    assert [one["controller"] for one in found] == ["kalman", controller["name"]]
    assert found[0]["map"] is None
    assert found[1]["ground"] == "sine of 2 Hz"
    assert found[1]["effects"]["dead_zone.half_width"] == 1e-6
    assert len(found[1]["effects"]) == 2
    assert found[0]["spread"] is None
    assert (found[1]["spread"]["spread"], found[1]["spread"]["draws"]) == ("± 20 % of each parameter", 100)
    assert found[1]["spread"]["quantities"]["tracking_rms"]["lower"] < found[1]["scores"]["tracking_rms"]
    listed = service.get(f"{API}/hybrid-simulations", params={"fit": fitted, "limit": 2}).json()
    assert [one["id"] for one in listed["items"]] == [found[1]["id"], found[0]["id"]]
    assert listed["next"]


def test_a_simulation_that_waits_can_be_cancelled(service, fitted):
    """It is a job as any other: of two the second is cancelled, and nothing is stored of it."""
    body = {"fit": fitted, "ground": {"kind": "blwn", "duration": "200 s"}}
    job = service.post(f"{API}/hybrid-simulations", json=body).json()["id"]
    service.delete(f"{API}/jobs/{job}")
    service.get(f"{API}/jobs/{job}/events")
    assert service.get(f"{API}/jobs/{job}").json()["state"] == "cancelled"
    assert service.get(f"{API}/hybrid-simulations/{job}").status_code == 404
    refused_by_service(service.post(f"{API}/jobs/{job}/conclude"), "not-a-diagnosis", 409)


def test_a_result_is_stored_once_and_one_that_cannot_be_ends_its_job(service, simulation, fitted, matrix):
    """As after a kill between the last step and its record."""
    context = service.app.state.context
    runs = Runs(context.sessions, context.storage, "here", HYBRID)
    held = {"result": {}, "without": None, "map": None, "records": ""}
    runs.take(simulation["id"]).store({"outcome": None, "state": held})
    assert service.get(f"{API}/hybrid-simulations/{simulation['id']}").json() == simulation
    with context.sessions.begin() as session:
        repository.add(session, "unstored", matrix, {"asked": {}}, fitted, HYBRID.name)
    runs.take("unstored").store({"outcome": None, "state": {**held, "result": object()}})
    assert service.get(f"{API}/jobs/unstored").json()["problem"]["code"] == "not-stored"
    assert service.get(f"{API}/hybrid-simulations/unstored").status_code == 404


RESIZED = {"set": {"area": "239 mm^2", "volume": 1e-4}, "fitted": {"volume": "0.2 L"}, "gain": [2, 3],
           "specimen": {"mass": "2.06 kg", "stiffness": 30650}}  # fmt: skip


def test_what_if_scales_what_is_resized(service, fitted):
    before = service.post(f"{API}/fits/{fitted}/what-if", json={}).json()
    answer = service.post(f"{API}/fits/{fitted}/what-if", json=RESIZED)
    assert answer.status_code == 200, answer.text
    after = answer.json()
    assert after["parameters"]["Z0"]["after"] == pytest.approx(after["parameters"]["Z0"]["before"] * 239 / 497)
    assert after["parameters"]["Ka"]["after"] == pytest.approx(after["parameters"]["Ka"]["before"] / 2)
    assert after["specimen"] == {"mass": 2.06, "stiffness": 30650.0, "damping": 0.0}
    assert [one["gain"] for one in after["responses"]] == [2.0, 3.0]
    assert before["parameters"]["Z0"]["after"] == before["parameters"]["Z0"]["before"]
    assert after["peak"] is None


@pytest.mark.full
def test_what_if_finds_the_change_that_makes_a_peak(service, fitted):
    found = service.post(f"{API}/fits/{fitted}/what-if", json=RESIZED | {"peak": "45 Hz"}).json()
    assert (found["peak"]["target"]["frequency"], len(found["with_peak"])) == (45.0, 2)
    for each in found["with_peak"]:
        assert each["stable"]
        assert any(abs(peak["frequency"] - 45) <= 2 for peak in each["peaks"])


def test_an_unstable_loop_is_said_to_be_so_with_its_cause(service, fitted):
    """Against the loop when it was stable, of the same fit or of another; an unknown one is a 404."""
    asked = {"gain": 200, "before": {"gain": 2, "fit": fitted}}
    found = service.post(f"{API}/fits/{fitted}/what-if", json=asked).json()
    assert found["state"] == "unstable"
    assert [cause["name"] for cause in found["stability"][0]["causes"]] == ["Kp"]
    refused_by_service(service.post(f"{API}/fits/{fitted}/what-if", json={"before": {"gain": 0}}), "bad-gain")
    strange = {"before": {"fit": "nothing"}}
    assert service.post(f"{API}/fits/{fitted}/what-if", json=strange).status_code == 404


def test_a_spread_is_stated_by_hand_or_by_sets(service, fitted):
    """Controller and what-if over ± 20 %; a serial number without three sets, and two ways at once, are not."""
    body = {"fit": fitted, "case": OWN, "spread": {"share": 0.2, "shares": {"tau": "5 %"}}}
    made = service.post(f"{API}/controllers", json=body).json()["design"]["robustness"]
    assert made["spread"] == "± 20 % of each parameter, tau ± 5 %"
    assert made["margins"]["gain"]["lower"] < made["margins"]["gain"]["value"] < made["margins"]["gain"]["upper"]
    found = service.post(f"{API}/fits/{fitted}/what-if", json={"gain": 2, "spread": {"share": "20 %"}}).json()
    assert found["spread"][0]["stable"] == 1.0
    page = service.get(f"/fits/{fitted}/use?ask=what-if&gain_from=2&spread.share=20+%25").text
    assert "Over ± 20 % of each parameter 100 % of 100 machines are stable at Kp = 2" in page
    for spread, code in (({"serial": "NOBODY"}, "too-few"), ({"batch": "x", "share": 0.1}, "bad-request"),
                         ({"shares": {"tua": 0.1}}, "unknown-parameter"), ({"share": 2}, "bad-value")):  # fmt: skip
        refused_by_service(service.post(f"{API}/fits/{fitted}/what-if", json={"spread": spread}), code)
    kalman = {"fit": fitted, "controller": "kalman", "spread": {"share": 0.2}}
    refused_by_service(service.post(f"{API}/hybrid-simulations", json=kalman), "bad-option")


def test_a_loop_that_no_controller_is_designed_for_names_its_cause(service, fitted):
    """A case at Kp = 200 against the same at 2: the error has mode, cause and remedy."""
    answer = service.post(
        f"{API}/controllers", json={"fit": fitted, "case": OWN | {"gain": 200}, "before": {"gain": 2}}
    )
    refused_by_service(answer, "unstable-plant")
    assert "the cause is the gain: gain of the position loop" in answer.json()["detail"]
    assert "gain Kp ×" in answer.json()["remedy"]


def test_a_gain_is_chosen(service, fitted):
    """A quantity that there is not is refused with the nearest."""
    asked = {"choose": {"quantity": "phase_margin", "value": 60}}
    found = service.post(f"{API}/fits/{fitted}/what-if", json=asked).json()
    assert found["chosen"]["quantities"]["phase_margin"]["value"] == pytest.approx(60, abs=0.1)
    refused_by_service(service.post(f"{API}/fits/{fitted}/what-if", json={"choose": {"quantity": "peek", "value": 1}}),
                       "unknown-quantity")  # fmt: skip


def test_a_run_is_followed(service, matrix):
    runs = [run["id"] for run in service.get(f"{API}/matrices/{matrix}").json()["runs"]]
    first = service.get(f"{API}/matrices/{matrix}/track").json()
    second = service.get(f"{API}/matrices/{matrix}/track", params={"run": runs[1], "noise": "0.1 mm"}).json()
    assert (first["run"], second["run"], second["noise"]["measurement"]) == (runs[0], runs[1], pytest.approx(1e-4))
    assert len(first["t"]) == len(first["tau"]) == len(first["std_gain"]) == 2048
    assert first["reason"]


BAD_CASES = [
    ("/etc/passwd", "no-such-case"),
    (OWN | {"ground": {"file": "/etc/passwd"}}, "no-file-here"),
    (OWN | {"ground": {"kind": "record"}}, "missing-field"),
    (OWN | {"ground": {"text": "x" * 2_000_001}}, "bad-ground"),
    (OWN | {"delay": 10**30}, "bad-case"),
    (OWN | {"structure": STRUCTURE | {"mass": "-1 kg", "damping": {"ratio": "5 %"}}}, "bad-case"),
    (OWN | {"gain": 1e300}, "bad-case"),
    (OWN | {"piston_area": "1e-300 m^2"}, "bad-case"),
    (OWN | {"surprise": 1}, "unknown-key"),
    ({"structure": {"mass": 1}, "physical": {}}, "missing-unit"),
]


@pytest.mark.parametrize(("case", "code"), BAD_CASES, ids=lambda value: str(value)[-40:])
def test_a_case_that_cannot_be_is_refused_and_no_file_is_read(service, fitted, case, code):
    before = kept(service)
    for place in ("controllers", "hybrid-simulations"):
        if place == "controllers" and "ground" in str(case) and "text" in str(case):
            continue  # a controller needs no motion
        refused_by_service(service.post(f"{API}/{place}", json={"fit": fitted, "case": case}), code)
    assert kept(service) == before


BAD_SIMULATIONS = [
    ({"controller": "/etc/passwd"}, 404, "no-such-controller"),
    ({"controller": {"A": "x"}}, 422, "bad-controller"),
    (
        {"controller": {"A": [], "B": [], "C": [[]], "D": [[1, 0]], "sample_rate": 4096, "name": "\n"}},
        422,
        "bad-controller",
    ),
    ({"controller": {"A": [], "B": [], "C": [[]], "D": [[1, 0]], "sample_rate": 1000}}, 422, "bad-controller"),
    ({"ground": "/etc/passwd"}, 422, "bad-ground"),
    ({"ground": {"text": "1\n2\nthree"}}, 422, "bad-ground"),
    ({"ground": {"file": "el_centro.txt"}}, 422, "invalid-request"),
    ({"ground": {"duration": "123 s"}, "map": True}, 422, "too-long"),
    ({"ground": {"duration": "1e9 s"}}, 422, "bad-ground"),
    ({"controller": "kalman", "map": True}, 422, "bad-option"),
    ({"effects": ["magic"]}, 422, "unknown-effect"),
    ({"set": {"dead_zone.half_width": "1 s"}}, 422, "wrong-dimension"),
    ({"fit": "none"}, 404, "no-such-fit"),
]


@pytest.mark.parametrize(("body", "status", "code"), BAD_SIMULATIONS, ids=lambda value: str(value)[:40])
def test_a_simulation_that_cannot_be_is_refused_and_nothing_is_kept(service, fitted, body, status, code):
    before = kept(service)
    answer = service.post(f"{API}/hybrid-simulations", json={"fit": fitted, "case": OWN} | body)
    refused_by_service(answer, code, status)
    assert kept(service) == before


BAD_CHANGES = [
    ({"set": {"width": 1}}, "unknown-parameter"),
    ({"set": {"area": "1 s"}}, "wrong-dimension"),
    ({"fitted": {"Z0": 1}}, "unknown-size"),
    ({"specimen": {"mass": "-1 kg"}}, "bad-number"),
    ({"gain": [3, 2]}, "bad-gain"),
    ({"tolerance": "2 Hz"}, "bad-request"),
    ({"peak": "-45 Hz"}, "bad-peak"),
    ({"set": {"area": 1e308}, "fitted": {}}, "out-of-range"),
    ({"peak": 45, "axes": [{"gain": 1, "lower": 2, "upper": 1}]}, "bad-axes"),
]


@pytest.mark.parametrize(("body", "code"), BAD_CHANGES, ids=lambda value: str(value)[:40])
def test_a_change_that_cannot_be_is_refused_in_both_its_forms(service, fitted, body, code):
    refused_by_service(service.post(f"{API}/fits/{fitted}/what-if", json=body), code)
    drawn = service.get(f"{API}/fits/{fitted}/what-if/figures/response.svg", params={"asked": json.dumps(body)})
    refused_by_service(drawn, code)


def test_a_figure_of_no_request_is_refused(service, fitted):
    for asked in ("{", '{"surprise": 1}', '{"gain": NaN}'):
        answer = service.get(f"{API}/fits/{fitted}/what-if/figures/response.svg", params={"asked": asked})
        refused_by_service(answer, "invalid-request")


def test_a_target_of_one_s_own_and_one_that_no_loop_can_be(service, fitted):
    body = {"fit": fitted, "target": {"numerator": [6e5], "denominator": [0.008, 20, 65, 1200], "roll_off": "2 kHz"}}
    answer = service.post(f"{API}/controllers", json=body | {"target": body["target"] | {"roll_off": "3000 rad/s"}})
    assert answer.status_code == 201, answer.text
    assert answer.json()["design"]["target"]["numerator"] == [6e5]
    for target, code in (
        ({"numerator": [1], "denominator": [1]}, "bad-target"),
        ({"numerator": [1], "denominator": [1, -1]}, "bad-target"),
    ):
        refused_by_service(service.post(f"{API}/controllers", json=body | {"target": target}), code)
    refused_by_service(service.post(f"{API}/controllers", json={"fit": fitted, "structure": "x"}), "unknown-structure")
    refused_by_service(service.post(f"{API}/controllers", json={"fit": "none"}), "no-such-fit", 404)
    late = {"fit": fitted, "case": OWN | {"delay": 65}}
    refused_by_service(service.post(f"{API}/controllers", json=late), "too-late")


@pytest.mark.full
def test_two_actuators_over_http_have_their_own_fits_and_controllers(service, fitted, controller):
    """A part with a stored controller, one with a stored fit: scores, figures of each, the map, and the page."""
    case = {
        "structure": {"mass": ["87.5 kg", "87.5 kg"], "damping": {"ratio": "5 %"},
                      "stiffness": {"matrix": [[175, -87.5], [-87.5, 87.5]], "unit": "kN/m"}},
        "physical": [{"name": "left", "storey": 1, "mass": "8 kg", "stiffness": "17.5 kN/m",
                      "controller": controller["id"]},
                     {"name": "right", "storey": 2, "stiffness": "10 kN/m", "gain": 5, "fit": fitted}],
        "gain": 2, "piston_area": "497 mm^2",
    }  # fmt: skip
    body = {"fit": fitted, "case": case, "ground": RECORD, "map": True}
    job = ended(service, service.post(f"{API}/hybrid-simulations", json=body))
    assert job["state"] == "succeeded", job
    found = service.get(f"{API}/hybrid-simulations/{job['id']}").json()
    assert [part["name"] for part in found["parts"]] == ["left", "right"]
    assert [part["controller"] for part in found["parts"]] == [controller["name"], "none"]
    assert found["scores"]["tracking_rms"] == max(part["scores"]["tracking_rms"] for part in found["parts"])
    assert len(found["without"]["parts"]) == 2
    assert found["figures"] == ["displacement", "response", "delay-map"]
    place = f"{API}/hybrid-simulations/{job['id']}/figures"
    drawn = [service.get(f"{place}/displacement.json", params=query).json() for query in ({}, {"part": "right"})]
    assert drawn[0]["datasets"] != drawn[1]["datasets"]
    assert service.get(f"{place}/delay-map.svg").content.startswith(b"<svg")
    refused_by_service(service.get(f"{place}/displacement.svg", params={"part": "middle"}), "unknown-part")
    page = service.get(f"/fits/{fitted}/use", params={"simulation": job["id"]}).text
    assert "Scores of each actuator" in page
    assert "part=right" in page
    part = {"fit": fitted, "case": case, "part": "left"}
    assert service.post(f"{API}/controllers", json=part).json()["case"] == "own case, left"
    refused_by_service(service.post(f"{API}/controllers", json={"fit": fitted, "case": case}), "several-parts")


@pytest.mark.full
def test_two_actuators_over_http_have_spread_isolator_and_cause(service, fitted):
    """An unstable beam with an isolator on one part, before at a lower gain, over 5 %; what cannot be is refused."""
    parts = [
        {"name": name, "storey": n, "mass": "8 kg", "stiffness": "17.5 kN/m"} for name, n in (("left", 1), ("b", 2))
    ]
    case = {
        "structure": {"mass": ["87.5 kg", "87.5 kg"], "damping": {"ratio": "5 %"},
                      "stiffness": {"matrix": [[175, -87.5], [-87.5, 87.5]], "unit": "kN/m"}},
        "physical": [parts[0] | {"gain": 90}, parts[1]], "gain": 16, "piston_area": "497 mm^2",
    }  # fmt: skip
    motion = {"kind": "blwn", "duration": "0.2 s"}
    body = {"fit": fitted, "case": case, "ground": motion, "spread": {"share": "5 %"}, "before": {"gain": 16},
            "isolator": {"stiffness": "1 kN/m"}, "isolator_part": "b"}  # fmt: skip
    job = ended(service, service.post(f"{API}/hybrid-simulations", json=body))
    assert job["state"] == "succeeded", job
    found = service.get(f"{API}/hybrid-simulations/{job['id']}").json()
    assert [one["name"] for one in found["stability"]["causes"]] == ["left.Kp"]
    assert found["spread"]["draws"] == 100
    assert found["spread"]["parts"].keys() == {"left", "b"}
    assert found["spread"]["quantities"]["gain_margin"]["value"] == pytest.approx(found["stability"]["gain_margin"])
    page = service.get(f"/fits/{fitted}/use", params={"simulation": job["id"]}).text
    assert "of 100 draws of the machines are stable" in page
    for change, code in (
        ({"isolator_part": "c"}, "unknown-part"), ({"controller": "kalman"}, "bad-option"),
        ({"before": {"case": OWN}}, "bad-case"), ({"spread": {"serial": "NOBODY"}}, "too-few"),
        ({"case": OWN}, "unknown-part"),
    ):  # fmt: skip
        refused_by_service(service.post(f"{API}/hybrid-simulations", json=body | change), code)


def test_a_shaking_table_over_http_has_its_acceleration(service, fitted):
    """A record as text, the command computed ahead: the spectrum, its figure and the rows of the page."""
    case = {"payload": {"mass": "8.75 kg"}, "band": ["0.5 Hz", "20 Hz"], "gain": 7, "piston_area": "497 mm^2"}
    body = {"fit": fitted, "case": case, "ground": RECORD, "controller": "feedforward"}
    job = ended(service, service.post(f"{API}/hybrid-simulations", json=body))
    assert job["state"] == "succeeded", job
    found = service.get(f"{API}/hybrid-simulations/{job['id']}").json()
    assert found["figures"] == ["displacement", "response", "acceleration"]
    assert abs(found["acceleration"]["worst"]) < 1.0 < abs(found["without"]["acceleration"]["worst"])
    figure = service.get(f"{API}/hybrid-simulations/{job['id']}/figures/acceleration.json").json()
    assert len(figure["datasets"]["levels"]) == 2 * len(found["acceleration"]["level"])
    page = service.get(f"/fits/{fitted}/use", params={"simulation": job["id"]}).text
    assert "Acceleration spectrum" in page
    address = f"{API}/hybrid-simulations/{job['id']}/command.csv"
    assert f'href="{address}"' in page
    rows = np.loadtxt(io.StringIO(service.get(address).text), delimiter=",", skiprows=1)
    assert len(rows) == found["samples"]
    assert np.allclose(rows[:, 0] * 4096, np.arange(len(rows)), atol=1e-4)
    assert np.std(rows[:, 1]) == pytest.approx(found["command_rms"], rel=0.02)
    refused_by_service(service.post(f"{API}/hybrid-simulations", json=body | {"map": True}), "bad-option")
