"""What a notebook imports from the library, and what each of its rooms says of itself."""

from __future__ import annotations

import ast
import os
import subprocess
import sys

import numpy as np
import pytest

import ident
from tests.test_imports import ROOMS, ROOT


@pytest.mark.parametrize("name", ident.__all__)
def test_the_face_has_what_it_names(name):
    assert getattr(ident, name).__name__ == name
    assert not (ROOT / "ident" / f"{name}.py").exists()  # a file of that name would hide it


def test_the_face_says_what_it_has():
    with pytest.raises(AttributeError, match="it has Matrix, Settings"):
        ident.simulator  # noqa: B018
    assert dir(ident) == sorted(ident.__all__)


def test_a_notebook_may_still_call_the_makers_of_a_matrix_by_the_class():
    """As earlier versions had it; the class itself knows no reader, the face puts both together."""
    t = np.arange(64.0)
    given = {"sample_rate": "1 kHz", "units": {"command": "mm", "displacement": "mm"}}
    columns = {"command": t % 7, "displacement": t % 5}
    old, new = ident.Matrix.from_arrays(columns, **given), ident.from_arrays(columns, **given)
    assert old.data_hash == new.data_hash
    assert ident.Matrix.from_table is ident.from_table


READ = """
import sys, ident
assert "numpy" not in sys.modules  # nothing is imported before it is used
matrix = ident.read_matrix("run.csv", units={"command": "mm", "force": "kN"}, sample_rate="1 kHz", output="force")
assert matrix.runs[0].units == {"command": "m", "force": "N"}
heavy = {"altair", "h5py", "pint", "fastapi", "sqlalchemy", "scipy", "numba", "pandas"} & set(sys.modules)
assert not heavy, heavy
ident.identify
assert "altair" not in sys.modules
"""


def test_nothing_is_imported_before_it_is_used_and_a_record_is_read_without_figures_and_service(tmp_path):
    """Also not the library of units: a notebook has its data before its user looks up."""
    (tmp_path / "run.csv").write_text("command,force\n" + "".join(f"{n % 7},{n % 5}\n" for n in range(64)))
    subprocess.run([sys.executable, "-c", READ], check=True, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)})


@pytest.mark.parametrize("room", [room for room in ROOMS if (ROOT / "ident" / room).is_dir()])
def test_a_room_says_in_a_sentence_what_comes_in_and_what_goes_out(room):
    said = ast.get_docstring(ast.parse((ROOT / "ident" / room / "__init__.py").read_text(encoding="utf-8")))
    first = (said or "").split("\n\n")[0]
    assert " in, " in first or " in and " in first, first
    assert " out" in first, first
