"""Ground motion of a hybrid simulation: a record from a text file, band-limited white noise, or a sine."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.readers.typed_fields import Fields
from ident.units.quantity import shown, unit_scale
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
GRAVITY = 9.80665  # m/s²
KEYS = (
    "kind", "file", "text", "name", "unit", "step", "scale", "column", "band", "frequency", "amplitude", "duration",
    "seed", "rest",
)  # fmt: skip
KINDS = ("record", "blwn", "sine")
_LARGEST, _LONGEST = 50_000_000, 4_000_000  # bytes of a record's file, samples of a motion
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?")


@dataclass(frozen=True)
class GroundMotion:
    """A ground acceleration, SI.

    `kind` "record": the numbers of `file` in rows, one after the other, each times `factor` (m/s² for one of the file's
    unit) and `scale`, `step` seconds apart, straight lines between them; `column` (0 is the first) takes one of several
    columns. Where `text` holds the rows, `file` is but their name. "blwn": white noise from `band[0]` to `band[1]` Hz
    with the RMS `amplitude` (m/s²), of `seed`. "sine": one of `frequency` Hz and peak `amplitude`. `duration` in s cuts
    a record short (None: all of it). It stands still for `rest` s before and after.
    """

    kind: str = "blwn"
    file: str = ""
    text: str = field(default="", repr=False)
    factor: float = GRAVITY
    step: float = 0.02
    scale: float = 1.0
    column: int | None = None
    band: tuple[float, float] = (0.0, 30.0)
    frequency: float = 1.0
    amplitude: float = 0.1 * GRAVITY
    duration: float | None = None
    seed: int = 0
    rest: float = 0.0

    @property
    def name(self) -> str:
        """What it is, in words."""
        if self.kind == "record":
            return f"{Path(self.file).name}{f' × {self.scale:g}' if self.scale != 1 else ''}"
        if self.kind == "sine":
            return f"sine of {self.frequency:g} Hz"
        return f"band-limited white noise {self.band[0]:g} to {self.band[1]:g} Hz"

    def samples(self, sample_rate: float) -> Array:
        """The acceleration (m/s²) at k/`sample_rate`, (n,). Raises Unusable where the file holds no record."""
        return np.pad(self._moving(sample_rate), round(self.rest * sample_rate))

    def _moving(self, sample_rate: float) -> Array:
        if self.kind == "record":
            values = self._rows() * (self.factor * self.scale)
            last = (len(values) - 1) * self.step
            seconds = last if self.duration is None else min(self.duration, last)
            count = _count(seconds, sample_rate)
            return np.interp(np.arange(count) / sample_rate, np.arange(len(values)) * self.step, values)
        count = _count(30.0 if self.duration is None else self.duration, sample_rate)
        fastest = self.frequency if self.kind == "sine" else self.band[1]
        if fastest > sample_rate / 2:
            raise Unusable(
                "bad-ground",
                f"{fastest:g} Hz cannot be sampled at {sample_rate:g} Hz",
                "ground",
                f"let it have at most {sample_rate / 2:g} Hz",
            )
        if self.kind == "sine":
            wave = np.sin(2 * np.pi * self.frequency * np.arange(count) / sample_rate)
            return np.asarray(self.amplitude * self.scale * wave)
        return self.scale * _white(count, self, sample_rate)

    def _rows(self) -> Array:
        """The record's own numbers, (r,)."""
        if self.text:
            return record_of(self.text, self.name, self.column)
        return read_record(Path(self.file), self.column)


def _count(seconds: float, sample_rate: float) -> int:
    count = round(seconds * sample_rate) + 1
    if not 16 <= count <= _LONGEST:
        raise Unusable(
            "bad-ground",
            f"{seconds:g} s at {sample_rate:g} Hz are {count} samples",
            "ground",
            f"let it have 16 to {_LONGEST} samples",
        )
    return count


def _white(count: int, of: GroundMotion, sample_rate: float) -> Array:
    """Noise whose spectrum is flat in the band and zero elsewhere, of exactly the RMS value asked for."""
    frequency = np.fft.rfftfreq(count, 1 / sample_rate)
    used = (frequency > 0) & (frequency >= of.band[0]) & (frequency <= of.band[1])
    if not used.any():
        raise Unusable(
            "bad-ground",
            f"no frequency of the motion is in {of.band[0]:g} to {of.band[1]:g} Hz",
            "ground band",
            "give a wider band or a longer duration",
        )
    rng = np.random.default_rng(of.seed)
    lines = np.zeros(len(frequency), dtype=complex)
    lines[used] = rng.standard_normal(used.sum()) + 1j * rng.standard_normal(used.sum())
    noise = np.fft.irfft(lines, count)
    return np.asarray(noise * (of.amplitude / np.sqrt(np.mean(noise**2))))


