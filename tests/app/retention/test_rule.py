"""The rule for raw runs: shown first; never those of a set in force, or of one that a regression rechecked."""

from __future__ import annotations

import os
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from app.tables import ApprovalRow, FitRow, JobRow, MatrixRow, RecheckRow, RegressionRow, SetRow, before
from tests.app.access.idle import idle
from tests.app.conftest import zipped
from tests.app.webhooks.world import RESULT
from tests.running import TOKEN

API = "/api/v1"
OLD, NEW = before(timedelta(days=40)), before(timedelta(days=20))
SERIALS = ("IN-FORCE", "SUPERSEDED", "UNAPPROVED", "RECHECKED", "LATELY", "YOUNG", "AT-WORK", "NO-SET")


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    """A service with a rule of 30 days and a matrix of each kind, all of it as if 40 days had passed."""
    folder: Path = tmp_path_factory.mktemp("retention")
    with idle(folder, keep_raw=30, rate=0) as client:
        client.headers["Authorization"] = f"Bearer {TOKEN}"
        made = {serial: upload(client, serial) for serial in SERIALS}
        with client.app.state.context.sessions.begin() as session:
            for serial, matrix in made.items():
                session.get_one(MatrixRow, matrix).created_at = OLD if serial != "YOUNG" else NEW
                if serial != "NO-SET":
                    row = FitRow(id=f"f-{serial}", matrix=matrix, serial=serial, model="qian2014", result=RESULT)
                    row.created_at = OLD
                    row.set = SetRow(serial=serial, model="qian2014", error_fit=0.01)
                    session.add(row)
            session.flush()
            for serial, until in (("IN-FORCE", None), ("SUPERSEDED", OLD), ("RECHECKED", OLD), ("LATELY", NEW)):
                number = session.scalar(select(SetRow.number).where(SetRow.serial == serial))
                session.add(ApprovalRow(serial=serial, number=number, since=OLD, until=until))
            session.add(RegressionRow(id="r", asked={}, tolerance=0.001))
            for serial, state in (("RECHECKED", "succeeded"), ("AT-WORK", "queued"), ("UNAPPROVED", "succeeded")):
                job = JobRow(id=f"j-{serial}", matrix=made[serial], state=state, settings={}, created_at=OLD)
                job.ended_at = OLD if state == "succeeded" else None
                session.add(job)
            session.flush()
            for serial in ("RECHECKED", "UNAPPROVED"):  # of which only the first one was ever in force
                session.add(RecheckRow(id=f"j-{serial}", regression="r", fit=f"f-{serial}", serial=serial))
        age(client, 40)
        yield client


def upload(lab: TestClient, serial: str) -> str:
    answer = lab.post(f"{API}/matrices", files={"files": ("m.zip", zipped(serial))})
    assert answer.status_code < 300, answer.text
    return str(answer.json()["id"])


def age(lab: TestClient, days: float) -> None:
    """Let every blob be as old."""
    for blob in list(lab.app.state.context.storage.blobs()):
        path = lab.app.state.context.storage.path(blob.sha256)
        os.utime(path, (blob.changed - 86_400 * days,) * 2)


def blobs(lab: TestClient) -> dict[str, int]:
    return {blob.sha256: blob.size for blob in lab.app.state.context.storage.blobs()}


def shown(lab: TestClient) -> dict[str, Any]:
    found: dict[str, Any] = lab.get(f"{API}/retention").json()
    return found


