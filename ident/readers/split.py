"""A run split into estimation and validation data, with a gap between them as long as the machine remembers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ident.errors import Unusable
from ident.readers.loop_settings import seconds_or_samples
from ident.readers.typed_fields import Fields
from ident.run import BENCH, Run, Samples
from ident.words.number import count
from ident.words.run_name import run_name

VALIDATION = "validation"
"""What the id of the validation data ends with, behind that of the run and a dot."""
FEWEST = 8
"""Samples of each part, as of a run."""
SEGMENTS = 4
"""Parts of a record over which its spectra are averaged, each of half of which is looked through for the response."""
ENERGY = 0.01
"""Of the energy of the impulse response: what may be left when it is taken to be over by half. A mode that has lost
99 % of its energy has lost 99 % of its amplitude after twice that time."""
FLOOR = 1e-3  # of the largest power of the command: where it has less, the ratio of the spectra says nothing


@dataclass(frozen=True)
class Split:
    """Rows [first, end) of the file that are validation data; `gap` in s, or in samples where the clock is unknown.

    Where no gap is stated it is :func:`memory` of the run.
    """

    first: int
    end: int
    gap: float | None = None


def describe_split(fields: Fields, kind: str, use: str, time_unit: str) -> Split | None:
    """The entry `split` of a run. Raises Unusable: ``bad-split``."""
    if "split" not in fields:
        return None
    place = fields.place("split")
    if kind in BENCH or use != "fit":
        what = "a record of a bench is used whole" if kind in BENCH else "the whole run is validation data already"
        raise Unusable("bad-split", what, place, "leave split out")
    given = Fields(fields.data["split"], place, (VALIDATION, "gap"))
    given.need(VALIDATION, "write validation: [first, end], 0 being the first sample of the file")
    first, end = given.pair(VALIDATION) or (0, 0)
    if not isinstance(first, int) or not isinstance(end, int) or not 0 <= first < end:
        what = f"{given.data[VALIDATION]} is not a part of a file"
        raise Unusable(
            "bad-split",
            what,
            given.place(VALIDATION),
            "write [first, end]: 0 is the first sample, and end is not included",
        )
    return Split(first, end, seconds_or_samples(given, "gap", time_unit))


def validation_id(run: str) -> str:
    """The id of the validation data of a run."""
    return f"{run}.{VALIDATION}"


def split(run: Run, of: Split, rows: tuple[int, int]) -> tuple[tuple[Run, Run], str]:
    """Estimation and validation data of a run that is rows [first, end) of its file, and in words what the gap is.

    The longer of what stands before and behind the validation data, less the gap, is estimation data. What the command
    did before still acts in both. Raises Unusable: ``bad-split``.
    """
    place = f"{run_name(run.id)} split"
    begin, end = (round((row - rows[0]) * run.length / (rows[1] - rows[0])) for row in (of.first, of.end))
    if begin < 0 or end > run.length:
        what = f"rows [{of.first}, {of.end}] are not within [{rows[0]}, {rows[1]}]"
        raise Unusable("bad-split", what, place, "correct validation")
    lasts = memory(run)
    gap = lasts if of.gap is None else round(of.gap * run.sample_rate)
    before, behind = (0, begin - gap), (end + gap, run.length)
    first, last = max(before, behind, key=lambda part: part[1] - part[0])
    if min(last - first, end - begin) < FEWEST:
        what = (
            f"{count(max(last - first, 0), 'sample')} of estimation data and {end - begin} of validation data are left"
        )
        raise Unusable(
            "bad-split", what, place, f"leave {FEWEST} at least to both, or shorten the gap of {gap} samples"
        )
    validation = replace(run.part(begin, end), id=validation_id(run.id), use="verify")
    return (run.part(first, last), validation), _told(run, begin, end, gap, lasts)


def _told(run: Run, begin: int, end: int, gap: int, lasts: int) -> str:
    clock = "s" if run.time_unit == "s" else "samples"
    left, long = (f"{n / run.sample_rate:.3g} {clock}" for n in (gap, lasts))
    told = (
        f"{run_name(run.id)}: samples {begin} to {end - 1} are validation data, and a gap of {left} is used by neither"
    )
    return f"{told}; the response to the command lasts {long}, so the gap is too short" if gap < lasts else told


def memory(run: Run) -> int:
    """For how many samples a run remembers its command: until its impulse response has 1 % of its amplitude left.

    The response is the inverse transform of Syu/Suu, averaged over half-overlapping Hann windows (Ljung, System
    Identification, 6.4); an eighth of the run at most, as for what integrates.
    """
    drive: Samples | None = next((run.channels[name] for name in ("command", "current") if name in run.channels), None)
    length = run.length // SEGMENTS
    longest = length // 2
    if drive is None or longest < 2:
        return longest
    window = np.hanning(length)
    starts = range(0, run.length - length + 1, max(length // 2, 1))
    pieces = [(drive[at : at + length], run.measured[at : at + length]) for at in starts]
    spectra = [[np.fft.rfft((one - one.mean()) * window) for one in piece] for piece in pieces]
    power = np.sum([np.abs(u) ** 2 for u, _ in spectra], axis=0)
    cross = np.sum([y * u.conj() for u, y in spectra], axis=0)
    response = np.fft.irfft(cross / np.maximum(power, FLOOR * power.max() or 1.0), length)[:longest]
    left = np.cumsum(response[::-1] ** 2)[::-1]
    return min(2 * int(np.searchsorted(-left, -ENERGY * left[0])), longest)