def read_record(path: Path, column: int | None = None) -> Array:
    """The numbers of a text file, as :func:`record_of`. Raises Unusable: ``no-such-file``, ``bad-ground``."""
    if not path.is_file() or path.stat().st_size > _LARGEST:
        remedy = did_you_mean(path.name, (kind for kind in KINDS if kind != "record"), "give its path")
        raise Unusable("no-such-file", "there is no such record of ground motion", str(path), remedy)
    return record_of(path.read_text(encoding="utf-8", errors="replace"), str(path), column)


def record_of(text: str, where: str, column: int | None = None) -> Array:
    """The numbers of a text, row by row, (r,); lines before the first row of numbers are a header.

    Raises Unusable: ``bad-ground`` where a later line holds something else, or a number is not finite, and where rows
    have several numbers of different count and one `column` is asked for.
    """
    rows: list[list[float]] = []
    for number, line in enumerate(text.splitlines(), 1):
        words = re.split(r"[\s,;]+", line.strip())
        if words == [""]:
            continue
        if all(_NUMBER.fullmatch(word) for word in words):
            rows.append([float(re.sub("[dD]", "e", word)) for word in words])
        elif rows:
            raise Unusable(
                "bad-ground",
                f"{shown(line)!r} is not a row of numbers",
                f"{where} line {number}",
                "leave numbers alone in the file",
            )
    if column is not None:
        if any(len(row) <= column for row in rows):
            raise Unusable("bad-ground", f"no column {column} in every row", where, "count columns from 0")
        rows = [[row[column]] for row in rows]
    values = np.array([value for row in rows for value in row])
    if len(values) < 2 or not np.isfinite(values).all():
        raise Unusable("bad-ground", "no record of finite numbers", where, "give a text file of numbers")
    return values


def ground_of(data: Any, base: Path | None, default: GroundMotion) -> GroundMotion:
    """The motion of a description; what a record's entry leaves out (unit, step) is that of `default`.

    `base` is the folder from which a file's name counts; without one no file is read, and a record is the `text` of the
    description, which its `name` names. Raises Unusable with the field.
    """
    fields = Fields(data, "ground", KEYS)
    kind = fields.choice("kind", KINDS, "record" if {"file", "text"} & set(fields.data) else "blwn")
    file, text = _record(fields, base)
    if kind == "record" and not (file or text):
        raise Unusable("missing-field", "there is no record", "ground", "give its file" if base else "give its text")
    factor = default.factor
    if "unit" in fields:
        factor = unit_scale(fields.text("unit"), "acceleration", "ground unit").factor
    scale = fields.number("scale")
    return GroundMotion(
        kind=kind,
        file=file,
        text=text,
        factor=factor,
        step=fields.positive("step", "time") or default.step,
        scale=1.0 if scale is None else scale,
        column=fields.whole("column") if "column" in fields else None,
        band=_band(fields, default),
        frequency=fields.positive("frequency", "frequency") or default.frequency,
        amplitude=_amplitude(fields, default),
        duration=fields.positive("duration", "time") or default.duration,
        seed=fields.whole("seed", default.seed),
        rest=default.rest if (rest := fields.not_negative("rest", "time")) is None else rest,
    )


def _record(fields: Fields, base: Path | None) -> tuple[str, str]:
    """The path of a record and "", or its name and its text."""
    file, text = fields.text("file"), fields.data.get("text") or ""
    if file and base is None:
        raise Unusable("no-file-here", "files cannot be named here", "ground file", "put the record itself into text")
    if not isinstance(text, str) or len(text) > _LARGEST or (text and file):
        raise Unusable("bad-ground", "not a text record, or not readable", "ground text", "give one of them")
    if text:
        return fields.text("name", "own record"), text
    return str(base / file) if base is not None and file else "", ""


def _amplitude(fields: Fields, default: GroundMotion) -> float:
    found = fields.not_negative("amplitude", "acceleration")
    return default.amplitude if found is None else found


def _band(fields: Fields, default: GroundMotion) -> tuple[float, float]:
    pair = fields.pair("band") if isinstance(fields.data.get("band"), list) else None
    if pair is None:
        top = fields.positive("band", "frequency") if "band" in fields else None
        return (0.0, top) if top else default.band
    ends: Mapping[str, Any] = {"from": pair[0], "to": pair[1]}
    both = Fields(ends, "ground band", ("from", "to"))
    return both.not_negative("from", "frequency") or 0.0, both.positive("to", "frequency") or default.band[1]
