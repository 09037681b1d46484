"""Whether two runs repeat one measurement: the one rule, used by the noise floor and by the checks.

Two runs repeat each other if sample rate, length and every measured input agree sample by sample: the RMS of the
difference of the inputs, mean counted, is at most `exact` of their standard deviation, or at most `noises` times the
noise with which they were recorded (:class:`ident.noise.criteria.Repeats`). Labels (specimen, gain, amplitude …) can
only part runs: two that are labelled alike but were commanded differently are no repeats. A trigger that came up to
`shift` samples earlier or later is taken out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ident.noise.criteria import NOISE_CRITERIA
from ident.rounding import ROUNDING
from ident.run import BENCH, DISTURBANCES, MOTIONS, Run

Array = NDArray[np.float64]

_OF = NOISE_CRITERIA.repeats
_GLANCE = 64
"""Samples that show most inputs to be different. No answer depends on it: inputs that are one differ by far less than
half of their size."""
_DRIVES = ("command", "drive_force", *MOTIONS)


class Repeat(NamedTuple):
    """Two runs that repeat each other; what the second shows at sample k + `shift`, the first shows at sample k."""

    first: Run
    second: Run
    shift: int = 0

    def outputs(self) -> tuple[Array, Array]:
        """The outputs of both over the samples that they have in common, once they have settled, (n,) each."""
        x, y = overlap(self.first.measured, self.second.measured, self.shift)
        settled = int(_OF.settled * len(x))
        return x[settled:], y[settled:]

    def difference(self) -> Array:
        """The difference of the two outputs once they have settled, (n,): the noise of both."""
        x, y = self.outputs()
        return x - y


def repeated(runs: Sequence[Run]) -> list[Repeat]:
    """Every pair of runs that repeat each other, but for the same record under two names.

    A run to verify is no repeat of one to fit: something was changed on purpose, such as an added load. Records of a
    bench differ in what else was set, so that none of them counts.
    """
    groups: dict[object, list[Run]] = {}
    for run in runs:
        if run.kind not in BENCH:
            groups.setdefault(labels(run), []).append(run)
    outputs = _outputs(runs)
    pairs = (pair for members in groups.values() for pair in combinations(members, 2))
    return [found for a, b in pairs if (found := _repeat(a, b, outputs)) is not None]


def same_inputs(a: Run, b: Run) -> bool:
    """Whether every input of two runs of one record and length agrees sample by sample, without a shift."""
    names = _inputs(a, {a.output})
    return bool(names) and all(_agree(a.channels[name], b.channels[name]) for name in names)


def labels(run: Run) -> tuple[object, ...]:
    """What is stated of a run: runs of which this differs are no repeats."""
    stated = (run.use, run.kind, run.specimen, run.gain, run.amplitude, run.frequency, run.position_range)
    return (*stated, run.rated_current, run.closed_loop, run.hold, run.time_unit, run.output)


def unlabelled(run: Run) -> bool:
    """Whether nothing is stated that would part a run from another of the same command."""
    return run.specimen is None and run.gain is None and run.amplitude is None


def at_rest(samples: Array) -> bool:
    """Whether samples stand still, but for their rounding."""
    return bool(np.ptp(samples) <= ROUNDING * np.abs(samples).max())


def overlap(first: Array, second: Array, shift: int) -> tuple[Array, Array]:
    """What two signals have in common if the second is late by `shift` samples, (n,) each."""
    a, b = first[max(0, -shift) :], second[max(0, shift) :]
    count = min(len(a), len(b))
    return a[:count], b[:count]


def recording_noise(u: Array, v: Array) -> float:
    """The standard deviation of the noise with which one command was recorded twice, as u and v, (n,) each.

    An input is held, or goes on smoothly with ten samples a cycle or more, and so does the difference of two different
    inputs; noise is another in every sample. So d = u − v, less its mean and its part in proportion to the inputs (an
    offset and a gain are no noise), is judged by its mean square successive difference (von Neumann 1941), half of
    which is the variance of white noise: σ² = ½ · ½ ⟨(d[k+1] − d[k])²⟩, the first ½ since d has the noise of both.
    Noise that a filter ahead of the recorder smooths is underestimated: with a cut-off at 0.4 of the Nyquist
    frequency by a half, which `noises` makes up for.
    """
    inputs, difference = 0.5 * (u + v), u - v
    inputs, difference = inputs - inputs.mean(), difference - difference.mean()
    power = float(inputs @ inputs)
    if power > 0.0:
        difference = difference - inputs * (float(difference @ inputs) / power)
    return 0.5 * float(np.sqrt(np.mean(np.diff(difference) ** 2))) if len(u) > 1 else 0.0


def _outputs(runs: Sequence[Run]) -> dict[str, set[str]]:
    """The names of the outputs of each record."""
    found: dict[str, set[str]] = {}
    for run in runs:
        found.setdefault(run.record or run.id, set()).add(run.output)
    return found


def _repeat(a: Run, b: Run, outputs: dict[str, set[str]]) -> Repeat | None:
    if abs(a.length - b.length) > _OF.shift or not _of_one_clock(a, b):
        return None
    names = _inputs(a, outputs[a.record or a.id])
    if names != _inputs(b, outputs[b.record or b.id]) or any(a.units.get(n) != b.units.get(n) for n in names):
        return None
    inputs = [(a.channels[name], b.channels[name]) for name in names]
    if not inputs or not _near_at_a_glance(*inputs[0]):
        return None
    shift = _shift(*inputs[0])
    if not all(_agree(*overlap(u, v, shift)) for u, v in inputs):
        return None
    found = Repeat(a, b, shift)
    if np.array_equal(*found.outputs()) or (at_rest(inputs[0][0]) and not _same_start(a, b)):
        return None
    return found


def _of_one_clock(a: Run, b: Run) -> bool:
    """Whether the ends of two records are less than half a sample apart."""
    return abs(a.sample_rate - b.sample_rate) * a.length <= 0.5 * a.sample_rate


def _inputs(run: Run, outputs: set[str]) -> list[str]:
    """What acts on a run: its command, else the force on the load, else the motion; then measured disturbances."""
    drives = [name for name in _DRIVES if name in run.channels and name not in outputs]
    return [*drives[:1], *(name for name in DISTURBANCES if name in run.channels)]


def _near_at_a_glance(u: Array, v: Array) -> bool:
    """Whether a few samples of two inputs may agree, with a shift or without: most different ones do not."""
    most, count = _most_shift(u, v), min(len(u), len(v))
    at = np.linspace(most, count - 1 - most, _GLANCE).astype(int)
    shifted = v[at + np.arange(-most, most + 1)[:, None]]
    apart = np.sqrt(np.mean((shifted - u[at]) ** 2, axis=1)).min()
    return bool(apart <= 0.5 * _size(u, v))


def _shift(u: Array, v: Array) -> int:
    """The shift with which two inputs agree best; 0 where it is no better than chance makes it."""
    most = _most_shift(u, v)
    apart = {shift: _rms(*overlap(u, v, shift)) for shift in sorted(range(-most, most + 1), key=abs)}
    best = min(apart, key=lambda shift: apart[shift])
    return best if apart[best] < _OF.less_by_a_shift * apart[0] else 0


def _most_shift(u: Array, v: Array) -> int:
    return min(_OF.shift, int(_OF.shift_of_a_record * min(len(u), len(v))))


def _agree(u: Array, v: Array) -> bool:
    """Whether two inputs are one, sample by sample."""
    apart, size = _rms(u, v), _size(u, v)
    if apart <= _OF.exact * size:
        return True
    noise = recording_noise(u, v)
    return noise <= _OF.most_noise * size and apart <= _OF.noises * noise


def _rms(u: Array, v: Array) -> float:
    return float(np.sqrt(np.mean((u - v) ** 2)))


def _size(u: Array, v: Array) -> float:
    """The standard deviation of two inputs; of inputs that are held from the first sample to the last, their level."""
    if at_rest(u) and at_rest(v):
        return float(max(np.abs(u).max(), np.abs(v).max()))
    return 0.5 * float(np.std(u) + np.std(v))


def _same_start(a: Run, b: Run) -> bool:
    """Whether two outputs begin at one place: a step that was held before the record began is to one level from it."""
    size = max(np.ptp(a.measured), np.ptp(b.measured))
    return bool(abs(a.measured[0] - b.measured[0]) <= _OF.same_start * size)


def groups(pairs: Sequence[Repeat]) -> Iterator[dict[str, int]]:
    """Runs that repeat each other, each in one group: id and shift of each, in samples, against the first."""
    found: list[dict[str, int]] = []
    for first, second, shift in pairs:
        group = next((group for group in found if first.id in group or second.id in group), None)
        if group is None:
            found.append({first.id: 0, second.id: shift})
        elif first.id in group:
            group.setdefault(second.id, group[first.id] + shift)
        else:
            group.setdefault(first.id, group[second.id] - shift)
    yield from found
