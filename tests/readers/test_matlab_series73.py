"""Signals that MATLAB and Simulink save as objects in v7.3 files, put together here with h5py from their layout."""

from __future__ import annotations

import io
import struct
from contextlib import suppress

import h5py
import numpy as np
import pytest

from ident.drafts.raw_file import read_raw
from ident.errors import Unusable
from ident.readers.limits import LIMITS
from ident.readers.mat import read_mat

STEP, COUNT = 0.01, 40
T = STEP * np.arange(COUNT)
VOLTS, SPEED = np.sign(np.sin(20 * T)), 3.0 + np.cos(7 * T)
REFERENCE = 0xDD000000


class File:
    """A v7.3 file: what stands behind the variables lies in ``#refs#``, and ``#subsystem#/MCOS`` leads to it."""

    def __init__(self):
        self.bytes = io.BytesIO()
        self.file = h5py.File(self.bytes, "w")
        self.held = self.file.create_group("#refs#")
        self.names: list[str] = []
        self.classes: list[str] = []
        self.rows: list[tuple[int, list[tuple[int, int, int]]]] = []
        self.cells: list[h5py.Dataset] = []

    def put(self, values: object, dtype: str = "f8", of_class: str = "double") -> h5py.Dataset:
        """An array by MATLAB's order of the dimensions, which HDF5 has turned round."""
        array = np.atleast_2d(np.asarray(values, dtype)).T
        dataset = self.held.create_dataset(f"d{len(self.held)}", data=array)
        dataset.attrs["MATLAB_class"] = np.bytes_(of_class)
        return dataset

    def text(self, words: str) -> h5py.Dataset:
        return self.put([[ord(sign) for sign in words]], "u2", "char")

    def cell(self, contents: list[h5py.Dataset]) -> h5py.Dataset:
        dataset = self.held.create_dataset(f"d{len(self.held)}", (1, len(contents)), h5py.ref_dtype)
        dataset.attrs["MATLAB_class"] = np.bytes_("cell")
        for n, each in enumerate(contents):
            dataset[0, n] = each.ref
        return dataset

    def _name(self, word: str) -> int:
        if word not in self.names:
            self.names.append(word)
        return self.names.index(word) + 1

    def add(self, of_class: str, **properties: h5py.Dataset) -> h5py.Dataset:
        """The reference to a new object with these properties."""
        if of_class not in self.classes:
            self.classes.append(of_class)
        rows = []
        for name, content in properties.items():
            rows.append((self._name(name), 1, len(self.cells)))
            self.cells.append(content)
        self.rows.append((self.classes.index(of_class) + 1, rows))
        return self.put([[REFERENCE], [2], [1], [1], [len(self.rows)], [self.rows[-1][0]]], "u4", "uint32")

    def variable(self, name: str, of_class: str, of: h5py.Dataset) -> None:
        dataset = self.file.create_dataset(name, data=of[()])
        dataset.attrs["MATLAB_class"] = np.bytes_(of_class)
        dataset.attrs["MATLAB_object_decode"] = np.int32(3)

    def plain(self, name: str, values: np.ndarray) -> None:
        self.file.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = np.bytes_("double")

    def whole(self) -> bytes:
        """The bytes of the file, with the table of objects written."""
        of_classes = [(0, self._name(name), 0, 0) for name in self.classes]
        words = b"".join(word.encode() + b"\0" for word in self.names)
        names = words + bytes(-len(words) % 8)
        classes = b"".join(struct.pack("<4I", *row) for row in [(0, 0, 0, 0), *of_classes])
        saved = struct.pack("<II", 0, 0)
        numbered = enumerate(self.rows, 1)
        objects = b"".join(
            struct.pack("<6I", *row) for row in [(0,) * 6, *((kind, 0, 0, 0, n, n) for n, (kind, _) in numbered)]
        )
        own = struct.pack("<II", 0, 0)
        for _, rows in self.rows:
            block = struct.pack("<I", len(rows)) + b"".join(struct.pack("<3I", *row) for row in rows)
            own += block + bytes(-len(block) % 8)
        places = list(np.cumsum([40 + len(names), len(classes), len(saved), len(objects), len(own)]))
        places += [places[-1]] * 3
        table = struct.pack("<10I", 4, len(self.names), *places) + names + classes + saved + objects + own
        head = self.put([[byte] for byte in table], "u1", "uint8")
        empty = self.put([[0, 0]], "u8", "canonical empty")
        empty.attrs["MATLAB_empty"] = np.uint8(1)
        cells = [head, empty, *self.cells]
        behind = self.file.create_group("#subsystem#").create_dataset("MCOS", (1, len(cells)), h5py.ref_dtype)
        behind.attrs["MATLAB_class"] = np.bytes_("FileWrapper__")
        for n, each in enumerate(cells):
            behind[0, n] = each.ref
        self.file.close()
        return self.bytes.getvalue()


