"""The report as PDF says what the page says, and what it says is never markup."""

from __future__ import annotations

import json

import pytest
import typst

from app.report import paper
from app.report.blocks import Facts, Figure, Heading, Report, Table, Tables, Text
from app.report.content import content
from ident.diagnosis.result import Diagnosis
from ident.figures import look
from ident.figures.ladder import ladder
from ident.matrix import Actuator
from tests.app.report.test_report import DIAGNOSIS
from tests.residuals.conftest import compared

HOSTILE = '#panic("ran") $x$ *b* @none \\ <a> = 10⁻¹² √Pa τ ₐ'


@pytest.fixture(scope="module")
def report():
    base = compared("coulomb_friction")
    return content(base.matrix, base.fit, Diagnosis.from_json(DIAGNOSIS))


@pytest.mark.full
def test_the_whole_report_becomes_a_pdf_the_same_each_time(report):
    drawn = paper.typeset(report)
    assert drawn.startswith(b"%PDF-")
    assert drawn.rstrip().endswith(b"%%EOF")
    assert len(drawn) > 50_000
    assert paper.typeset(report) == drawn


def test_every_piece_reaches_the_paper(report, monkeypatch):
    seen = {}

    def compiled(source, **_):
        told = json.loads((source.parent / "report.json").read_text(encoding="utf-8"))
        seen.update(told, drawings=sorted(path.name for path in source.parent.glob("*.pdf")))
        return b""

    monkeypatch.setattr(typst, "compile", compiled)
    paper.typeset(report)
    assert [block["kind"] for block in seen["blocks"]] == [block.kind for block in report.blocks]
    assert seen["drawings"] == [
        "bode.pdf",
        "ladder.pdf",
        "residual-curve.pdf",
        "residual-map.pdf",
        "step.pdf",
        "time.pdf",
    ]
    assert "Dry friction is missing." in json.dumps(seen)


def test_what_a_report_says_is_not_run():
    small = Table((HOSTILE, HOSTILE), ((HOSTILE, "doubt"),), (0,), marked=1)
    chart = ladder([(HOSTILE, 0.1, None), ("b", 0.05, 0.06)], None, Actuator(HOSTILE), look("light"))
    figures = (Figure("a", HOSTILE, HOSTILE), Figure("b", chart, HOSTILE))
    texts = (Heading(HOSTILE), Heading(HOSTILE, 3), Text(HOSTILE, "verdict"), Text(HOSTILE, "faint"), Text(HOSTILE))
    pieces = (*texts, small, Tables((small,)), *figures, Facts(((HOSTILE, HOSTILE),)))
    assert paper.typeset(Report(HOSTILE, HOSTILE, pieces)).startswith(b"%PDF-")
