"""The notebooks of the documentation run, are short, and hold what came out of them."""

from __future__ import annotations

import ast
import base64

import nbformat
import pytest

from docs.notebooks.execute import NOTEBOOKS, executed

FEW = 15  # statements
BY_NAME = {path.stem: path for path in NOTEBOOKS}


def code(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def texts(notebook):
    """All that the outputs say, without the pictures."""
    outputs = [output for cell in code(notebook) for output in cell.outputs]
    return "\n".join(
        output.get("text") or output.data.get("text/html") or output.data.get("text/plain", "") for output in outputs
    )


@pytest.mark.full
@pytest.mark.parametrize("name", BY_NAME)
def test_a_notebook_runs_in_an_empty_folder(name, tmp_path):
    """Each cell, in a kernel of its own."""
    assert texts(executed(BY_NAME[name], tmp_path))


@pytest.mark.parametrize("name", BY_NAME)
def test_what_is_kept_is_small_whole_and_of_a_clean_run(name):
    notebook = nbformat.read(BY_NAME[name], as_version=4)
    assert BY_NAME[name].stat().st_size < 400_000
    assert [cell.execution_count for cell in code(notebook)] == list(range(1, len(code(notebook)) + 1))
    outputs = [output for cell in code(notebook) for output in cell.outputs]
    assert "error" not in {output.output_type for output in outputs}
    for output in outputs:
        if "image/png" in output.get("data", {}):
            assert base64.b64decode(output.data["image/png"]).startswith(b"\x89PNG")


def test_from_nothing_to_a_named_hidden_effect_in_few_statements():
    notebook = nbformat.read(BY_NAME["find-a-hidden-effect"], as_version=4)
    statements = ast.parse("\n".join(cell.source for cell in code(notebook))).body
    assert len(statements) <= FEW
    assert "The model lacks dead zone" in texts(notebook)
