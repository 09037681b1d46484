"""Uploads of any size and kind of file, each new: drawn once, and told apart by a serial number."""

from __future__ import annotations

import io
import zipfile
from functools import lru_cache

import numpy as np
import pyarrow
from pyarrow import parquet

RUNS, RATE = 63, 4096
HEAD = "actuator: {serial: %s, batch: %s, piston_area: 497 mm^2}\nruns:\n"
RUN = """
  - id: r%(number)s
    file: runs/r%(number)s.%(kind)s
    sample_rate: 4096 Hz
    specimen: {mass: 9.95 kg, stiffness: %(stiffness)s N/m, damping: 0 N*s/m}
    gain: %(gain)s
    kind: blwn
    use: fit
    channels: {command: {column: command, unit: m}, displacement: {column: displacement, unit: m}}
"""


def arrays(seconds: float) -> int:
    """Bytes of the samples of an upload."""
    return int(RUNS * seconds * RATE) * 2 * 8


def upload(seconds: float, kind: str, serial: str, batch: str = "B-1") -> bytes:
    """An archive of 63 runs of so many seconds; `kind` is npz, parquet or csv."""
    buffer = io.BytesIO(_runs(seconds, kind))
    described = HEAD % (serial, batch)
    for number in range(RUNS):
        described += RUN % {
            "number": number,
            "kind": kind,
            "stiffness": 1e4 * (1 + number % 7),
            "gain": 2 + number // 7 * 0.5,
        }
    with zipfile.ZipFile(buffer, "a") as archive:
        archive.writestr("matrix.yaml", described)
    return buffer.getvalue()


@lru_cache(maxsize=3)
def _runs(seconds: float, kind: str) -> bytes:
    buffer = io.BytesIO()
    packing = zipfile.ZIP_DEFLATED if kind == "csv" else zipfile.ZIP_STORED
    with zipfile.ZipFile(buffer, "w", packing, compresslevel=1) as archive:
        for number in range(RUNS):
            archive.writestr(f"runs/r{number}.{kind}", _packed(kind, *_samples(seconds, number)))
    return buffer.getvalue()


def _samples(seconds: float, number: int) -> tuple[np.ndarray, np.ndarray]:
    """Noise up to 80 Hz, and the same late and a little smaller with 0.5 % of noise (m)."""
    draw = np.random.default_rng(number)
    spectrum = np.fft.rfft(draw.normal(size=int(seconds * RATE)))
    frequency = np.fft.rfftfreq(int(seconds * RATE), 1 / RATE)
    filtered = 3e-3 * np.sqrt(RATE / 160) * spectrum * (frequency < 80)
    late = filtered * np.exp(-2j * np.pi * frequency * 0.02) / (1 + 2j * np.pi * frequency * 0.003)
    command, displacement = (np.fft.irfft(each, int(seconds * RATE)) for each in (filtered, late))
    return command, displacement + 1.5e-5 * draw.normal(size=len(command))


def _packed(kind: str, command: np.ndarray, displacement: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    if kind == "npz":
        np.savez(buffer, command=command, displacement=displacement)
    elif kind == "parquet":
        parquet.write_table(pyarrow.table({"command": command, "displacement": displacement}), buffer)
    else:
        rows = np.column_stack([command, displacement])
        np.savetxt(buffer, rows, "%.9g", ",", header="command,displacement", comments="")
    return buffer.getvalue()
