"""Signals that MATLAB and Simulink save as objects, in files put together here from the layout that is documented."""

from __future__ import annotations

import struct
import zlib
from contextlib import suppress

import numpy as np
import pytest

from ident.drafts.raw_file import read_raw
from ident.errors import Unusable
from ident.readers import mat_objects
from ident.readers.limits import LIMITS
from ident.readers.mat import read_mat

STEP, COUNT = 0.01, 40
T = STEP * np.arange(COUNT)
VOLTS, SPEED = np.sign(np.sin(20 * T)), 3.0 + np.cos(7 * T)
DOUBLE, BYTES, WHOLE = (6, 9, "<f8"), (9, 2, "<u1"), (13, 6, "<u4")


def element(kind: int, data: bytes) -> bytes:
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def head(kind: int, shape: tuple[int, ...], name: str = "") -> bytes:
    lengths = element(5, struct.pack(f"<{len(shape)}i", *shape))
    return element(6, struct.pack("<II", kind, 0)) + lengths + element(1, name.encode())


def array(values: object, form: tuple[int, int, str] = DOUBLE, name: str = "") -> bytes:
    kind, stored, dtype = form
    numbers = np.atleast_2d(np.asarray(values, dtype=dtype))
    return element(14, head(kind, numbers.shape, name) + element(stored, numbers.tobytes(order="F")))


def text(words: str) -> bytes:
    return element(14, head(4, (1, len(words))) + element(16, words.encode()))


def cell(contents: list[bytes], name: str = "") -> bytes:
    return element(14, head(1, (len(contents), 1), name) + b"".join(contents))


def opaque(name: str, of_class: str, content: bytes) -> bytes:
    words = b"".join(element(1, each.encode()) for each in (name, "MCOS", of_class))
    return element(14, element(6, struct.pack("<II", 17, 0)) + words + content)


class Objects:
    """Objects as MATLAB stores them: a class and properties, each in a cell."""

    def __init__(self):
        self.names: list[str] = []
        self.classes: list[str] = []
        self.rows: list[tuple[int, list[tuple[int, int, int]]]] = []
        self.cells: list[bytes] = []

    def name(self, word: str) -> int:
        if word not in self.names:
            self.names.append(word)
        return self.names.index(word) + 1

    def add(self, of_class: str, **properties: bytes) -> bytes:
        """The reference to a new object."""
        if of_class not in self.classes:
            self.classes.append(of_class)
        rows = []
        for name, content in properties.items():
            rows.append((self.name(name), 1, len(self.cells)))
            self.cells.append(content)
        rows.append((self.name("Ready"), 2, 1))  # a property that stands in the table itself
        self.rows.append((self.classes.index(of_class) + 1, rows))
        number = len(self.rows)
        return array([[0xDD000000], [2], [1], [1], [number], [self.rows[-1][0]]], WHOLE)

    def behind(self) -> bytes:
        """The variable that stands behind the others."""
        of_classes = [(0, self.name(name), 0, 0) for name in self.classes]
        words = b"".join(word.encode() + b"\0" for word in self.names)
        names = words + bytes(-len(words) % 8)
        classes = b"".join(struct.pack("<4I", *row) for row in [(0, 0, 0, 0), *of_classes])
        saved = struct.pack("<II", 0, 0)
        numbered = enumerate(self.rows, 1)
        objects = b"".join(
            struct.pack("<6I", *row) for row in [(0,) * 6, *((kind, 0, 0, 0, n, n) for n, (kind, _) in numbered)]
        )
        plain = struct.pack("<II", 0, 0)
        for _, rows in self.rows:
            block = struct.pack("<I", len(rows)) + b"".join(struct.pack("<3I", *row) for row in rows)
            plain += block + bytes(-len(block) % 8)
        places = list(np.cumsum([40 + len(names), len(classes), len(saved), len(objects), len(plain)]))
        places += [places[-1]] * 3
        table = struct.pack("<10I", 4, len(self.names), *places) + names + classes + saved + objects + plain
        cells = [array([[byte] for byte in table], BYTES), array([[0]]), *self.cells]
        wrapper = opaque("", "FileWrapper__", cell(cells))
        fields = element(5, struct.pack("<i", 5)) + element(1, b"MCOS\0")
        within = b"\0\1IM\0\0\0\0" + element(14, head(2, (1, 1)) + fields + wrapper)
        return array([list(within)], BYTES)


def series(objects: Objects, data: bytes, unit: str = "", **clock: bytes) -> bytes:
    """A reference to a ``timeseries``."""
    info = objects.add("tsdata.timemetadata", **({"Length": array(COUNT), "Units": text("seconds")} | clock))
    told = objects.add("tsdata.datametadata", Units=text(unit))
    return objects.add("timeseries", Data_=data, TimeInfo=info, DataInfo=told, Name=text(""))


def file(*variables: bytes) -> bytes:
    """A v5 file, its variables compressed as MATLAB does."""
    packed = [zlib.compress(one) for one in variables]
    parts = b"".join(struct.pack("<II", 15, len(one)) + one for one in packed)
    return b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM" + parts


def column(values: np.ndarray) -> bytes:
    return array(values[:, None])


