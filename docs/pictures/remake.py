"""Remake the pictures of the documentation: `python docs/pictures/remake.py` (about half a minute).

A test matrix is simulated with 0.5 % noise and identified; each figure is drawn as the page draws it.
"""

from __future__ import annotations

import struct
import tempfile
import zlib
from pathlib import Path

from ident.figures import figure, render
from ident.fit.identify import identify
from ident.fit.settings import Settings
from ident.readers import read_matrix
from ident.synthesis import simulate_matrix

HERE = Path(__file__).parent
PICTURES = {
    "bode": {"kp": [5, 10]},
    "time": {},
    "evolution": {},
    "sensitivity": {},
}  # fmt: skip


def main() -> None:
    """Simulate, identify, draw."""
    with tempfile.TemporaryDirectory() as folder:
        simulate_matrix(Path(folder) / "matrix", seconds=10, seed=1)
        matrix = read_matrix(Path(folder) / "matrix")
    fit = identify(matrix, Settings(seed=1))
    for name, options in PICTURES.items():
        (HERE / f"{name}.png").write_bytes(packed(render(figure(name, matrix, fit, "light", **options), "png")))


def packed(png: bytes) -> bytes:
    """The same picture at zlib's best compression, less than half the size."""
    kept, pixels, place = [], b"", 8
    while place < len(png):
        (length,) = struct.unpack(">I", png[place : place + 4])
        kind, body = png[place + 4 : place + 8], png[place + 8 : place + 8 + length]
        place += 12 + length
        if kind == b"IDAT":
            pixels += body
        else:
            kept.append((kind, body))
    kept.insert(-1, (b"IDAT", zlib.compress(zlib.decompress(pixels), 9)))
    chunks = (
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in kept
    )
    return png[:8] + b"".join(chunks)


if __name__ == "__main__":
    main()
