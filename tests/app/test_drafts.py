"""Raw files over HTTP: what they hold, what is missing, and the matrix that answers make of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ident.readers import read_matrix
from tests.app.conftest import unpacked
from tests.cases import CASES

API = "/api/v1"


def record(seed: int, head: str = "t,u,x") -> bytes:
    """A quarter of a second of a command, and of a response that lags it."""
    noise = np.random.default_rng(seed).normal(size=600)
    rows = np.column_stack([np.arange(600) / 2500, noise, 0.9 * np.roll(noise, 2)])
    return "\n".join([head, *(",".join(f"{value:.6f}" for value in row) for row in rows), ""]).encode()


@pytest.fixture
def draft(service) -> dict[str, object]:
    files = [("files", (f"raw/{name}.csv", record(seed))) for seed, name in enumerate(("a", "b", "c"))]
    answer = service.post(f"{API}/drafts", files=files)
    assert answer.status_code == 201, answer.text
    assert answer.headers["Location"] == f"{API}/drafts/{answer.json()['id']}"
    found: dict[str, object] = answer.json()
    return found


ANSWERS = {
    "serial": "RAW-1",
    "verify": ["c.csv"],
    "time": {"column": "t", "unit": "s"},
    "gain": "7",
    "channels": {"command": {"column": "u", "unit": "mm"}, "displacement": {"column": 2, "unit": "mm"}},
}


def test_a_draft_says_what_the_files_hold_and_what_is_missing(service, draft):
    """Asked again without an answer it says the same; with some, what is left."""
    assert [file["name"] for file in draft["files"]] == ["a.csv", "b.csv", "c.csv"]
    assert [(c["name"], c["role"]) for c in draft["files"][0]["columns"]] == [("t", "time"), ("u", ""), ("x", "")]
    assert {one["key"] for one in draft["missing"]} == {
        "serial",
        "channel command",
        "channel displacement",
        "unit time",
    }
    assert service.get(f"{API}/drafts/{draft['id']}").json() == draft
    some = service.post(f"{API}/drafts/{draft['id']}", json={"serial": "RAW-1", "time": {"column": "t", "unit": "s"}})
    assert {one["key"] for one in some.json()["missing"]} == {"channel command", "channel displacement"}
    assert not some.json()["description"]


def test_answers_make_a_matrix_as_an_upload_does(service, draft):
    """With the doubts of the check before; afterwards the draft is gone, and its files are the matrix's."""
    looked = service.post(f"{API}/drafts/{draft['id']}", json=ANSWERS).json()
    assert not looked["missing"]
    assert any(finding["code"] == "no-piston-area" for finding in looked["findings"])
    assert "unit: mm" in looked["description"]
    key = {"Idempotency-Key": "a draft"}
    made = [service.post(f"{API}/drafts/{draft['id']}/matrix", json=ANSWERS, headers=key) for _ in range(2)]
    assert [answer.status_code for answer in made] == [201, 201]
    matrix = service.get(made[0].headers["Location"]).json()
    assert [(run["id"], run["use"], run["gain"]) for run in matrix["runs"]] == [
        ("a", "fit", 7),
        ("b", "fit", 7),
        ("c", "verify", 7),
    ]
    assert {run["sample_rate"] for run in matrix["runs"]} == {2500}
    assert service.get(f"{API}/drafts/{draft['id']}").status_code == 404
    store = Path(service.app.state.context.storage.folder)
    assert not list(store.glob(f"staged-{draft['id']}"))


def test_the_same_files_and_answers_again_are_the_same_matrix(service):
    files = [("files", ("a.csv", record(9, "t [s],command [mm],position [mm]")))]
    found = []
    for status in (201, 200):
        draft = service.post(f"{API}/drafts", files=files).json()
        assert [one["key"] for one in draft["missing"]] == ["serial"]
        answer = service.post(f"{API}/drafts/{draft['id']}/matrix", json={"serial": "RAW-2"})
        assert answer.status_code == status
        found.append(answer.json()["id"])
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("files", "status", "code"),
    [
        ([("files", ("a.csv", b"\0\1\n\2"))], 422, "not-text"),
        ([("files", ("a.exe", b"MZ"))], 422, "unknown-type"),
        ([("files", ("x/a.csv", record(1))), ("files", ("y/a.csv", record(2)))], 422, "duplicate-file"),
    ],
)
def test_files_that_cannot_be_a_draft_are_refused_and_leave_nothing(service, files, status, code):
    store = Path(service.app.state.context.storage.folder)
    before = sorted(store.glob("staged-*"))
    answer = service.post(f"{API}/drafts", files=files)
    assert (answer.status_code, answer.json()["code"]) == (status, code), answer.text
    assert sorted(store.glob("staged-*")) == before


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"channels": {"command": {"column": "z", "unit": "mm"}}}, "missing-column"),
        ({"channels": {"motion": {"column": "u", "unit": "mm"}}}, "unknown-channel"),
        ({"serial": ""}, "not-stated"),
        ({"channels": {**ANSWERS["channels"], "displacement": {"column": "x", "unit": "N"}}}, "wrong-dimension"),
    ],
)
def test_answers_that_cannot_be_are_problems_and_the_draft_stays(service, draft, changes, code):
    answer = service.post(f"{API}/drafts/{draft['id']}/matrix", json=ANSWERS | changes)
    assert (answer.status_code, answer.json()["code"]) == (422, code), answer.text
    assert service.get(f"{API}/drafts/{draft['id']}").status_code == 200