def test_what_goes_is_shown_then_removed_and_says_so(lab: TestClient) -> None:
    """Of a superseded set and of one that never was approved; the others stay, and so does what was found."""
    stored, found = blobs(lab), shown(lab)
    assert sorted((one["serial"], one["why"]) for one in found["items"]) == [
        ("SUPERSEDED", "superseded"),
        ("UNAPPROVED", "never approved"),
    ]
    assert (
        found["bytes"]
        == sum(one["bytes"] for one in found["items"])
        == sum(len(zipped(one["serial"])) for one in found["items"])
    )
    assert blobs(lab) == stored, "it is only shown"
    wrong = lab.post(f"{API}/retention", json={"digest": "0" * 64})
    assert (wrong.status_code, wrong.json()["code"]) == (409, "not-as-shown")
    assert (blobs(lab), shown(lab)) == (stored, found)

    done = lab.post(f"{API}/retention", json={"digest": found["digest"]})
    assert done.status_code == 200, done.text
    assert sum(stored.values()) - sum(blobs(lab).values()) == found["bytes"]
    line = lab.get(f"{API}/audit").json()["items"][0]
    assert (line["action"], line["object"]) == ("carry_out_retention", "retention")
    assert shown(lab)["items"] == []
    again = lab.post(f"{API}/retention", json={"digest": found["digest"]})
    assert again.json()["code"] == "not-as-shown"

    for one in found["items"]:
        matrix, fit = one["matrix"], f"f-{one['serial']}"
        view = lab.get(f"{API}/matrices/{matrix}").json()
        assert len(view["runs"]) == 9
        day = view["removed_at"][:10]
        for method, path, body in (
            ("GET", f"/matrices/{matrix}/description", None),
            ("GET", f"/fits/{fit}/compare", None),
            ("GET", f"/matrices/{matrix}/track", None),
            ("POST", "/fits", {"matrix": matrix}),
            ("POST", "/diagnoses", {"fit": fit}),
            ("POST", f"/matrices/{matrix}/revisions", {"actuator": {"notes": "x"}}),
        ):
            gone = lab.request(method, API + path, json=body)
            assert (gone.status_code, gone.json()["code"]) == (410, "removed-by-rule"), (path, gone.text)
            assert f"removed by the rule on {day}" in gone.json()["detail"]
        assert lab.get(f"{API}/fits/{fit}").json()["result"]["parameters"]
        page = lab.get(f"/matrices/{matrix}")
        assert "Raw data deleted by the retention rule" in page.text
        assert f"on {day}. Fits and results are kept." in page.text
        assert "data-start" not in page.text
        assert lab.get(f"/fits/{fit}").status_code == 200
        assert lab.get(f"/matrices/{matrix}/thumbnails/0.svg").status_code == 410


def test_the_same_upload_brings_them_back(lab: TestClient) -> None:
    """Under the same id, with what was found from them; they may go again when nobody has needed them for as long."""
    test_it_is_gone(lab)
    matrix = upload(lab, "SUPERSEDED")
    assert lab.get(f"{API}/matrices/{matrix}").json()["removed_at"] is None
    assert lab.get(f"{API}/matrices/{matrix}/description").status_code == 200
    found = shown(lab)
    assert [one["serial"] for one in found["items"]] == ["SUPERSEDED"]
    before_it = blobs(lab)
    assert lab.post(f"{API}/retention", json={"digest": found["digest"]}).status_code == 200
    assert blobs(lab) == before_it, "a blob that was stored in the last hour may be another upload's"


def test_it_is_gone(lab: TestClient) -> None:
    """Whatever other tests did before."""
    found = shown(lab)
    assert lab.post(f"{API}/retention", json={"digest": found["digest"]}).status_code == 200
    assert shown(lab)["items"] == []


def test_what_others_share_stays(lab: TestClient) -> None:
    """A revision has the raw bytes of its matrix: they go with the last of both."""
    test_it_is_gone(lab)
    first = upload(lab, "SHARED")
    second = lab.post(f"{API}/matrices/{first}/revisions", json={"actuator": {"notes": "mended"}}).json()["id"]
    with lab.app.state.context.sessions.begin() as session:
        session.get_one(MatrixRow, first).created_at = OLD
        session.add(
            FitRow(
                id="f-first",
                matrix=first,
                serial="SHARED",
                model="qian2014",
                result=RESULT,
                created_at=OLD,
                set=SetRow(serial="SHARED", model="qian2014"),
            )
        )
    age(lab, 40)
    (one,) = shown(lab)["items"]
    assert (one["matrix"], one["bytes"]) == (first, 0)
    assert lab.post(f"{API}/retention", json={"digest": shown(lab)["digest"]}).status_code == 200
    assert lab.get(f"{API}/matrices/{second}/track?run=none").json()["code"] != "removed-by-rule"
    assert lab.get(f"{API}/matrices/{second}/description").json()["actuator"]["notes"] == "mended"


def test_without_a_rule_nothing_goes(tmp_path: Path) -> None:
    with idle(tmp_path) as client:
        client.headers["Authorization"] = f"Bearer {TOKEN}"
        found = shown(client)
        assert (found["days"], found["items"], found["bytes"]) == (None, [], 0)
        refused = client.post(f"{API}/retention", json={"digest": found["digest"]})
        assert (refused.status_code, refused.json()["code"]) == (409, "no-rule")
        assert "all raw data are kept" in client.get("/retention").text