def series(
    file: File, unit: str = "", clock: dict[str, h5py.Dataset] | None = None, **data: h5py.Dataset
) -> h5py.Dataset:
    """A reference to a ``timeseries`` whose samples stand in a property of its own, or in a store of Simulink's."""
    even = {"Start_": file.put(0.0), "Increment_": file.put(STEP)}
    info = file.add("tsdata.timemetadata", **({"Length": file.put(COUNT)} | (even if clock is None else clock)))
    told = file.add("tsdata.datametadata", Units=file.text(unit))
    return file.add("timeseries", TimeInfo=info, DataInfo=told, **data)


def test_two_signals_of_one_clock_are_a_record_with_its_time_and_units():
    """In the order of their names, as HDF5 keeps them."""
    file = File()
    file.variable("volts", "timeseries", series(file, "V", Data_=file.put(VOLTS[:, None])))
    own = {"Time_": file.put(T[:, None])}
    file.variable("speed", "timeseries", series(file, "rad/s", own, Data_=file.put(SPEED[:, None])))
    data = file.whole()
    table = read_mat(data, "log.mat", LIMITS)
    assert (table.names, table.units) == (("time", "speed", "volts"), ("s", "rad/s", "V"))
    for found, wanted in zip(table.load([0, 1, 2]), (T, SPEED, VOLTS), strict=True):
        np.testing.assert_array_equal(found, wanted)
    assert [one.name for one in read_raw(data, "log.mat").columns] == ["time", "speed", "volts"]


def test_samples_in_a_store_of_their_own_are_those_of_the_signal():
    """What Simulink logs while it runs stands in an object behind the signal, a row for each channel."""
    file = File()
    store = file.add("Simulink.internal.StreamingStorage", Data=file.put(np.array([VOLTS, SPEED])))
    file.variable("data", "timeseries", series(file, Storage_=store))
    table = read_mat(file.whole(), "log.mat", LIMITS)
    assert table.names == ("time", "data/0", "data/1")
    np.testing.assert_array_equal(table.load([1, 2]), [VOLTS, SPEED])


def test_arrays_of_numbers_and_signals_of_a_data_set_stand_side_by_side():
    file = File()
    file.plain("offset", SPEED)
    values = series(file, "V", Data_=file.put(VOLTS[:, None]))
    signal = file.add("Simulink.SimulationData.Signal", Name=file.text("voltage"), Values=values)
    logs = file.add("Simulink.SimulationData.Dataset", Elements=file.cell([signal]))
    file.variable("logs", "Simulink.SimulationData.Dataset", logs)
    table = read_mat(file.whole(), "log.mat", LIMITS)
    assert table.names == ("offset", "time", "voltage")
    np.testing.assert_array_equal(table.load([0, 2]), [SPEED, VOLTS])


@pytest.mark.parametrize("seed", range(20))
def test_a_damaged_table_of_objects_is_refused_or_read(seed):
    rng = np.random.default_rng(seed)
    file = File()
    file.variable("u", "timeseries", series(file, Data_=file.put(VOLTS[:, None])))
    data = bytearray(file.whole())
    for place in rng.integers(512, len(data), 8):
        data[place] = rng.integers(256)
    with suppress(Unusable):
        table = read_mat(bytes(data), "f", LIMITS)
        table.load(range(len(table.names)))
