"""The latest diagnosis of each data set, kept for the next command."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from app.cli.last_diagnosis import KEPT, LAST, found_file, keep
from ident.diagnosis.result import Diagnosis, Verdict
from ident.errors import Unusable
from ident.matrix import Actuator, Matrix


@pytest.fixture(autouse=True)
def data(tmp_path, monkeypatch) -> Path:
    monkeypatch.setenv("SERVOIDENT_DATA", str(tmp_path))
    return tmp_path


def of(data_hash: str) -> Matrix:
    return Matrix(Actuator("A"), (), data_hash)


def kept(data_hash: str) -> bool:
    return keep(Diagnosis(candidates=(), verdict=Verdict(), data_hash=data_hash))


def test_it_is_that_of_the_very_data_and_a_file_of_this_name_comes_first(tmp_path, monkeypatch):
    assert kept("a1")
    assert found_file(Path(LAST), of("a1")).stem == "a1"
    with pytest.raises(Unusable, match="run `servoident diagnose` on them first"):
        found_file(Path(LAST), of("b2"))
    assert found_file(Path("D.json"), of("b2")) == Path("D.json")
    monkeypatch.chdir(tmp_path)
    Path(LAST).touch()
    assert found_file(Path(LAST), of("b2")) == Path(LAST)


def test_the_oldest_go(data):
    for number in range(KEPT + 3):
        kept(f"{number:03}")
        os.utime(data / "diagnoses" / f"{number:03}.json", (number, number))
    assert sorted(file.stem for file in (data / "diagnoses").iterdir()) == [f"{n:03}" for n in range(3, KEPT + 3)]


def test_where_nothing_can_be_kept_the_diagnosis_is_shown_all_the_same(data):
    (data / "diagnoses").write_text("a file where the folder should be")
    assert not kept("a1")
