"""Decimated levels of signals: the extremes of every 16, 256, … samples, in one file, so that a plot reads few of them.

The file: SIGN, the length of the head as 8 bytes, the head as JSON, then arrays of float32, little-endian, each at the
byte that the head says. Samples are stored as (x − mean)/scale, so that they keep 7 digits of their range.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ident.decimation.envelope import Real, envelope
from ident.run import Run, Samples

SIGN = b"servoident levels 1\n"
FACTOR = 16
"""Samples of a level in one of the next: the levels above the samples take 2/15 of their room."""
TOP = 512  # bins of the coarsest level, at most: as many as a panel has parts
_FLOAT = np.dtype("<f4")
_ALIGNED = 64  # bytes
Stored = NDArray[np.float32]


def write_levels(runs: Sequence[Run], file: BinaryIO) -> None:
    """Write the samples of all channels and their levels; channels that runs share are written once."""
    arrays: dict[int, tuple[int, Samples]] = {}
    named = {
        run.id: {name: arrays.setdefault(id(x), (len(arrays), x))[0] for name, x in run.channels.items()}
        for run in runs
    }
    entries: list[dict[str, Any]] = []
    at = 0
    for _, samples in arrays.values():
        mean = float(samples.mean())
        scale = max(float(samples.max()) - mean, mean - float(samples.min())) or 1.0
        entries.append({"length": len(samples), "mean": mean, "scale": scale, "at": []})
        for size in _sizes(len(samples)):
            entries[-1]["at"].append(at)
            at += -(-size * _FLOAT.itemsize // _ALIGNED) * _ALIGNED
    head = json.dumps({"runs": named, "arrays": entries}).encode()
    file.write(SIGN + len(head).to_bytes(8, "little") + head)
    file.write(b"\0" * (_begin(len(head)) - len(SIGN) - 8 - len(head)))
    for entry, (_, samples) in zip(entries, arrays.values(), strict=True):
        level = ((samples - entry["mean"]) / entry["scale"]).astype(_FLOAT)
        _write(level, file)
        low = high = level
        for _ in entry["at"][1:]:
            starts = np.arange(0, len(low), FACTOR)
            low, high = np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)
            _write(np.stack([low, high]), file)


def _write(values: Stored, file: BinaryIO) -> None:
    data = np.ascontiguousarray(values, _FLOAT).tobytes()
    file.write(data + b"\0" * (-len(data) % _ALIGNED))


def _sizes(samples: int) -> list[int]:
    """The numbers in each level of a channel, the samples first: of the others a lowest and a highest a bin."""
    sizes = [samples]
    bins = samples
    while bins > TOP:
        bins = -(-bins // FACTOR)
        sizes.append(2 * bins)
    return sizes


def _begin(head: int) -> int:
    """Where the arrays begin, behind a head of so many bytes."""
    return -(-(len(SIGN) + 8 + head) // _ALIGNED) * _ALIGNED


class Levels:
    """Stored levels, of which only what is asked for is read."""

    def __init__(self, path: Path) -> None:
        self._path = path

    @cached_property
    def _head(self) -> tuple[dict[str, Any], int]:
        with self._path.open("rb") as file:
            if file.read(len(SIGN)) != SIGN:
                raise ValueError(f"{self._path.name} holds no levels")
            length = int.from_bytes(file.read(8), "little")
            return json.loads(file.read(length)), _begin(length)

    def _level(self, run: str, channel: str, level: int) -> tuple[dict[str, Any], Stored]:
        """The entry of a channel, and one of its levels: samples (n,), or lowest and highest (2, bins)."""
        head, begin = self._head
        entry: dict[str, Any] = head["arrays"][head["runs"][run][channel]]
        size = _sizes(entry["length"])[level]
        shape = (size,) if level == 0 else (2, size // 2)
        stored = np.memmap(self._path, _FLOAT, "r", begin + entry["at"][level], shape)
        return entry, stored

    def length(self, run: str) -> int:
        """The number of samples of a run."""
        head, _ = self._head
        first = next(iter(head["runs"][run].values()))
        return int(head["arrays"][first]["length"])

    def samples(self, run: str, channel: str) -> Samples:
        """All samples of a channel (SI), to 7 digits of their range."""
        entry, stored = self._level(run, channel, 0)
        found: Samples = stored.astype(np.float64) * entry["scale"] + entry["mean"]
        return found

    def envelope(self, run: str, channel: str, begin: int, end: int, bins: int) -> tuple[Real, Real]:
        """The extremes of each of `bins` parts of samples [begin, end), from the coarsest level that is fine enough.

        Sample numbers, exact to half of a bin of that level, which is no wider than a part; and values (SI).
        """
        entry, samples = self._level(run, channel, 0)
        level = 0
        while FACTOR ** (level + 1) * bins <= end - begin and level + 1 < len(entry["at"]):
            level += 1
        if level == 0:
            part = samples[begin:end]
            places = envelope(part, bins)
            numbers, values = begin + places.astype(float), part[places].astype(np.float64)
        else:
            numbers, values = self._of_bins(run, channel, level, (begin, end), bins)
        return numbers, values * entry["scale"] + entry["mean"]

    def _of_bins(self, run: str, channel: str, level: int, of: tuple[int, int], parts: int) -> tuple[Real, Real]:
        """Of each part the lowest of all lowest and the highest of all highest, in the middles of their bins."""
        middles, low, high = self._bins(run, channel, level, *of)
        edges = np.linspace(0, len(middles), parts + 1).astype(np.intp)
        pairs = [(a, b) for a, b in pairwise(edges) if a < b]
        lowest = [a + int(np.argmin(low[a:b])) for a, b in pairs]
        highest = [a + int(np.argmax(high[a:b])) for a, b in pairs]
        ends = [of[0], of[1] - 1]
        numbers = np.concatenate([middles[lowest], middles[highest], ends])
        values = np.concatenate([low[lowest], high[highest], self._level(run, channel, 0)[1][ends]])
        order = np.argsort(numbers, kind="stable")
        return np.asarray(numbers[order], float), np.asarray(values[order], float)

    def _bins(self, run: str, channel: str, level: int, begin: int, end: int) -> tuple[Real, Real, Real]:
        """Middles, lowest and highest of bins; what is before the first whole one and behind the last is one each."""
        width = FACTOR**level
        samples, stored = self._level(run, channel, 0)[1], self._level(run, channel, level)[1]
        first, last = -(-begin // width), end // width
        whole = np.vstack([(np.arange(first, last) + 0.5) * width - 0.5, stored[:, first:last]])
        rests = [
            np.array([[0.5 * (a + b - 1)], [samples[a:b].min()], [samples[a:b].max()]]) if a < b else np.empty((3, 0))
            for a, b in ((begin, first * width), (last * width, end))
        ]
        middles, low, high = np.hstack([rests[0], whole, rests[1]])
        return middles, low, high
