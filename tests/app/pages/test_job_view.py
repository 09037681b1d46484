"""The page of a job that runs."""

from __future__ import annotations

import json

from app.tables import DiagnosisRow, JobRow
from tests.conftest import ROOT

VERDICT = "The model lacks a dead zone, and something is left."
STORED = json.loads((ROOT / "tests" / "stored" / "diagnosis.json").read_text(encoding="utf-8"))
FIRST = STORED | {"verdict": STORED["verdict"] | {"text": VERDICT}}


def test_the_verdict_of_the_catalogue_stands_on_the_page_while_terms_are_searched_for(service, fitted):
    """With the progress of the diagnosis; once, where what it gave is stored already."""
    matrix = service.get(f"/api/v1/fits/{fitted}").json()["matrix"]
    made = service.app.state.context.sessions
    with made.begin() as session:
        session.add(
            JobRow(
                id="searching",
                kind="diagnosis",
                matrix=matrix,
                parent=fitted,
                state="running",
                settings={},
                progress={"stage": "terms", "verdict": VERDICT},
            )
        )
    try:
        page = service.get(f"/fits/{fitted}").text
        assert page.count(VERDICT) == 1
        assert "data-verdict" in page
        with made.begin() as session:
            session.add(DiagnosisRow(id="searching", matrix=matrix, serial="SW-1", fit=fitted, result=FIRST))
        assert service.get(f"/fits/{fitted}").text.count(VERDICT) == 1
    finally:
        with made.begin() as session:
            for row in (session.get(DiagnosisRow, "searching"), session.get(JobRow, "searching")):
                if row is not None:
                    session.delete(row)
