"""The service from Python: all that a notebook does with the library, over HTTP."""

from __future__ import annotations

import json
from contextlib import suppress

import httpx
import pytest

from app.backup.service import restore
from app.client import Client, Refused, start_command
from app.settings import Settings
from tests.app.conftest import files, unpacked, zipped
from tests.app.test_drafts import ANSWERS, record


@pytest.fixture
def lab(service):
    return Client("http://127.0.0.1:8000", http=service)


@pytest.mark.usefixtures("few_effects")
def test_from_an_upload_to_an_approved_set(lab, tmp_path):
    folder = unpacked(files("SW-CLIENT"), tmp_path / "m")
    (folder / ".hidden").write_text("stays here")
    matrix = lab.upload(folder)
    assert (matrix.serial, len(matrix.runs)) == ("SW-CLIENT", 9)
    assert lab.upload(folder / "matrix.yaml").id == matrix.id
    assert lab.matrix(matrix.id).findings == matrix.findings
    told = []
    fit = lab.fit(matrix.id, told.append, seed=3)
    assert fit.result.settings.seed == 3
    assert told[-1].state == "succeeded"
    assert {run.id for run in lab.compare(fit.id).runs} == {run.id for run in matrix.runs}
    assert lab.figure(fit.id, "bode", theme="dark").startswith(b"<svg")
    assert not list(lab.query(serial="SW-CLIENT", current=True))
    assert lab.approve(fit.id).current
    (current,) = lab.query(serial="SW-CLIENT", current=True)
    assert current.parameters["Z0"].value == fit.result.parameters["Z0"].value
    found = lab.diagnose(fit=fit.id, max_effects=0, propose=False)
    assert found.fit == fit.id
    assert lab.next_run(found.id).startswith(b"PK")


def test_the_line_asks_for_verdict_limits_statistics_and_approvals(lab, fitted):
    """Of a set that is approved with a reason, and withdrawn again."""
    lab.set_limits("qian2014", {"tau": {"upper": 9, "unit": "ms"}}, batch="B1")
    with suppress(Refused):  # another test may have approved it
        lab.withdraw(fitted)
    assert lab.approve(fitted, "bench 3").current
    try:
        (of_batch,) = [one for one in lab.limits("qian2014").batches if one.batch == "B1"]
        assert of_batch.limits["tau"].si_upper == pytest.approx(9e-3)
        verdict = lab.verdict("SW-1")
        assert (verdict.verdict, verdict.fit, verdict.judged[0].name) == ("pass", fitted, "tau")
        found = lab.statistics("tau", serial="SW-1")
        assert found.n >= 1
        assert found.unit == "s"
    finally:
        lab.set_limits("qian2014", {}, batch="B1")
        lab.withdraw(fitted, "leaks")
    newest, before = lab.approvals("SW-1")[:2]
    assert (newest.fit, newest.why, newest.until) == (None, "leaks", None)
    assert (before.fit, before.why, before.until) == (fitted, "bench 3", newest.since)
    assert lab.verdict("SW-1").verdict == "unknown"


def test_raw_files_become_a_matrix(lab, tmp_path):
    """By a draft: what is missing is said, then answered."""
    for seed, name in enumerate(("a.csv", "b.csv")):
        (tmp_path / name).write_bytes(record(seed))
    draft = lab.draft(tmp_path / "a.csv", tmp_path / "b.csv")
    assert {one.key for one in draft.missing} >= {"serial"}
    answers = ANSWERS | {"serial": "RAW-CLIENT", "verify": ["b.csv"]}
    assert lab.answer_draft(draft.id, **answers).missing == []
    assert lab.matrix_of_draft(draft.id, **answers).serial == "RAW-CLIENT"
    with pytest.raises(Refused, match="there is no draft"):
        lab.answer_draft(draft.id)


