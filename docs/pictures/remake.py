"""Remake the pictures of the documentation: `python docs/pictures/remake.py` (about half a minute).

A test matrix is simulated with 0.5 % noise and identified; each figure is drawn as the page draws it.
"""

from __future__ import annotations

import tempfile
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image

from ident.figures import render
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.readers import read_matrix
from ident.synthesis.matrix import simulate_matrix
from ident.workflows import figure, identify

HERE = Path(__file__).parent
PICTURES = {
    "bode": {"kp": [5, 10]},
    "time": {},
    "evolution": {},
    "sensitivity": {},
}


def main() -> None:
    """Simulate, identify, draw."""
    with tempfile.TemporaryDirectory() as folder:
        simulate_matrix(Path(folder) / "matrix", seconds=10, seed=1)
        matrix = read_matrix(Path(folder) / "matrix")
    fit = identify(matrix, Settings(seed=1))
    for name, options in PICTURES.items():
        draw(name, fit, name, **options)
    paper = identify(matrix, Settings(method="paper-ga", seed=1))
    draw("paper-evolution", paper, "evolution", generations=[1, 4, 8, 12])


def draw(picture: str, fit: FitResult, name: str, **options: Any) -> None:
    """A figure as a picture for light pages, and one for dark ones."""
    for theme, behind in (("light", ""), ("dark", "-dark")):
        chart = figure(fit, name, theme=theme, **options)
        (HERE / f"{picture}{behind}.png").write_bytes(packed(render(chart, "png")))


def packed(png: bytes) -> bytes:
    """The same picture in 256 colours, a third of the size."""
    small = BytesIO()
    Image.open(BytesIO(png)).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(small, "png", optimize=True)
    return small.getvalue()


if __name__ == "__main__":
    main()
