"""Chains with effects and runs in, outputs out: what a kernel of :mod:`ident.simulation.kernel` needs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import INPUT, MEASURED, STEP, Chain
from ident.chain.channels import READABLE
from ident.equations.grammar import TIME
from ident.parallel import LEAST_SHARED, cores, each
from ident.run import Run
from ident.simulation.filters import pack_filter
from ident.simulation.inputs import fine, jump_share
from ident.simulation.kernel import HELD, LANES, SHARE, WIDE, Kernel, constant, exponents_in_code, kernel
from ident.simulation.lanes import Lanes
from ident.simulation.machine_call import advance_groups
from ident.time_budget import LONGEST_BATCH, check_time

Array = NDArray[np.float64]
_CHUNK = 1 << 18  # outputs that are simulated in one go: they stay near the core


@dataclass(frozen=True)
class _Input:
    """One input of every run at the fine steps, one run after the other, (m,).

    `begin` is where each lane begins in it, `delay` the fine steps by which it is late, `known` whether what was
    before the record is known, so that nothing jumps there, all (lanes,).
    """

    record: Array
    begin: NDArray[np.int64]
    delay: Array
    known: NDArray[np.bool_]

    @property
    def first(self) -> Array:
        """The value with which each lane begins."""
        return np.asarray(self.record[self.begin])

    @property
    def share(self) -> Array:
        """The fraction of a step in each delay."""
        return np.maximum(self.delay - _whole(self.delay), 0.0)


@dataclass(frozen=True)
class Simulation:
    """Runs of one length and sample rate, each with `v` parameter vectors, side by side.

    `values` maps every symbol of the chain to an array that broadcasts to (runs, v); `start` holds the states at the
    first sample, (runs, v, n), zero where None, and may hold what :attr:`Chain.begun` has beside them; `steps` divides
    the sample time.
    """

    chain: Chain
    runs: tuple[Run, ...]
    values: Mapping[str, Array]
    steps: int = 1
    start: Array | None = None

    @cached_property
    def shape(self) -> tuple[int, int]:
        """(runs, vectors)."""
        wide = [(1, 1, *np.shape(value))[-2:] for value in self.values.values()]
        return max(len(self.runs), *(runs for runs, _ in wide)), max(vectors for _, vectors in wide)

    def outputs(self, length: int = 4096) -> Iterator[tuple[Array, int, int]]:
        """The outputs in blocks of at most `length` samples: ((samples, runs, vectors), first, last)."""
        check_time()
        (count, vectors), samples = self.shape, self.runs[0].length
        lanes = -(-count * vectors // LANES) * LANES
        built = self._kernel()
        lane_values = self._lanes(lanes)
        inputs = {name: self._input(lanes, name, built, lane_values) for name in built.inputs}
        command = inputs[INPUT]
        measured = [inputs[name].record for name in built.measured] or [command.record]
        forces = np.column_stack(measured).ravel() if measured[1:] else measured[0]
        force_at = inputs[built.measured[0]].begin if built.measured else command.begin
        lane_values |= {HELD: self._held(lanes), SHARE: command.share}
        packed = self._packed(built, lane_values, lanes, inputs)
        side_by_side = Lanes(packed, command.begin, force_at, count * vectors, samples * self.steps)
        for begin, end in self._chunks(length, side_by_side):
            out = np.empty((end - begin) * side_by_side.count)
            code, _kept = built.address(side_by_side.wide)

            def advance(
                share: NDArray[np.intp],
                of: Lanes = side_by_side,
                code: int = code,
                begin: int = begin,
                end: int = end,
                out: Array = out,
            ) -> None:
                given = of.buffers, command.record, forces, of.command_at, of.force_at
                for some, first, last in _batches(share, begin, end, self.steps * of.wide):
                    check_time()
                    rows, ends = out[(first - begin) * of.count :], (first * self.steps, (last - 1) * self.steps + 1)
                    advance_groups(code, of.wide, some, *given, *ends, self.steps, rows, of.count)
                    if last < samples:  # on to the first step of what follows
                        check_time()
                        rest, spare = (ends[1], last * self.steps), np.empty(of.count)
                        advance_groups(code, of.wide, some, *given, *rest, 1 << 40, spare, of.count)

            groups, work = side_by_side.groups, (end - begin) * self.steps * side_by_side.count
            shares = min(groups, cores()) if work >= LEAST_SHARED else 1
            each(advance, np.array_split(np.arange(groups), shares))
            rows = out.reshape(-1, side_by_side.count)
            for first in range(begin, end, length):
                last = min(first + length, end)
                shown = side_by_side.shown(rows[first - begin : last - begin], count * vectors)
                yield shown.reshape(-1, count, vectors), first, last
            if side_by_side.used > WIDE and self.start is not None and end < samples:
                side_by_side = side_by_side.joined()

    def _chunks(self, length: int, lanes: Lanes) -> Iterator[tuple[int, int]]:
        """The samples that are simulated in one go, from one to before another, in blocks of `length`.

        As many as memory near the core holds; where lanes may come together few at first, then twice as many each time.
        """
        samples, most = self.runs[0].length, max(1, _CHUNK // (length * lanes.count)) * length
        begin, size = 0, most if self.start is None else length
        while begin < samples:
            end = min(begin + size, samples)
            yield begin, end
            begin, size = end, min(2 * size, most)

    def _kernel(self) -> Kernel:
        return kernel(self.chain, self.runs[0].output, exponents_in_code(self.chain, self.values), recorded=True)

    def _lanes(self, lanes: int) -> dict[str, Array]:
        """Every symbol lane by lane, the spare lanes repeating the last."""
        known = {name: self.values[name] for name in self.chain.symbols}
        known[STEP] = np.array(1.0 / (self.runs[0].sample_rate * self.steps))
        wide = np.empty((len(known), *self.shape))
        for row, value in zip(wide, known.values(), strict=True):
            row[...] = value
        flat = wide.reshape(len(known), -1)
        spare = np.repeat(flat[:, -1:], lanes - flat.shape[1], axis=1)
        return dict(zip(known, np.concatenate([flat, spare], axis=1), strict=True))

    def _held(self, lanes: int) -> Array:
        return np.array([float(run.hold == "zoh") for run in self.runs])[self._run_of(lanes)]

    def _run_of(self, lanes: int) -> NDArray[np.intp]:
        """The number of the run of each lane; the spare lanes are of the last."""
        return np.minimum(np.arange(lanes) // self.shape[1], len(self.runs) - 1)

    def _input(self, lanes: int, name: str, built: Kernel, values: Mapping[str, Array]) -> _Input:
        """One input of every run at the fine steps; a delay shifts the command alone."""
        delay, whole, before = np.zeros(lanes), np.zeros(lanes, dtype=np.int64), 2
        if name == INPUT and built.shift is not None:
            delay = np.broadcast_to(constant(built.shift, values) / values[STEP], (lanes,))
            whole = _whole(delay)
            before += int(whole.max())
        records = [fine(run, name, self.steps, before) for run in self.runs]
        starts = np.cumsum([0, *(len(record) for record in records[:-1])]) + before
        past = [name == INPUT and (run.past is not None or run.hold == "band-limited") for run in self.runs]
        run_of, record = self._run_of(lanes), np.concatenate(records) if records[1:] else records[0]
        return _Input(record, starts[run_of] - whole, delay, np.array(past)[run_of])

    def _packed(self, built: Kernel, values: Mapping[str, Array], lanes: int, inputs: Mapping[str, _Input]) -> Array:
        """The kernel's buffers, one of sixteen lanes after the other, flat."""
        rows = np.zeros((built.rows, lanes))
        built.fill_constants(rows, values)
        for known in built.filters:
            pack_filter(rows, known, values)
        for name, first in built.inputs.items():
            # The first value did not jump there: what the command did before the record is hardly ever known.
            of = inputs[name]
            rows[first] = rows[first + 1] = of.first
            if name == INPUT and built.shift is not None:
                late = _begun_late(of, values[HELD])
                rows[first], rows[first + 1] = np.where(of.delay > 0, late, rows[first])
            if of.known.any():
                rows[first] = np.where(of.known, of.record[of.begin - 1], rows[first])
                rows[first + 1] = np.where(of.known, of.first, rows[first + 1])
        if self.start is not None:
            for i, name in enumerate(self.chain.states):
                rows[built.states[name]] = _filled(self.start[..., i].ravel(), lanes)
            self._settle(rows, built, values, inputs[INPUT].first)
            for i, name in enumerate(
                self.chain.begun[len(self.chain.states) : self.start.shape[-1]], len(self.chain.states)
            ):
                rows[built.memories[name]] += _filled(self.start[..., i].ravel(), lanes)
        elif set(READABLE) & set(self.chain.symbols):  # what remembers a pressure begins with what it was
            self._settle(rows, built, values, np.zeros(lanes))
        return rows.reshape(built.rows, -1, LANES).transpose(1, 0, 2).ravel()

    def _settle(self, rows: Array, built: Kernel, values: Mapping[str, Array], command: Array) -> None:
        """What remembers, as if the machine had stood where it starts."""
        begun = [one for one in built.filters if one.first not in built.states.values()]  # others begin in their state
        if not (begun or built.memories):
            return
        known = dict(values) | {name: rows[row] for name, row in built.states.items()}
        known |= {INPUT: command, "du": np.zeros_like(command), TIME: 0.0}
        known |= {name: np.zeros_like(command) for name in MEASURED}
        found = _at_rest(self.chain, known)
        for name, row in built.memories.items():
            rows[row] = found[name]
        for one in begun:
            rows[one.first] = constant(one.input, found)


