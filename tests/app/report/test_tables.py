"""Tables of a fit as CSV and XLSX, read back by a reader that knows nothing of what wrote them."""

from __future__ import annotations

import csv
import io
import zipfile
from xml.etree import ElementTree

import pytest
from python_calamine import load_workbook

from app.report.tables import tables
from app.report.workbook import as_csv, as_xlsx, as_zip
from ident.diagnosis.result import Diagnosis
from tests.app.report.test_report import DIAGNOSIS
from tests.residuals.conftest import compared

HOSTILE = {
    "name": '=HYPERLINK("x")',
    "text": 'a <b> & \u00e9, "quoted"\nnext',
    "number": -1.5e-12,
    "none": None,
    "truth": True,
    "infinite": float("inf"),
}


@pytest.fixture(scope="module")
def known():
    base = compared("coulomb_friction")
    return tables(base.matrix, base.fit, Diagnosis.from_json(DIAGNOSIS)), base


def test_every_table_is_read_back_from_the_workbook(known):
    found, base = known
    book = load_workbook(io.BytesIO(as_xlsx(found)))
    assert book.sheet_names == list(found)
    header, *rows = book.get_sheet_by_name("parameters").to_python()
    assert len(rows) == len(base.fit.parameters)
    value = header.index("value")
    assert [row[value] for row in rows] == [entry.value for entry in base.fit.parameters.values()]
    runs = book.get_sheet_by_name("runs").to_python()
    assert [row[runs[0].index("id")] for row in runs[1:]] == [run.id for run in base.matrix.runs]


def test_the_workbook_has_the_default_style_that_readers_ask_for(known):
    """Without it openpyxl, and pandas with it, warns and takes one of its own."""
    found, _ = known
    styles = ElementTree.fromstring(zipfile.ZipFile(io.BytesIO(as_xlsx(found))).read("xl/styles.xml"))
    (style,) = (part for part in styles.iter() if part.tag.endswith("}cellStyle"))
    assert (style.get("name"), style.get("builtinId")) == ("Normal", "0")


def test_every_table_is_read_back_from_its_csv_file(known):
    found, _ = known
    packed = zipfile.ZipFile(io.BytesIO(as_zip(found)))
    assert packed.namelist() == [f"{name}.csv" for name in found]
    for name, records in found.items():
        rows = list(csv.DictReader(io.StringIO(packed.read(f"{name}.csv").decode("utf-8-sig"))))
        assert len(rows) == len(records)
        for row, record in zip(rows, records, strict=True):
            for key, value in record.items():
                if isinstance(value, float):
                    assert float(row[key]) == value


def test_text_is_never_a_formula_and_numbers_are_numbers():
    (row,) = csv.DictReader(io.StringIO(as_csv([HOSTILE]).decode("utf-8-sig")))
    assert row["name"].startswith("'=")
    assert row["text"] == HOSTILE["text"]
    assert (float(row["number"]), row["none"], row["infinite"]) == (-1.5e-12, "", "")
    header, cells = load_workbook(io.BytesIO(as_xlsx({"t": [HOSTILE]}))).get_sheet_by_index(0).to_python()
    assert dict(zip(header, cells, strict=True)) == {**HOSTILE, "none": "", "infinite": ""}
    assert b"<f>" not in zipfile.ZipFile(io.BytesIO(as_xlsx({"t": [HOSTILE]}))).read("xl/worksheets/sheet1.xml")
