"""The objects of a v5 MAT file: signals that MATLAB and Simulink save as ``timeseries``, and arrays of a simulation.

A variable that is an object holds a reference alone. What it refers to stands behind the last variable, in an array of
bytes that is a MAT file of its own: a table of names, classes and objects, and a cell for the value of each property.

Source: the layout as the reader mat-io (F. Alva, MIT licence) documents it; MathWorks documents no more than the rest
of the file format (MAT-File Format, R2019b).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ident.readers.table import Array

REFERENCE = 0xDD000000
"""The first number of a reference to an object; its rank, its lengths, its objects and its class follow."""
_NAMES_AT = 40
"""Bytes before the names in the table: its version, their number, and eight places."""
_NO_VALUE, _IN_CELL, _FIRST_CELL = 0, 1, 2
"""How a property stands: by a name, in a cell, in the table itself; and the cell of the first value."""
_SERIES = "timeseries"
_SIMULATION, _OUTPUTS, _CLOCK = "SimulationOutput", "Data", "tout"
"""The output of a simulation, its property with the logged signals, and the one of these that is their time in s."""
_DEEPEST = 8
"""Objects within objects, as a signal in a data set of Simulink."""
_PER_SECOND = {"seconds": 1.0, "milliseconds": 1e-3, "microseconds": 1e-6, "minutes": 60.0, "hours": 3600.0}
"""Units of the time of a ``timeseries`` in s."""

Value = object
"""The value of a property: an array, a text, a tuple for a cell, a dict for a structure, a reference, or None."""


@dataclass(frozen=True)
class Series:
    """A signal: `data` (n,) or (n, m) at `time` (n,) s, with the unit that it states, or none."""

    name: str
    time: Array
    data: Array
    unit: str


@dataclass(frozen=True)
class Reference:
    """Numbers of objects in the table."""

    objects: tuple[int, ...]


@dataclass(frozen=True)
class Objects:
    """The table of objects, and the value of each property by its cell."""

    names: tuple[str, ...]
    classes: tuple[str, ...]
    objects: tuple[tuple[int, int, int], ...]
    saved: tuple[tuple[tuple[int, int, int], ...], ...]
    plain: tuple[tuple[tuple[int, int, int], ...], ...]
    cells: tuple[Value, ...]

    def properties(self, number: int) -> dict[str, Value]:
        """The properties of an object; nothing where the table has none of it."""
        if not 0 < number < len(self.objects):
            return {}
        _, saved, plain = self.objects[number]
        rows = self.saved[saved] if 0 < saved < len(self.saved) else ()
        rows += self.plain[plain] if 0 < plain < len(self.plain) else ()
        found: dict[str, Value] = {}
        for name, kind, value in rows:
            if 0 < name <= len(self.names) and kind == _IN_CELL and value + _FIRST_CELL < len(self.cells):
                found[self.names[name - 1]] = self.cells[value + _FIRST_CELL]
        return found

    def kind(self, number: int) -> str:
        """The class of an object, without its packages."""
        of_class = self.objects[number][0] if 0 < number < len(self.objects) else 0
        return self.classes[of_class] if 0 < of_class < len(self.classes) else ""

    def series(self, value: Value, name: str) -> Iterator[Series]:
        """Every signal that a value refers to, under `name`, or under its own where it is one of several.

        Each object is looked at once: in a file that was made to do harm, all may refer to all.
        """
        yield from self._series(value, name, _DEEPEST, set())

    def _series(self, value: Value, name: str, depth: int, seen: set[int]) -> Iterator[Series]:
        if not depth:
            return
        if isinstance(value, tuple):
            for number, each in enumerate(value):
                yield from self._series(each, f"{name}.{number}" if len(value) > 1 else name, depth - 1, seen)
        elif isinstance(value, dict):
            for field, each in value.items():
                yield from self._series(each, f"{name}.{field}", depth - 1, seen)
        elif isinstance(value, Reference):
            for number in value.objects:
                if number in seen:
                    continue
                seen.add(number)
                held = self.properties(number)
                own = held.get("Name")
                called = own if isinstance(own, str) and own and depth < _DEEPEST else name
                if self.kind(number) == _SERIES:
                    yield from self._signal(held, called)
                    continue
                if self.kind(number) == _SIMULATION:
                    yield from _logged_arrays(held.get(_OUTPUTS))
                for each in held.values():
                    yield from self._series(each, called, depth - 1, seen)

    def _signal(self, held: dict[str, Value], name: str) -> Iterator[Series]:
        """The signal of a ``timeseries``, whose data have the time first or last; nothing where one is missing."""
        clock, storage = self._part(held.get("TimeInfo")), self._part(held.get("Storage_"))
        places = (held.get("Data_"), held.get("Data"), storage.get("Data"))
        data = next((place for place in places if isinstance(place, np.ndarray) and place.size), None)
        if data is None:
            return
        length = _number(clock.get("Length"), float(max(data.shape, default=0)))
        time = next((t for t in (held.get("Time_"), clock.get("Time_")) if isinstance(t, np.ndarray) and t.size), None)
        if time is None:
            step = _number(clock.get("Increment_", clock.get("Increment")), float("nan"))
            time = _number(clock.get("Start_", clock.get("Start")), 0.0) + step * np.arange(_samples(length))
        rows = _by_time(data, time.size)
        units = clock.get("Units")
        if rows is not None and np.isfinite(time).all():
            seconds = time.ravel() * _PER_SECOND.get(units if isinstance(units, str) else "", 1.0)
            unit = self._part(held.get("DataInfo")).get("Units")
            yield Series(name, seconds, rows, unit if isinstance(unit, str) else "")

    def _part(self, value: Value) -> dict[str, Value]:
        """The properties of the one object that a value refers to."""
        return self.properties(value.objects[0]) if isinstance(value, Reference) and value.objects else {}


def _logged_arrays(outputs: Value) -> Iterator[Series]:
    """The arrays that Simulink logged, by their own names; those of another length than `tout` have no time."""
    time = outputs.get(_CLOCK) if isinstance(outputs, dict) else None
    if not isinstance(outputs, dict) or not isinstance(time, np.ndarray):
        return
    for field, values in outputs.items():
        rows = _by_time(values, time.size) if isinstance(values, np.ndarray) and field != _CLOCK else None
        if rows is not None:
            yield Series(field, time.ravel(), rows, "")


def _samples(length: float) -> int:
    """A number of samples that was stored as a real one; 0 where it is none."""
    return int(length) if 0 <= length < 2**31 else 0


def _number(value: Value, otherwise: float) -> float:
    """The only number of an array."""
    return float(value.ravel()[0]) if isinstance(value, np.ndarray) and value.size == 1 else otherwise


def _by_time(data: Array, count: int) -> Array | None:
    """The samples as rows (n,) or (n, m): a signal with the time last is turned round, as Simulink stores an array."""
    lengths = [length for length in data.shape if length != 1]
    if count < 2 or count not in lengths or len(lengths) > 2:
        return None
    kept = data.reshape(lengths, order="F")
    return kept if kept.shape[0] == count else kept.T


def reference(numbers: Array) -> Reference | None:
    """The objects that an array refers to; None where it is one of numbers."""
    flat = numbers.ravel()
    if flat.dtype.kind != "u" or flat.size < 6 or flat[0] != REFERENCE or flat.size < 3 + int(flat[1]):
        return None
    return Reference(tuple(int(number) for number in flat[2 + int(flat[1]) : -1]))


def objects_of(cells: tuple[Value, ...], order: str) -> Objects | None:
    """The table of objects from the cells behind the variables; None where they hold none that can be read."""
    head = cells[0] if cells else None
    if not isinstance(head, np.ndarray) or head.dtype.kind != "u" or head.size < _NAMES_AT:
        return None
    data = head.astype(np.uint8).tobytes()
    try:
        _, count, *places = struct.unpack(f"{order}10I", data[:_NAMES_AT])
        names = tuple(word.decode("utf-8", "replace") for word in data[_NAMES_AT : places[0]].split(b"\0")[:count])
        classes = [row[1] for row in _rows(data[places[0] : places[1]], 4, order)]
        objects = [(row[0], row[3], row[4]) for row in _rows(data[places[2] : places[3]], 6, order)]
        saved, plain = (_blocks(data[places[n] : places[n + 1]], order) for n in (1, 3))
    except (struct.error, IndexError):
        return None
    called = tuple(names[number - 1] if 0 < number <= len(names) else "" for number in classes)
    return Objects(names, called, tuple(objects), saved, plain, cells)


def _rows(data: bytes, width: int, order: str) -> list[tuple[int, ...]]:
    """The rows of `width` numbers of a part of the table."""
    size = 4 * width
    return [struct.unpack_from(f"{order}{width}I", data, at) for at in range(0, len(data) - size + 1, size)]


def _blocks(data: bytes, order: str) -> tuple[tuple[tuple[int, int, int], ...], ...]:
    """The properties of each object: their number, three numbers each, filled up to eight bytes. The first are none."""
    found: list[tuple[tuple[int, int, int], ...]] = []
    at = 0
    while at + 4 <= len(data):
        (count,) = struct.unpack_from(f"{order}I", data, at)
        end = at + 4 + 12 * count
        if end > len(data):
            break
        flat = struct.unpack_from(f"{order}{3 * count}I", data, at + 4)
        found.append(tuple((flat[n], flat[n + 1], flat[n + 2]) for n in range(0, 3 * count, 3)))
        at = end + -end % 8
    return tuple(found)