def test_a_draft_that_is_not_there_is_missing(service):
    for name in ("nothing", "0" * 32, "staged", "%2e%2e"):
        assert service.post(f"{API}/drafts/{name}", json={}).status_code in (404, 405)
        assert service.get(f"{API}/drafts/{name}").status_code in (404, 405)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_files_of_any_form_are_one_matrix(service, case, tmp_path):
    """What is said of each file is of its own columns; the stored matrix has the samples and the clock of each."""
    sent = [("files", (path.name, path.read_bytes())) for path in case.paths()]
    draft = service.post(f"{API}/drafts", files=sent).json()
    said = {}
    for file in case.files:
        time, command, displacement = (
            {"column": column, "unit": unit} for column, unit in zip(file.columns, file.units, strict=True)
        )
        said[file.name] = {"channels": {"command": command, "displacement": displacement}, "time": time}
    answers = {"serial": f"CASE-{case.name}", "files": said}
    known = service.post(f"{API}/drafts/{draft['id']}", json=answers).json()
    assert not known["missing"]
    for file in known["files"]:
        assert {column["role"] for column in file["columns"]} == {"time", "command", "displacement"}
        assert file["channels"]["command"]["unit"] == "mm"
    assert all(file["time"]["unit"] in ("s", "ms") for file in known["files"])
    assert {one["code"] for one in known["findings"] if one["severity"] != "note"} == {"sample-rate", "no-verify-runs"}
    made = service.post(f"{API}/drafts/{draft['id']}/matrix", json=answers).json()
    described = service.get(f"{API}/matrices/{made['id']}/description").content
    content = {f"runs/{path.name}": path.read_bytes() for path in case.paths()}
    case.right(read_matrix(unpacked({"matrix.yaml": described, **content}, tmp_path)).runs)
    assert {run["sample_rate"] for run in made["runs"]} == {1000.0}


def test_an_answer_about_a_file_that_is_not_there_is_refused(service, draft):
    answer = service.post(f"{API}/drafts/{draft['id']}", json={"files": {"z.csv": {"rate": "1 kHz"}}})
    assert (answer.status_code, answer.json()["code"]) == (422, "missing-file")
    assert "a.csv, b.csv, c.csv" in answer.json()["remedy"]


def test_what_is_missing_of_some_files_names_them(service):
    """The page and a script can say to which files a question belongs."""
    files = [("files", ("a.csv", record(1))), ("files", ("b.csv", record(2, "clock,drive,way")))]
    draft = service.post(f"{API}/drafts", files=files).json()
    assert {(one["key"], *one["files"]) for one in draft["missing"]} == {
        ("serial",),
        ("channel command", "a.csv"),
        ("channel displacement", "a.csv"),
        ("unit time", "a.csv"),
        ("channel command", "b.csv"),
        ("channel displacement", "b.csv"),
        ("rate", "b.csv"),
    }


def test_a_text_is_read_in_the_dialect_that_is_stated_of_it(service):
    """What cannot be read as it is laid out shows its lines and asks; the description states what was stated."""
    draft = service.post(f"{API}/drafts", files=[("files", ("a.txt", b"words\nalone\n"))]).json()
    (file,) = draft["files"]
    assert (file["lines"][:2], file["columns"]) == (["words", "alone"], [])
    assert file["problem"] == "no column holds numbers throughout"
    assert [one["key"] for one in draft["missing"]] == ["serial", "dialect"]
    content = record(1).replace(b"t,u,x\n", b"t,u,x\n1,2,3\n1,2,3\n2,2,3\n")  # three lines of the instrument's ranges
    draft = service.post(f"{API}/drafts", files=[("files", ("a.txt", content))]).json()
    assert (draft["files"][0]["samples"], draft["files"][0]["dialect"]["header_rows"]) == (603, 1)
    answers = {**ANSWERS, "verify": [], "files": {"a.txt": {"dialect": {"header_rows": 4, "delimiter": "comma"}}}}
    found = service.post(f"{API}/drafts/{draft['id']}", json=answers).json()
    assert (found["files"][0]["samples"], found["files"][0]["columns"][0]["first"][:2]) == (600, [0.0, 0.0004])
    assert not found["missing"]
    assert "dialect: {delimiter: comma, header_rows: 4}" in found["description"]
    made = service.post(f"{API}/drafts/{draft['id']}/matrix", json=answers)
    assert (made.status_code, made.json()["runs"][0]["sample_rate"]) == (201, 2500)


@pytest.mark.parametrize(
    ("dialect", "code"),
    [
        ({"delimiter": "dot"}, "unknown-delimiter"),
        ({"decimal": ";"}, "unknown-decimal"),
        ({"encoding": "ebcdic"}, "unknown-encoding"),
        ({"header_rows": 99999}, "bad-rows"),
    ],
)
def test_a_dialect_that_is_none_is_refused_with_what_can_be_said(service, draft, dialect, code):
    answer = service.post(f"{API}/drafts/{draft['id']}", json={"dialect": dialect})
    assert (answer.status_code, answer.json()["code"]) == (422, code)
