"""What a careless or hostile user may send: each a folder to give the command line, or bytes to send over HTTP."""

from __future__ import annotations

import io
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
from pyarrow import parquet
from scipy.io import savemat

SAMPLES = 600
DESCRIPTION = """
actuator: {serial: BAD-1, piston_area: 497 mm^2}
runs:
  - id: run
    file: runs/run.npz
    sample_rate: 4096 Hz
    specimen: {mass: 1 kg, stiffness: 0 N/m, damping: 0 N*s/m}
    gain: 5
    channels: {command: {column: u, unit: mm}, displacement: {column: x, unit: mm}}
"""
Spoil = Callable[[Path], None]


def signals(samples: int = SAMPLES) -> dict[str, np.ndarray]:
    """A command and an answer that nothing is wrong with."""
    rng = np.random.default_rng(1)
    u = np.cumsum(rng.standard_normal(samples))
    return {"u": u, "x": np.convolve(u, np.ones(5) / 5, "same")}


def folder(path: Path) -> Path:
    """A sound matrix of one run."""
    (path / "runs").mkdir(parents=True)
    np.savez(path / "runs/run.npz", **signals())
    (path / "matrix.yaml").write_text(DESCRIPTION)
    return path


def said(old: str, new: str) -> Spoil:
    """The description with one phrase changed."""

    def spoil(path: Path) -> None:
        text = (path / "matrix.yaml").read_text()
        assert old in text
        (path / "matrix.yaml").write_text(text.replace(old, new))

    return spoil


def recorded(**columns: np.ndarray) -> Spoil:
    """Other samples."""
    return lambda path: np.savez(path / "runs/run.npz", **(signals() | columns))


def filed(name: str, write: Callable[[Path], object]) -> Spoil:
    """Another file than the npz."""

    def spoil(path: Path) -> None:
        said("runs/run.npz", f"runs/{name}")(path)
        write(path / "runs" / name)

    return spoil


def cut(name: str, write: Callable[[Path], object]) -> Spoil:
    """A file that ends half-way."""

    def spoil(path: Path) -> None:
        filed(name, write)(path)
        whole = (path / "runs" / name).read_bytes()
        (path / "runs" / name).write_bytes(whole[: len(whole) // 2])

    return spoil


def in_hdf5(make: Callable[[h5py.File], object]) -> Spoil:
    """An HDF5 file with something special as its x."""

    def write(path: Path) -> None:
        with h5py.File(path, "w") as file:
            file["u"] = signals()["u"]
            make(file)

    return filed("run.h5", write)


def _virtual(file: h5py.File) -> None:
    layout = h5py.VirtualLayout((SAMPLES,), "f8")
    layout[:] = h5py.VirtualSource("/etc/passwd", "x", (SAMPLES,))
    file.create_virtual_dataset("x", layout)


def _write_hdf5(path: Path) -> None:
    with h5py.File(path, "w") as file:
        for name, samples in signals().items():
            file[name] = samples


def _write_parquet(path: Path, samples: int = SAMPLES) -> None:
    parquet.write_table(pa.table(signals(samples)), path)


def _parquet_bomb(path: Path) -> None:
    zeros = pa.array(np.zeros(60_000_000))
    parquet.write_table(pa.table({"u": zeros, "x": zeros}), path, compression="zstd")


def _tdms(path: Path) -> None:
    path.write_bytes(b"TDSm" + struct.pack("<lLQQ", 0x0E, 4713, 1 << 40, 1 << 30))


def _declared(member: str, shape: str) -> bytes:
    """An npz whose member declares an array that is not there."""
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    body = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(f"{member}.npy", body)
    return buffer.getvalue()


def _npz_bomb(path: Path) -> None:
    (path / "runs/run.npz").write_bytes(_declared("u", "(9000000000,)"))


FOLDERS: dict[str, Spoil] = {
    "file that leaves the folder": said("runs/run.npz", "../../etc/passwd"),
    "absolute file": said("runs/run.npz", "/etc/passwd"),
    "YAML aliases": said("actuator:", "a: &a [1, 1]\nb: &b [*a, *a]\nc: [*b, *b]\nactuator:"),
    "HDF5 external link": in_hdf5(lambda file: file.__setitem__("x", h5py.ExternalLink("/etc/passwd", "/x"))),
    "HDF5 virtual dataset": in_hdf5(_virtual),
    "HDF5 bomb": in_hdf5(lambda file: file.create_dataset("x", (1 << 33,), "f8", compression="gzip", chunks=(4096,))),
    "npz bomb": _npz_bomb,
    "Parquet bomb": filed("run.parquet", _parquet_bomb),
    "missing file": said("runs/run.npz", "runs/none.npz"),
    "missing column": said("column: x", "column: y"),
    "missing unit": said("column: x, unit: mm", "column: x"),
    "unknown unit": said("column: x, unit: mm", "column: x, unit: cubit"),
    "wrong dimension": said("column: x, unit: mm", "column: x, unit: kg"),
    "quantity without unit": said("mass: 1 kg", "mass: 1"),
    "NaN": recorded(x=np.where(np.arange(SAMPLES) == 9, np.nan, signals()["x"])),
    "infinity": recorded(x=np.where(np.arange(SAMPLES) == 9, np.inf, signals()["x"])),
    "unequal lengths": recorded(x=signals()["x"][:-1]),
    "empty file": lambda path: (path / "runs/run.npz").write_bytes(b""),
    "one sample": recorded(u=np.ones(1), x=np.ones(1)),
    "zero variance": recorded(x=np.ones(SAMPLES)),
    "time that goes back": lambda path: (
        recorded(t=np.arange(SAMPLES)[::-1] / 4096)(path),
        said("sample_rate: 4096 Hz", "time: {column: t, unit: s}")(path),
    )[0],
    "negative mass": said("mass: 1 kg", "mass: -1 kg"),
    "Kp = 0": said("gain: 5", "gain: 0"),
    "object array": recorded(x=np.array([{"a": 1}] * SAMPLES, dtype=object)),
    "truncated MAT": cut("run.mat", lambda path: savemat(path, signals())),
    "truncated HDF5": cut("run.h5", _write_hdf5),
    "truncated Parquet": cut("run.parquet", _write_parquet),
    "truncated TDMS": filed("run.tdms", _tdms),
}
"""Folders, each with one fault."""


def _archive(*members: tuple[str | zipfile.ZipInfo, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, body in members:
            archive.writestr(name, body)
    return buffer.getvalue()


def _link(name: str, target: str) -> tuple[zipfile.ZipInfo, bytes]:
    info = zipfile.ZipInfo(name)
    info.external_attr = 0o120777 << 16
    return info, target.encode()


ARCHIVES: dict[str, bytes] = {
    "not a zip": b"this is no archive at all" * 40,
    "zip bomb": _archive(("matrix.yaml", DESCRIPTION.encode()), ("runs/run.csv", b"0,0\n" * 60_000_000)),
    "path traversal": _archive(("matrix.yaml", DESCRIPTION.encode()), ("../../evil.npz", b"x")),
    "symbolic link": _archive(("matrix.yaml", DESCRIPTION.encode()), _link("runs/run.npz", "/etc/passwd")),
}
"""Archives, each with one fault."""
