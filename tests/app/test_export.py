"""The machine of a fit as a file, over HTTP."""

from __future__ import annotations

import io
import shutil
import zipfile

import pytest
import scipy.io

API = "/api/v1"
MOVED = {"mass": "0.87 kg", "stiffness": "36.3 kN/m", "gain": "7", "sample_rate": "2 kHz"}


def test_a_fit_is_exported_as_header_state_space_and_unit(service, fitted):
    """Each under a name to save it by; the header states what was asked for."""
    header = service.get(f"{API}/fits/{fitted}/export.h", params=MOVED)
    assert header.headers["Content-Disposition"] == 'attachment; filename="qian2014.h"'
    assert " *   k = 36300\n" in header.text
    assert "#define SERVOIDENT_SAMPLE_RATE 2000.0 " in header.text
    held = service.get(f"{API}/fits/{fitted}/export.mat", params={"gain": "2", "mass": ""}).content
    assert scipy.io.loadmat(io.BytesIO(held))["A"].shape[0] >= 4
    if shutil.which("gcc") or shutil.which("cc"):
        unit = service.get(f"{API}/fits/{fitted}/export.fmu").content
        assert "modelDescription.xml" in zipfile.ZipFile(io.BytesIO(unit)).namelist()


@pytest.mark.parametrize(
    ("path", "asked", "status", "code"),
    [
        ("export.exe", {}, 404, "no-such-format"),
        ("export.h", {"gain": "0"}, 422, "out-of-range"),
        ("export.h", {"mass": "3 m"}, 422, "wrong-dimension"),
        ("export.h", {"sample_rate": "fast"}, 422, "not-a-quantity"),
    ],
)
def test_what_cannot_be_exported_is_a_problem(service, fitted, path, asked, status, code):
    answer = service.get(f"{API}/fits/{fitted}/{path}", params=asked)
    assert answer.status_code == status, answer.text
    assert answer.json()["code"] == code
    assert service.get(f"{API}/fits/none/export.h").status_code == 404
