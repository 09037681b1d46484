"""The notebooks, executed: ``python -m docs.notebooks.execute`` keeps what came out, with pictures of the charts.

A notebook is run as it stands; what only the pictures need runs before its first cell and is not kept.
"""

from __future__ import annotations

import base64
import io
import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from nbclient import NotebookClient
from PIL import Image

HERE = Path(__file__).resolve().parent
NOTEBOOKS = tuple(sorted(HERE.glob("*.ipynb")))
_PICTURES = "import altair; altair.renderers.enable('png', ppi=96)"
_LONGEST = 600  # s of a cell


def executed(path: Path, folder: Path) -> nbformat.NotebookNode:
    """The notebook with what came out of it, run in a folder. Raises CellExecutionError where a cell fails."""
    notebook = nbformat.read(path, as_version=4)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(_PICTURES))
    os.environ["PYTHONPATH"] = os.pathsep.join([str(HERE.parents[1]), os.environ.get("PYTHONPATH", "")])
    client = NotebookClient(notebook, timeout=_LONGEST, kernel_name="python3", resources={"metadata": {"path": folder}})
    client.execute()
    del notebook.cells[0]
    for count, cell in enumerate((cell for cell in notebook.cells if cell.cell_type == "code"), 1):
        cell.execution_count = count
        cell.metadata = {}
        for output in cell.outputs:
            if "execution_count" in output:
                output.execution_count = count
            if len(output.get("data", {})) > 1:  # a table or a picture: its text, long, says no more
                output.data.pop("text/plain", None)
            if "image/png" in output.get("data", {}):
                output.data["image/png"] = small(output.data["image/png"])
    return notebook


def small(png: str) -> str:
    """A picture with 256 colours, which charts do not exceed by much."""
    out = io.BytesIO()
    Image.open(io.BytesIO(base64.b64decode(png))).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(
        out, "PNG", optimize=True
    )
    return base64.b64encode(out.getvalue()).decode()


def main(names: list[str]) -> None:
    """Execute the notebooks of these names, or all, in place."""
    for path in NOTEBOOKS:
        if not names or path.stem in names:
            with TemporaryDirectory() as folder:
                notebook = executed(path, Path(folder))
            notebook.metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
            nbformat.write(notebook, path)
            print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1:])
