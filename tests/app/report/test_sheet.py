"""The report as a data sheet: what is stated of the test, the approval, lines to be signed, and pages that are full."""

from __future__ import annotations

import io
import json
from dataclasses import replace

import numpy as np
import pytest
import typst
from PIL import Image

from app.report import paper
from app.report.content import content
from app.report.document import document
from app.report.sheet import Approval, Logo, Sheet, facts, logo
from ident.diagnosis.result import Diagnosis
from ident.errors import Unusable
from ident.readers.provenance_description import describe_test
from ident.rig.provenance import Provenance
from tests.app.report.test_report import DIAGNOSIS
from tests.residuals.conftest import compared

STATED = {"operator": "A. Kern <b>", "date": "2026-03-31", "oil_temperature": "42 degC"}
LEAST = 0.55  # of a page that is not the last: below, it is half empty


@pytest.fixture(scope="module")
def base():
    """A fit beside its data, whose data set names laboratory and operator."""
    found = compared("coulomb_friction")
    matrix = replace(found.matrix, test=Provenance(laboratory="Hydraulics 2", operator="nobody"))
    return replace(found, matrix=matrix)


@pytest.fixture(scope="module")
def picture(tmp_path_factory):
    """A logo as a file."""
    path = tmp_path_factory.mktemp("logo") / "logo.png"
    Image.new("RGB", (60, 20), "#005b94").save(path)
    return path


def test_what_is_stated_stands_over_what_the_data_set_says(base):
    approval = Approval("Lee", "2026-04-02T09:00", "as agreed")
    sheet = Sheet(fit="f1", fitted="2026-04-01T08:00", approval=approval).of(STATED)
    said = dict(facts(sheet, base.matrix, base.fit))
    assert said["Laboratory"] == "Hydraulics 2"
    assert said["Operator"] == "A. Kern <b>"
    assert said["Oil temperature"] == "42.0 °C"
    assert said["Date of the test"] == "2026-03-31"
    assert said["Fit"] == "f1 of 2026-04-01"
    assert said["Approval"] == "by Lee on 2026-04-02: as agreed"
    assert said["Serial number"] == base.matrix.actuator.serial


def test_a_temperature_that_was_recorded_is_that_of_the_oil(base):
    warm = replace(base.matrix.runs[0], channels={**base.matrix.runs[0].channels, "temperature": np.full(9, 313.15)})
    hot = replace(warm, channels={**warm.channels, "temperature": np.full(9, 318.15)})
    said = dict(facts(Sheet(), replace(base.matrix, runs=(warm, hot)), base.fit))
    assert said["Oil temperature"] == "40.0 to 45.0 °C"


@pytest.mark.parametrize(
    ("stated", "code"),
    [
        ({"date": "31.3.2026"}, "not-a-date"),
        ({"oil_temperature": "42"}, "missing-unit"),
        ({"oparator": "K"}, "unknown-key"),
    ],
)
def test_what_cannot_be_stated_is_refused(stated, code):
    with pytest.raises(Unusable) as refused:
        describe_test(stated)
    assert refused.value.code == code


def test_the_page_has_the_sheet_the_logo_and_the_lines_to_sign(base, picture):
    sheet = Sheet(logo=logo(picture), approval=Approval("Lee", "2026-04-02")).of(STATED)
    page = document(base.matrix, base.fit, None, sheet)
    assert '<img class="logo" src="data:image/png;base64,' in page
    assert "A. Kern &lt;b&gt;" in page
    assert "<b>" not in page
    for line in ("Tested", "Checked", "Approved"):
        assert f'<th scope="row">{line}</th>' in page
    assert '<th scope="row">Approved</th><td>Lee</td><td>2026-04-02</td>' in page
    assert "<dt>Customer</dt><dd>……" in page  # to be written by hand


def test_a_logo_that_is_no_picture_is_refused(tmp_path):
    for content_of in (b"<svg onload=alert(1)>", b"\x89PNG\r\n\x1a\n" + bytes(1 << 20)):
        (tmp_path / "logo.png").write_bytes(content_of)
        with pytest.raises(Unusable, match="PNG or JPEG"):
            logo(tmp_path / "logo.png")


@pytest.mark.full
def test_no_page_of_the_printed_report_is_half_empty(base, picture, monkeypatch):
    """But the last; as Typst draws the pages, from the first to the last line with ink above the foot."""
    compile_pdf, filled = typst.compile, []

    def pictured(source, **options):
        for content_of in compile_pdf(source, **{**options, "format": "png", "ppi": 30.0}):
            filled.append(inked(content_of))
        return b"%PDF-"

    monkeypatch.setattr(typst, "compile", pictured)
    sheet = Sheet(logo=Logo(picture.read_bytes(), "png", "image/png"))
    paper.typeset(content(base.matrix, base.fit, Diagnosis.from_json(json.loads(json.dumps(DIAGNOSIS))), sheet))
    assert len(filled) > 3
    assert min(filled[:-1]) > LEAST, [round(one, 2) for one in filled]


def inked(content_of: bytes) -> float:
    """How far down the page the last line with ink is, above the foot."""
    grey = np.asarray(Image.open(io.BytesIO(content_of)).convert("L"))
    body = grey[: round(0.93 * len(grey))]
    lines = np.flatnonzero((body < 200).any(axis=1))
    return float(lines[-1] / len(body))


def test_a_test_states_the_conditions_of_its_set(base):
    """Oil and cycles from the block `test`, the supply from its record before what is stated of the machine."""
    test = describe_test({"oil_temperature": "42 degC", "oil_age": "1200 h", "cycles": 2.1e6})
    run = replace(base.matrix.runs[0], channels={**base.matrix.runs[0].channels, "supply_pressure": np.full(9, 205e5)})
    machine = replace(base.matrix.actuator, supply_pressure=210e5)
    stated = replace(base.matrix, test=test, actuator=machine)
    known = {"temperature": 315.15, "supply_pressure": 210e5, "oil_age": 4.32e6, "cycles": 2.1e6}
    assert stated.conditions == pytest.approx(known)
    assert replace(stated, runs=(run,)).conditions == pytest.approx(known | {"supply_pressure": 205e5})
    assert replace(base.matrix, test=Provenance(cycles=0.0)).conditions["cycles"] == 0.0