EVEN = {"Start_": array(0.0), "Increment_": array(STEP)}


def test_two_signals_of_one_clock_are_a_record_with_its_time_and_units():
    objects = Objects()
    volts, speed = (
        series(objects, column(VOLTS), "V", **EVEN),
        series(objects, column(SPEED), "rad/s", Time_=column(T)),
    )
    data = file(opaque("volts", "timeseries", volts), opaque("speed", "timeseries", speed), objects.behind())
    table = read_mat(data, "log.mat", LIMITS)
    assert table.names == ("time", "volts", "speed")
    assert table.units == ("s", "V", "rad/s")
    for found, wanted in zip(table.load([0, 1, 2]), (T, VOLTS, SPEED), strict=True):
        np.testing.assert_array_equal(found, wanted)
    assert [one.name for one in read_raw(data, "log.mat").columns] == ["time", "volts", "speed"]


def test_a_time_in_milliseconds_is_one_in_seconds():
    objects = Objects()
    clock = {"Start_": array(0.0), "Increment_": array(1e3 * STEP), "Units": text("milliseconds")}
    table = read_mat(
        file(opaque("u", "timeseries", series(objects, column(VOLTS), **clock)), objects.behind()), "f", LIMITS
    )
    np.testing.assert_allclose(table.load([0])[0], T, rtol=1e-12)


def test_signals_with_clocks_of_their_own_keep_them():
    objects = Objects()
    later = {"Start_": array(1.0), "Increment_": array(STEP)}
    one, other = series(objects, column(VOLTS), **EVEN), series(objects, column(SPEED), **later)
    data = file(opaque("u", "timeseries", one), opaque("x", "timeseries", other), objects.behind())
    assert read_mat(data, "f", LIMITS).names == ("u.time", "u", "x.time", "x")


def test_a_data_set_of_simulink_has_its_signals_by_their_names():
    """Signals within objects and cells; a frame has the time last."""
    objects = Objects()
    values = (
        series(objects, column(VOLTS), **EVEN),
        series(objects, array(np.array([SPEED, -SPEED])[:, None, :]), **EVEN),
    )
    signals = [
        objects.add("Simulink.SimulationData.Signal", Name=text(name), Values=value)
        for name, value in zip(("voltage", "speeds"), values, strict=True)
    ]
    logs = objects.add("Simulink.SimulationData.Dataset", Elements=cell(signals))
    table = read_mat(file(opaque("logs", "Simulink.SimulationData.Dataset", logs), objects.behind()), "f", LIMITS)
    assert table.names == ("time", "voltage", "speeds/0", "speeds/1")
    np.testing.assert_array_equal(table.load([3])[0], -SPEED)


def test_signals_in_a_structure_are_its_fields():
    objects = Objects()
    value = opaque("", "timeseries", series(objects, column(VOLTS), **EVEN))
    fields = element(5, struct.pack("<i", 8)) + element(1, b"voltage\0")
    run = element(14, head(2, (1, 1), "run") + fields + value)
    assert read_mat(file(run, objects.behind()), "f", LIMITS).names == ("time", "run.voltage")


@pytest.mark.parametrize("seed", range(30))
def test_a_damaged_table_of_objects_is_refused_or_read(seed):
    rng = np.random.default_rng(seed)
    objects = Objects()
    variable = opaque("u", "timeseries", series(objects, column(VOLTS), **EVEN))
    behind = bytearray(objects.behind())
    for place in rng.integers(80, len(behind), 5):
        behind[place] = rng.integers(256)
    with suppress(Unusable):
        table = read_mat(file(variable, bytes(behind)), "f", LIMITS)
        table.load(range(len(table.names)))


def test_objects_that_all_refer_to_all_are_looked_at_once():
    """Each way through forty of them to the depth of eight would be followed: more than there are seconds."""
    count = 40
    everyone = mat_objects.Reference(tuple(range(1, count + 1)))
    objects = mat_objects.Objects(
        ("p",), ("", "thing"), ((0, 0, 0), *[(1, 1, 0)] * count), ((), ((1, 1, 0),)), ((),), (None, None, everyone)
    )
    assert objects.properties(1) == {"p": everyone}
    assert list(objects.series(everyone, "x")) == []


def test_arrays_that_simulink_logged_are_a_record_with_their_time():
    """What ``sim`` returns holds them by their names; one of another length than their time is left out."""
    objects = Objects()
    contents = {"tout": column(T), "angle": column(SPEED), "inputU": column(VOLTS), "levels": array([[1.0], [2.0]])}
    words = [name.encode().ljust(8, b"\0") for name in contents]
    fields = element(5, struct.pack("<i", 8)) + element(1, b"".join(words))
    logged = element(14, head(2, (1, 1)) + fields + b"".join(contents.values()))
    out = objects.add("SimulationOutput", Data=logged)
    table = read_mat(file(opaque("out", "Simulink.SimulationOutput", out), objects.behind()), "log.mat", LIMITS)
    assert table.names == ("time", "angle", "inputU")
    assert table.units == ("s", "", "")
    for found, wanted in zip(table.load([0, 1, 2]), (T, SPEED, VOLTS), strict=True):
        np.testing.assert_array_equal(found, wanted)