def test_a_backup_comes_as_a_file_that_is_restored(lab, fitted, tmp_path):
    """Whole, and nothing of it stays behind with the service; refused, there is no file."""
    assert fitted
    size = lab.backup(tmp_path / "all.backup")
    assert [file.name for file in tmp_path.iterdir()] == ["all.backup"]
    assert (tmp_path / "all.backup").stat().st_size == size
    held = restore(Settings(data=tmp_path / "new"), tmp_path / "all.backup")
    assert held.rows["fits"] >= 1
    here = lab.http.app.state.context.settings.data
    assert [file for file in here.iterdir() if file.name.startswith("backup-")] == []
    assert lab.request("GET", "/audit", params={"limit": 1}).json()["items"][0]["action"] == "take_backup"
    nobody = Client("http://127.0.0.1:8000", token="wrong", http=lab.http)
    with pytest.raises(Refused, match="no valid token"):
        nobody.backup(tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_a_fit_that_ran_out_of_its_time_is_not_approved(lab, matrix):
    fit = lab.fit(matrix, budget=1e-9)
    assert fit.result.ended_early
    with pytest.raises(Refused, match="ran out of its time; fit again without a budget"):
        lab.approve(fit.id)


def test_a_zip_is_sent_as_it_is(lab, tmp_path):
    (tmp_path / "m.zip").write_bytes(zipped())
    assert lab.upload(tmp_path / "m.zip").serial == "SW-1"


def test_what_is_refused_says_where_and_what_to_do(lab, tmp_path):
    with pytest.raises(Refused, match="there is no matrix") as raised:
        lab.fit("0" * 32)
    assert (raised.value.code, bool(raised.value.remedy)) == ("no-such-matrix", True)
    with pytest.raises(Refused, match=r"there is no matrix\.yaml; name a matrix folder"):
        lab.upload(tmp_path)
    nobody = Client("http://127.0.0.1:9", http=httpx.Client(transport=httpx.MockTransport(gone)))
    with pytest.raises(Refused, match="no answer from the service"):
        nobody.matrix("x")


@pytest.mark.parametrize(
    ("server", "command"),
    [
        ("http://127.0.0.1:9", "`servoident serve --port 9` on this machine"),
        ("http://bench-pc:8000", "`servoident serve --port 8000` on bench-pc"),
        ("https://bench-pc", "`servoident serve` on bench-pc"),
        ("http://bench-pc:port", "`servoident serve`"),
        ("bench-pc", "`servoident serve`"),
    ],
)
def test_of_a_service_that_does_not_answer_the_command_that_starts_it_is_said(server, command):
    assert start_command(server) == command


def gone(request):
    raise httpx.ConnectError("refused", request=request)


def job(state, problem=None):
    return {
        "id": "j", "kind": "fit", "state": state, "matrix": "m", "serial": "s", "settings": {}, "progress": {},
        "parent": None, "fit": "f", "diagnosis": None, "problem": problem, "created_at": "", "ended_at": None,
    }  # fmt: skip


class Broken(httpx.SyncByteStream):
    """A stream of events that breaks off after the first."""

    def __init__(self, event):
        self.event = event

    def __iter__(self):
        yield self.event
        raise httpx.ReadError("broken off")


def test_a_stream_that_breaks_off_is_taken_up_where_it_was():
    asked, told = [], []

    def answer(request):
        asked.append(request.headers.get("Last-Event-ID"))
        if len(asked) == 1:
            return httpx.Response(200, stream=Broken(f"id: 4\ndata: {json.dumps(job('running'))}\n\n".encode()))
        return httpx.Response(200, text=f"id: 5\ndata: {json.dumps(job('succeeded'))}\n\n")

    client = Client("http://lab", http=httpx.Client(transport=httpx.MockTransport(answer)))
    assert client.wait("j", told.append).fit == "f"
    assert asked == [None, "4"]
    assert [one.state for one in told] == ["running", "succeeded"]


def test_a_job_that_failed_is_its_reason():
    problem = {"code": "no-fit-runs", "detail": "every run is to verify", "where": "runs", "remedy": "mark one"}
    text = f"id: 1\ndata: {json.dumps(job('failed', problem))}\n\n"
    client = Client(http=httpx.Client(transport=httpx.MockTransport(lambda _: httpx.Response(200, text=text))))
    with pytest.raises(Refused, match="runs: every run is to verify; mark one"):
        client.wait("j")