def _batches(groups: NDArray[np.intp], begin: int, end: int, steps: int) -> Iterator[tuple[tuple[int, int], int, int]]:
    """Groups of lanes and samples to be advanced in one go, from one to before another: between them time may be up.

    `steps` are those of all lanes of a group in a sample.

    Mostly all of them at once; of long records, or many lanes, some groups after the other, each from the first sample
    to the last. However they are cut, a lane takes the same steps.
    """
    first, last = int(groups[0]), int(groups[-1]) + 1
    samples = max(1, LONGEST_BATCH // steps)  # of one group
    together = max(1, samples // max(end - begin, 1))
    for group in range(first, last, together):
        for sample in range(begin, end, samples):
            yield (group, min(group + together, last)), sample, min(sample + samples, end)


def _at_rest(chain: Chain, known: Mapping[str, Any]) -> dict[str, Any]:
    """Every signal where nothing moves; a memory that copies a signal has always held it, others were at zero."""
    copies = {equation.target for equation in chain.equations if equation.is_memory and not _reads_old(equation.names)}
    values = dict(known) | {f"{name}__old": 0.0 for name in chain.memories}
    for _ in range(2):
        values = chain.signals_at(values)
        values |= {f"{name}__old": values[name] for name in copies}
    return values


def _reads_old(names: frozenset[str]) -> bool:
    return any(name.endswith("__old") for name in names)


def _whole(delay: Array) -> NDArray[np.int64]:
    """The whole steps in a delay of fine steps."""
    return np.asarray(np.floor(delay + 1e-9).astype(np.int64))


def _filled(values: Array, lanes: int) -> Array:
    if len(values) == lanes:
        return values
    return np.concatenate([values, np.full(lanes - len(values), values[-1])])


def _begun_late(command: _Input, held: Array) -> Array:
    """A late command before and at the first fine step, (2, lanes)."""
    record, begin, whole = command.record, command.begin, _whole(command.delay)
    start = begin + whole
    front, jump = record[start - 2], record[start] - record[start - 2]
    last = front - jump_share(np.maximum(command.delay, 1e-9)) * jump
    drawn = held == 0
    before = np.where(drawn & (whole == 0), last, record[begin - 1])
    return np.array(
        [np.where(drawn & (whole == 1), front, before), np.where(drawn & (whole == 1), last, record[begin])]
    )


def side_by_side(parts: Sequence[Simulation]) -> Simulation:
    """Simulations of the same runs, with as many steps, as one: lanes that one vector would leave empty are filled."""
    first, *others = parts
    if not others:
        return first
    ends = np.cumsum([part.shape[1] for part in parts])
    wide = np.empty((len(first.values), first.shape[0], ends[-1]))
    for part, end in zip(parts, ends.tolist(), strict=True):
        for row, name in zip(wide, first.values, strict=True):
            row[:, end - part.shape[1] : end] = part.values[name]
    begun = [part.start for part in parts if part.start is not None]
    values = dict(zip(first.values, wide, strict=True))
    return replace(first, values=values, start=np.concatenate(begun, axis=1) if begun else None)


def responses(
    chain: Chain, runs: Sequence[Run], values: Mapping[str, Array], steps: int = 1, start: Array | None = None
) -> Array:
    """The whole outputs of runs of one length: (samples, runs, vectors)."""
    return np.concatenate([rows for rows, _, _ in Simulation(chain, tuple(runs), values, steps, start).outputs()])
