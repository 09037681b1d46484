"""What a notebook imports from the library, and what each of its rooms says of itself."""

from __future__ import annotations

import ast
import subprocess
import sys

import pytest

import ident
from tests.test_imports import ROOMS, ROOT


@pytest.mark.parametrize("name", ident.__all__)
def test_the_face_has_what_it_names(name):
    assert getattr(ident, name).__name__ == name
    assert not (ROOT / "ident" / f"{name}.py").exists()  # a file of that name would hide it


def test_the_face_says_what_it_has():
    with pytest.raises(AttributeError, match="it has Settings, check"):
        ident.simulator  # noqa: B018
    assert dir(ident) == sorted(ident.__all__)


def test_nothing_is_imported_before_it_is_used():
    code = "import ident, sys; assert 'numpy' not in sys.modules; ident.identify; assert 'numpy' in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)


@pytest.mark.parametrize("room", [room for room in ROOMS if (ROOT / "ident" / room).is_dir()])
def test_a_room_says_in_a_sentence_what_comes_in_and_what_goes_out(room):
    said = ast.get_docstring(ast.parse((ROOT / "ident" / room / "__init__.py").read_text(encoding="utf-8")))
    first = (said or "").split("\n\n")[0]
    assert " in, " in first or " in and " in first, first
    assert " out" in first, first
