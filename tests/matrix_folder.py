"""Small matrices of every file type, written with the libraries that laboratories use."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Columns = Mapping[str, NDArray[np.float64]]
Writer = Callable[[Path, Columns], None]

SAMPLES = 400


def write_text(path: Path, columns: Columns, delimiter: str = ",") -> None:
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, "%.17g", delimiter, header=delimiter.join(columns), comments="")


def write_tabs(path: Path, columns: Columns) -> None:
    write_text(path, columns, "\t")


def write_parquet(path: Path, columns: Columns) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    parquet.write_table(pa.table(dict(columns)), path)


def write_npz(path: Path, columns: Columns) -> None:
    np.savez_compressed(path, **dict(columns))


def write_mat(path: Path, columns: Columns) -> None:
    from scipy.io import savemat

    savemat(path, dict(columns), do_compression=True, oned_as="column")


def write_mat4(path: Path, columns: Columns) -> None:
    from scipy.io import savemat

    savemat(path, dict(columns), format="4", oned_as="column")


def packing(length: int) -> dict[str, object]:
    """Chunks with every filter, where there is enough to pack."""
    return {"chunks": (128,), "compression": "gzip", "shuffle": True, "fletcher32": True} if length > 128 else {}


def write_hdf5(path: Path, columns: Columns) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        for name, values in columns.items():
            file.create_dataset(name, data=values, **packing(len(values)))


def write_mat73(path: Path, columns: Columns) -> None:
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in columns.items():
            file.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
    head = b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM"
    with path.open("r+b") as raw:
        raw.write(head)


def write_tdms(path: Path, columns: Columns) -> None:
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(path) as writer:
        writer.write_segment([ChannelObject("bench", name, values) for name, values in columns.items()])


WRITERS: dict[str, tuple[str, Writer]] = {
    "csv": (".csv", write_text),
    "tsv": (".tsv", write_tabs),
    "txt": (".txt", write_tabs),
    "parquet": (".parquet", write_parquet),
    "npz": (".npz", write_npz),
    "mat5": (".mat", write_mat),
    "mat4": (".mat", write_mat4),
    "mat73": (".mat", write_mat73),
    "h5": (".h5", write_hdf5),
    "tdms": (".tdms", write_tdms),
}

DESCRIPTION = """\
actuator: {serial: SW-1, piston_area: 497 mm^2}
runs:
  - id: first
    file: runs/first.csv
    sample_rate: 1000 Hz
    specimen: {mass: 0.87 kg, stiffness: 36.3 kN/m, damping: 0 N*s/m}
    gain: 7
    amplitude: 0.05 in
    kind: blwn
    channels:
      command: {column: u, unit: mm}
      displacement: {column: x, unit: mm}
"""


def recorded() -> dict[str, NDArray[np.float64]]:
    """A command in mm and a response that lags it, with a time in s."""
    noise = np.random.default_rng(1).normal(size=SAMPLES)
    return {"t": np.arange(SAMPLES) / 1000, "u": noise, "x": 0.9 * np.roll(noise, 2)}


class MatrixFolder:
    """A matrix folder under test; text and columns may be changed before it is read."""

    def __init__(self, path: Path) -> None:
        self.path, self.columns, self.text = path, recorded(), DESCRIPTION
        (path / "runs").mkdir(parents=True)

    def change(self, old: str, new: str) -> MatrixFolder:
        assert old in self.text
        self.text = self.text.replace(old, new)
        return self

    def write(self, kind: str = "csv") -> Path:
        ending, writer = WRITERS[kind]
        self.text = self.text.replace("runs/first.csv", f"runs/first{ending}")
        self.path.joinpath("matrix.yaml").write_text(self.text)
        writer(self.path / f"runs/first{ending}", self.columns)
        return self.path

    def describe(self) -> Path:
        """Write matrix.yaml only."""
        self.path.joinpath("matrix.yaml").write_text(self.text)
        return self.path

    def pack(self, folder: str = "") -> Path:
        """The folder as an archive beside it, below `folder` in it."""
        archive = self.path.with_suffix(".zip")
        with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
            for file in sorted(self.path.rglob("*")):
                packed.write(file, folder + str(file.relative_to(self.path)))
        return archive
