"""The latest diagnosis of each data set, kept on this machine for the next command: `--start last`, `--diagnosis last`.

A file each, named by the hash of the data, in the folder `diagnoses` of the data: a diagnosis of other data is never
taken, and what changed since has none.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.diagnosis.result import Diagnosis
    from ident.matrix import Matrix

LAST = "last"
"""What is given in place of a file."""
KEPT = 50
"""[files] That are kept at most, the latest. Why: one takes up to some megabytes.
Test: tests/cli/test_last_diagnosis.py"""


def keep(found: Diagnosis) -> bool:
    """Keep a diagnosis as the latest of its data; False where the folder cannot be written to."""
    from app.cli.output import write_json

    try:
        _folder().mkdir(mode=0o700, parents=True, exist_ok=True)
        write_json(found.to_json(), _file(found.data_hash))
        for old in sorted(_folder().glob("*.json"), key=lambda file: file.stat().st_mtime_ns)[:-KEPT]:
            old.unlink(missing_ok=True)
    except OSError:
        return False
    return True


def found_file(given: Path, matrix: Matrix) -> Path:
    """The file that is given, or that of the latest diagnosis of a matrix. Raises Unusable where there is none."""
    if str(given) != LAST or given.exists():
        return given
    if not (file := _file(matrix.data_hash)).is_file():
        raise Unusable(
            "no-last-diagnosis",
            "no diagnosis of these data is kept",
            LAST,
            "run `servoident diagnose` on them first, or name the file of a diagnosis",
        )
    return file


def _folder() -> Path:
    from app.settings import default_data

    return default_data() / "diagnoses"


def _file(data_hash: str) -> Path:
    return _folder() / f"{data_hash}.json"
