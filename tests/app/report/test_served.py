"""A data sheet and the tables of a stored fit over HTTP and from the command line."""

from __future__ import annotations

import io
import json
from dataclasses import replace

import pytest
from PIL import Image
from python_calamine import load_workbook

from app.client import Client


@pytest.fixture(scope="module")
def fit(service, matrix) -> str:
    """An approved fit."""
    lab = Client("http://127.0.0.1:8000", http=service)
    made = lab.fit(matrix, options={"population": 20, "generations": 2}).id
    lab.approve(made, "within the limits")
    return str(made)


def test_the_data_sheet_has_what_is_stated_what_is_stored_and_what_the_settings_say(service, fit, tmp_path):
    context = service.app.state.context
    Image.new("RGB", (60, 20)).save(tmp_path / "logo.png")
    settings = replace(context.settings, laboratory="Hall 2", logo=tmp_path / "logo.png")
    service.app.state.context = replace(context, settings=settings)
    try:
        page = service.get(f"/api/v1/fits/{fit}/report.html", params={"operator": "A. Kern", "date": ""}).text
    finally:
        service.app.state.context = context
    for said in ("<dd>Hall 2</dd>", "<dd>A. Kern</dd>", f"<dd>{fit} of 20", "within the limits", "data:image/png"):
        assert said in page
    refused = service.get(f"/api/v1/fits/{fit}/report.pdf", params={"date": "31.3.2026"})
    assert refused.status_code == 422
    assert "2026-03-31" in refused.text


def test_the_tables_of_a_fit_are_served_as_a_workbook_and_as_csv(service, fit):
    stored = service.get(f"/api/v1/fits/{fit}").json()["result"]["parameters"]
    book = load_workbook(io.BytesIO(service.get(f"/api/v1/fits/{fit}/tables.xlsx").content))
    assert {"parameters", "errors", "runs"} <= set(book.sheet_names)
    assert len(book.get_sheet_by_name("parameters").to_python()) == 1 + len(stored)
    assert service.get(f"/api/v1/fits/{fit}/tables.zip").content.startswith(b"PK")
    one = service.get(f"/api/v1/fits/{fit}/tables/parameters.csv")
    assert one.headers["content-type"].startswith("text/csv")
    assert len(one.text.splitlines()) == 1 + len(stored)
    assert service.get(f"/api/v1/fits/{fit}/tables/parameter.csv").status_code == 404
    page = service.get(f"/fits/{fit}").text
    assert f'href="/api/v1/fits/{fit}/tables.xlsx"' in page
    assert 'name="oil_temperature"' in page


@pytest.mark.full
def test_the_command_line_writes_the_same(service, servoident, fit, tmp_path):
    from tests.app.conftest import files, unpacked

    matrix = unpacked(files("SW-910D-0001"), tmp_path / "matrix")
    (tmp_path / "fit.json").write_text(json.dumps(service.get(f"/api/v1/fits/{fit}").json()["result"]))
    out = tmp_path / "sheet.html"
    done = servoident(
        "report",
        matrix,
        "--fit",
        tmp_path / "fit.json",
        "--out",
        out,
        "--operator",
        "A. Kern",
        "--oil-temperature",
        "42 degC",
    )
    assert done.returncode == 0, done.stderr
    assert "<dd>42.0 °C</dd>" in out.read_text(encoding="utf-8")
    done = servoident("report", matrix, "--fit", tmp_path / "fit.json", "--out", tmp_path / "tables.xlsx")
    assert done.returncode == 0, done.stderr
    assert "parameters" in load_workbook(io.BytesIO((tmp_path / "tables.xlsx").read_bytes())).sheet_names
