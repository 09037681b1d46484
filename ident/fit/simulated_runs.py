"""Runs under a chain that is not linear, simulated at given values: outputs, and what a fit needs of them.

The first state of a record that starts moving is a nuisance of its run: it begins at the linear model's and follows
with each step of a fit, by the sensitivities to it. What was recorded of it is none: the position of a machine that is
moved begins where it was measured. Were it free, what hangs on the position could be another thing in every run.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest
from typing import Self

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import Chain, integrates, linear_model
from ident.chain.conditions import conditions
from ident.effects.effect import Effect
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.first_guesses import first_position, in_order, order_stays, with_followers
from ident.fit.initial_state_estimation import BestInitialState, InitialStateEstimation, better
from ident.fit.modes import extreme, fastest, motion
from ident.fit.multiple_shooting import ShootingWindows
from ident.fit.normal_matrices import NormalMatrices, at_point, block_length, first_state, normal_matrices_of
from ident.fit.products import add_block_products, add_products, completed
from ident.fit.reduction import excited_band
from ident.fit.reversals import Reversals
from ident.fit.steady_states import Held, steady_states
from ident.matrix import Matrix
from ident.parallel import LEAST_SHARED, cores, each
from ident.presets import Preset
from ident.run import Run
from ident.simulation.simulate import Simulation, side_by_side
from ident.simulation.steps import Modes, steps_needed

Array = NDArray[np.float64]
BegunOver = tuple[float, float | None]
"""The horizon and the memory (s) of the windows over which first states are found."""
_OF = FIT_CRITERIA.first_states
_TOGETHER = 1024
"""Lanes simulated in one go: what is done once for all of them costs little. No answer depends on it."""
_BLOCK = 512
"""Samples simulated at a time: their residuals stay in the cache of the core. No answer depends on it."""


@dataclass
class SimulatedRuns:
    """Runs of a matrix as a preset simulates them; `starts` are the first states that are known, by the run's id.

    `band` (rad/s) is what the commands excite: see :func:`ident.fit.reduction.excited_band`. Values are by the
    equations' names, SI: numbers, or arrays of v parameter vectors side by side. With a `horizon` (s)
    the moments are those of windows of that length, each begun where it was measured: see :mod:`ident.fit.windows`;
    with a `memory` (s) at the speed, too, that was found before. Of the outputs named in `absolute` the mean counts
    too, which eq. (17) does not see. A free run `begun_over` windows has the first states that these find, by their
    horizon and memory: none is free to make up for where the record drifts to. A search follows the kinks of a core
    `roughly`. `sizes` are those of the core's states, (n,), and `sizes_of_effects` those of what effects begin with,
    (m,), once a run has begun that moves. The latter are found where they are first asked for: `unsized` are the runs
    that have begun since, with the values and the steps a sample there.
    """

    preset: Preset
    matrix: Matrix
    runs: tuple[Run, ...]
    band: float
    starts: dict[str, Array] = field(default_factory=dict, kw_only=True)
    horizon: float | None = field(default=None, kw_only=True)
    memory: float | None = field(default=None, kw_only=True)
    absolute: tuple[str, ...] = field(default=(), kw_only=True)
    begun_over: BegunOver | None = field(default=None, kw_only=True)
    roughly: bool = field(default=False, kw_only=True)
    sizes: Array = field(default_factory=lambda: np.zeros(1), kw_only=True)
    sizes_of_effects: Array = field(default_factory=lambda: np.zeros(1), kw_only=True)
    unsized: tuple[tuple[Run, Mapping[str, Array], int], ...] = field(default=(), kw_only=True, repr=False)
    _last_modes: tuple[tuple[Hashable, ...], Modes] | None = field(default=None, init=False, repr=False)

    @property
    def chain(self) -> Chain:
        """The chain with its effects."""
        return self.preset.chain

    def outputs_at(self, values: Mapping[str, float]) -> dict[str, Array]:
        """The model's output of each run by its id, with the first state that fits best."""
        vector, steps = self.settle(values)

        def of_runs(runs: tuple[Run, ...]) -> Array:
            blocks = [rows[:, :, 0] for rows, _, _ in self.simulation(runs, vector, steps).outputs()]
            return np.concatenate(blocks).T

        todo = list(self.together(1, steps))
        found = zip(todo, each(of_runs, todo), strict=True)
        return {run.id: y for runs, outputs in found for run, y in zip(runs, outputs, strict=True)}

    def settle(self, values: Mapping[str, float]) -> tuple[dict[str, Array], int]:
        """Find the first states of runs that start moving; the values as a vector of one, and the steps a sample.

        From those that are known, or from each guess: a model that is not linear in them has several best ones.
        """
        self._begin_as_windows_do(values)
        vector = {name: np.array([value]) for name, value in values.items()}
        steps = int(self.steps(vector).max())
        moving = tuple(run for run in self.runs if run.begins == "moving")
        begun = [[self.start(run)] if run.id in self.starts else self._guesses(run, values) for run in moving]
        ends: dict[str, list[BestInitialState]] = {run.id: [] for run in moving}
        with np.errstate(over="ignore", invalid="ignore"):
            for starts in zip_longest(*begun):
                here = [(run, start) for run, start in zip(moving, starts, strict=True) if start is not None]
                self.starts |= {run.id: start for run, start in here}
                for run, found in self.settled(vector, np.empty(0), steps, tuple(run for run, _ in here)).items():
                    ends[run].append(BestInitialState(self.starts[run], found))
        self.starts |= {run: better(led).start for run, led in ends.items()}
        return vector, steps

    def settled(
        self,
        values: Mapping[str, Array],
        strides: Array,
        steps: int,
        runs: tuple[Run, ...] | None = None,
        known: Mapping[str, NormalMatrices] | None = None,
    ) -> dict[str, NormalMatrices]:
        """The matrices of every run by its id; without sensitivities the first states are followed until they hold.

        `strides` (p,) are those of the vectors behind the first; `runs` some of all; `known` the matrices from the
        first states as they are, where these were simulated before.
        """
        found = {r.id: self._as_seen((r,), [at_point(r, known[r.id])])[0] for r in self.runs} if known else {}
        settling, pending = InitialStateEstimation(), self.runs if runs is None else runs
        for number in range(1 if len(strides) else _OF.rounds):
            if number or known is None:
                todo = list(self.together(len(strides) + 1 + len(self.chain.begun), steps, of=pending))
                parts = each(lambda runs: self._normal_matrices(runs, values, strides, steps), todo)
                for some, part in zip(todo, parts, strict=True):
                    found.update((run.id, moments) for run, moments in zip(some, part, strict=True))
            if len(strides):
                return found
            pending = tuple(run for run in pending if self.goes_on(run, settling, found[run.id]))
            if not pending:
                break
        for run, least in settling.least.items():
            self.starts[run], found[run] = least.start, least.found.as_begun()
        return found

    def _normal_matrices(
        self, runs: tuple[Run, ...], values: Mapping[str, Array], strides: Array, steps: int
    ) -> list[NormalMatrices]:
        """The moments of runs of one length, from one simulation of all of them."""
        return self.normal_matrices_of_each(runs, [self.released(runs, values, steps)], strides)[0]

    def normal_matrices_of_each(
        self, runs: tuple[Run, ...], simulations: Sequence[Simulation], strides: Array
    ) -> list[list[NormalMatrices]]:
        """The moments of runs of one length in each of several simulations of them, which are carried out as one.

        `strides` (p,) are those of the vectors behind the first of each.
        """
        return [
            self._as_seen(runs, normal_matrices_of(runs, products, len(strides)))
            for products in self._products(runs, simulations, strides)
        ]

    def _as_seen(self, runs: tuple[Run, ...], found: list[NormalMatrices]) -> list[NormalMatrices]:
        """The moments of runs as the objective counts their means."""
        if self.horizon is not None:
            # Where each window begins anew no mean is left that would tell an offset.
            return [replace(run, offset=0.0, means=run.means[:0], transducer="", counted=False) for run in found]
        absolute = runs[0].output in self.absolute
        return [replace(run, transducer="", counted=False) for run in found] if absolute else found

    def _products(self, runs: tuple[Run, ...], simulations: Sequence[Simulation], strides: Array) -> list[Array]:
        """Σ of products of [J, N, 1, r] of runs of one length and of each block of them, (runs, blocks, q, q) each.

        J are the differences of the vectors behind the first to it, over `strides`.
        """
        length, anchoring = block_length(runs[0]), self.anchoring(runs[0])
        free = runs[0].output not in self.absolute
        records = np.column_stack([run.centred if free else run.measured for run in runs])
        if window := anchoring.window:
            length, records = -(-length // window) * window, anchoring(records)
        q = simulations[0].shape[1] + 1
        sums = np.zeros((len(simulations), -(-runs[0].length // length), len(runs), q, q))
        anchored, joint = anchoring.from_start(), side_by_side(simulations)
        together = max(1, _BLOCK // length) * length
        for rows, begin, end in joint.outputs(together):
            for own, raw, shown in zip(
                sums, *(np.split(of, len(sums), 2) for of in (rows, anchored(rows))), strict=True
            ):
                add_block_products(shown, records[begin:end], q - 2, length, own[begin // length :])
                if begin == 0 and window and len(self._free(runs[0])):
                    own[0] += self._beginning(runs, raw, own[0])
        if window or not free:
            sums[..., -2, :] = sums[..., :, -2] = 0.0  # no mean is free: each window begins where it was measured
        return [completed(own, strides).transpose(1, 0, 2, 3) for own in sums]

    def _beginning(self, runs: tuple[Run, ...], rows: Array, like: Array) -> Array:
        """Products of [J, N, 0, r] of where the runs begin, (runs, q, q): the mean of the first samples, not anchored.

        A constant has no part in it: what is one of the record, such as an offset, does not begin it elsewhere.
        """
        first, measured = rows[: _OF.begins], np.array([run.measured[: _OF.begins] for run in runs]).T
        sums = np.zeros_like(like)
        add_products(first.mean(axis=0, keepdims=True), measured.mean(axis=0, keepdims=True), sums.shape[1] - 2, sums)
        sums[:, -2, :] = sums[:, :, -2] = 0.0
        return sums * (_OF.bound * runs[0].length)

    def anchoring(self, run: Run, count: int = 1) -> ShootingWindows:
        """How the windows of a run begin, of its samples or of means of `count` of them."""
        if self.horizon is None:
            return ShootingWindows(0)
        window = max(2, round(self.horizon * run.sample_rate))
        return ShootingWindows(window // count, (self.memory or 0.0) * run.sample_rate / count)

    def outputs_of(self, simulation: Simulation) -> Iterator[tuple[Array, int, int]]:
        """The outputs of a simulation in blocks, as its windows show them: see :meth:`Simulation.outputs`."""
        anchoring = self.anchoring(simulation.runs[0])
        anchored, window = anchoring.from_start(), anchoring.window
        length = max(_BLOCK // window, 1) * window if window else _BLOCK
        for rows, first, last in simulation.outputs(length):
            yield anchored(rows), first, last

    def left(self, run: Run, output: Array) -> Array:
        """The residual of an output (n, …) on a run: less its mean, which eq. (17) does not see, or over windows."""
        residual = run.measured.reshape(-1, *[1] * (output.ndim - 1)) - output
        return residual - residual.mean(axis=0) if self.horizon is None else self.shown(run, residual)

    def shown(self, run: Run, signal: Array) -> Array:
        """A signal of a run along its first axis, as its windows show it."""
        return self.anchoring(run)(signal)

    def whole(self) -> Self:
        """The same over whole runs, as eq. (17) sees them."""
        over = self.begun_over if self.horizon is None else (self.horizon, self.memory)
        return replace(self, horizon=None, memory=None, absolute=(), begun_over=over, starts=dict(self.starts))

    def released(self, runs: tuple[Run, ...], values: Mapping[str, Array], steps: int) -> Simulation:
        """A simulation of vectors and, where runs start moving, of the first with each of its first states moved."""
        free = self._free(runs[0])
        if not len(free):
            return self.simulation(runs, values, steps)
        vectors, states = len(next(iter(values.values()))), len(free)
        lanes = np.append(np.arange(vectors), np.zeros(states, np.intp))
        wide = {name: value[lanes] for name, value in values.items()}
        start = np.repeat(np.array([self.start(run) for run in runs])[:, None], vectors + states, axis=1)
        start[:, vectors + np.arange(states), free] += self._reach[free]
        return self.simulation(runs, wide, steps, start)

    def simulation(
        self, runs: tuple[Run, ...], values: Mapping[str, Array], steps: int, start: Array | None = None
    ) -> Simulation:
        """A simulation of vectors at runs of a kind, from the first states that are known.

        Where none is known yet of a machine that is not linear, each vector stands under the mean command at first: a
        level that rises from zero would be judged by how fast it does.
        """
        known = [conditions(run, self.matrix.actuator) for run in runs]
        stacked = {name: np.array([entry[name] for entry in known])[:, None] for name in known[0]}
        vectors = len(next(iter(values.values())))
        at = stacked | {name: value[None] for name, value in values.items()}
        if start is None and runs[0].begins == "standing":
            start = self._standing(runs, at)
        elif start is None and runs[0].begins == "moving" and not (self.preset.is_linear or self.starts):
            start = self._standing(runs, at, [(run.command.mean(), run.measured.mean()) for run in runs])
        elif start is None and (runs[0].begins == "moving" or self._recorded(runs[0])):
            start = np.repeat(np.array([self.start(run) for run in runs])[:, None], vectors, axis=1)
        return Simulation(self.chain, runs, at, steps, start)

    # First states -----------------------------------------------------------------------------------------------

    def first_states(self, run: Run, values: Mapping[str, Array]) -> Array | None:
        """The states in which a run begins for values (1, v) of every symbol, (1, v, n); None where it is at rest."""
        if run.begins == "standing":
            return self._standing((run,), values)
        vectors = np.broadcast_shapes(*(np.shape(value) for value in values.values()))[1]
        known = run.begins == "moving" or self._recorded(run)
        return np.repeat(self.start(run)[None, None], vectors, axis=1) if known else None

    def _standing(self, runs: tuple[Run, ...], values: Mapping[str, Array], held: Sequence[Held] = ()) -> Array:
        """The states in which runs of one kind stand, (runs, v, n): at what is `held`, or as they do at first."""
        found = steady_states(self.preset, runs, values, held or [(run.command[0], run.measured[0]) for run in runs])
        for i, run in enumerate(runs):
            for state, value in self._recorded(run).items():
                found[i, :, state] = value
        return found

    def start(self, run: Run) -> Array:
        """What a run begins in, (n,), see :attr:`Chain.begun`: states that were recorded as they were."""
        found, recorded = self.starts.get(run.id, np.zeros(len(self.chain.begun))).copy(), self._recorded(run)
        found[list(recorded)] = list(recorded.values())
        return found

    def _recorded(self, run: Run) -> dict[int, float]:
        """The places of the states that were recorded, and where the run begins in them."""
        known = {state: run.channels[of] for state, of in self.preset.imposed.items() if of in run.channels}
        return {self.chain.states.index(state): float(samples[0]) for state, samples in known.items()}

    def _free(self, run: Run) -> NDArray[np.intp]:
        """The places of the first states that are to be found: of a run that starts moving those not recorded.

        None of a free run that begins as windows do.
        """
        if run.begins != "moving" or self.begun_over:
            return np.empty(0, np.intp)
        recorded = self._recorded(run)
        return np.array([state for state in range(len(self.chain.begun)) if state not in recorded], np.intp)

    def begin(self, values: Mapping[str, float]) -> None:
        """Take the first states that are not known yet from the linear model at `values`, or from its windows."""
        self._begin_as_windows_do(values)
        new = [run for run in self.runs if run.begins == "moving" and run.id not in self.starts]
        self.starts |= {run.id: self._guesses(run, values)[0] for run in new}

    def _begin_as_windows_do(self, values: Mapping[str, float]) -> None:
        """Find the first states that are not known yet over the windows, where a free run is begun over these."""
        new = tuple(run for run in self.runs if run.begins == "moving" and run.id not in self.starts)
        if self.begun_over and new:
            horizon, memory = self.begun_over
            over = replace(self, runs=new, begun_over=None, horizon=horizon, memory=memory, starts={})
            over.settle(values)
            self.starts |= over.starts

    def _guesses(self, run: Run, values: Mapping[str, float]) -> list[Array]:
        """First states (n,) of the linear model at `values`: the one with the smallest residual of a run first.

        Its best ones, and those that stand still at what is measured first where the chain is not linear: what a linear
        model makes of a machine in saturation may lie where no step leads back from. The offset counts with what is
        left: in saturation a position that is shifted changes nothing else. A motion that was given by its speed is
        guessed to go about the middle, where stops and play lie as far to either side: a linear model does not tell.
        """
        model = linear_model(self.preset.core, values, run, self.matrix.actuator)
        vector = {name: np.array([value]) for name, value in values.items()}
        steps = int(self.steps(vector).max())
        self.sizes = np.maximum(self.sizes, model.sizes(self.band)[0] * run.drive)
        self.unsized = (*self.unsized, (run, vector, steps))
        guesses = [first_state(run, model), *(() if self.preset.is_linear else model.standing_at(run.measured[0]))]
        start = np.zeros((1, len(guesses), len(self.chain.begun)))
        start[..., [self.chain.states.index(name) for name in self.preset.core.states]] = guesses
        for state in self.preset.imposed.keys() & self.chain.states:
            if self.preset.imposed[state] not in run.channels and "velocity" in run.channels:
                start[..., self.chain.states.index(state)] = first_position(run)
        start = self._with_followers(start, run, values)
        if start.shape[1] == 1:
            return list(start[0])
        vectors = {name: np.repeat(value, start.shape[1]) for name, value in values.items()}
        power = np.zeros(start.shape[1])
        with np.errstate(over="ignore", invalid="ignore"):
            for rows, first, last in self.simulation((run,), vectors, steps, start).outputs():
                power += np.sum((run.measured[first:last, None] - rows[:, 0]) ** 2, axis=0)
                if order_stays(power, rows[:, 0], run.measured[last:]):
                    break
        return list(start[0, in_order(power)])

    def _with_followers(self, start: Array, run: Run, values: Mapping[str, float]) -> Array:
        """Guesses (1, g, n) with, behind them, the same with states of effects where they have followed the machine."""
        own = [self.chain.states.index(name) for name in self._of_effects if name in self.chain.states]
        core = [self.chain.states.index(name) for name in self.preset.core.states]
        if not own:
            return start
        symbols = {**values, **conditions(run, self.matrix.actuator)}
        A = self.chain.linearise({name: symbols[name] for name in self.chain.symbols}, run.output).A
        return with_followers(start, A, own, core)

    @cached_property
    def _of_effects(self) -> list[str]:
        """What effects begin with in addition to the states of the core."""
        return [name for name in self.chain.begun if name not in self.preset.core.states]

    def _sizes_of_effects(self, run: Run, vector: Mapping[str, Array], steps: int) -> Array:
        """The largest value that each of them takes in a run that begins with none, (m,): in a unit of its own."""
        found, nothing = np.zeros(len(self._of_effects)), np.zeros((1, 1, len(self.chain.begun)))
        with np.errstate(over="ignore", invalid="ignore"):
            for i, name in enumerate(self._of_effects):
                simulation = self.simulation((run,), vector, steps, nothing)
                simulation = replace(simulation, chain=self.chain.showing(run.output, name))
                found[i] = max(float(np.abs(rows).max()) for rows, _, _ in simulation.outputs())
        return np.where(np.isfinite(found), found, 0.0)

    def goes_on(self, run: Run, settling: InitialStateEstimation, found: NormalMatrices) -> bool:
        """Whether a run goes on to better first states, which it then begins in."""
        if not len(self._free(run)):
            return False
        step = settling.step(run.id, self.start(run), found)
        if step is not None:
            self._follow(run, *step)
        return step is not None

    def _follow(self, run: Run, start: Array, step: Array) -> None:
        free = self._free(run)
        if len(step) and np.all(np.isfinite(step)):
            followed = start.copy()
            followed[free] += self._reach[free] * step
            self.starts[run.id] = np.clip(followed, -self._most, self._most)

    @property
    def _most(self) -> Array:
        """The largest first state of each: of an effect's own a few times what a run shows of it that begins with none.

        A mass that is next to nothing would else begin behind a spring that is stretched without bounds, and move the
        machine by itself.
        """
        most, own = np.full(len(self.chain.begun), np.inf), [self.chain.begun.index(name) for name in self._of_effects]
        most[own] = np.where(self._sized() > 0, _OF.of_effects * self._sized(), np.inf)
        return most

    def _sized(self) -> Array:
        """The sizes of what effects begin with, in all runs that have begun."""
        for begun in self.unsized:
            self.sizes_of_effects = np.maximum(self.sizes_of_effects, self._sizes_of_effects(*begun))
        self.unsized = ()
        return self.sizes_of_effects

    @cached_property
    def _reach(self) -> Array:
        """A small step of each state: of the size that it has, or where it has none of the output's."""
        reach = np.full(len(self.chain.begun), np.mean([np.std(run.measured) for run in self.runs]))
        for names, sizes in ((self.preset.core.states, self.sizes), (self._of_effects, self._sized())):
            known = [self.chain.begun.index(name) for name in names]
            reach[known] = np.where(sizes > 0, sizes, reach[known])
        return np.asarray(_OF.reach * reach, float)

    # Shares ------------------------------------------------------------------------------------------------------

    def together(
        self, vectors: int, steps: int, lanes: int = _TOGETHER, of: tuple[Run, ...] | None = None
    ) -> Iterator[tuple[Run, ...]]:
        """Runs to simulate in one go, of one length, rate, output, start and recorded states; cores share long ones."""
        groups: dict[tuple[object, ...], list[Run]] = {}
        for run in self.runs if of is None else of:
            begun = (run.begins, *self._recorded(run))
            groups.setdefault((run.length, run.sample_rate, run.output, *begun), []).append(run)
        for runs in groups.values():
            most = max(1, lanes // vectors)
            shares = -(-len(runs) // most)
            if sum(run.length for run in runs) * vectors * steps >= LEAST_SHARED:
                shares = min(len(runs), max(shares, cores()))
            for share in np.array_split(np.arange(len(runs)), shares):
                yield tuple(runs[i] for i in share)

    def steps(self, values: Mapping[str, Array], kinks: bool = True, of: Chain | None = None) -> NDArray[np.int64]:
        """Steps a sample for each vector; `of` a chain that shows more than the own, where one is given.

        Of decimated runs it is a sample of theirs, and modes are as much faster in it.
        """
        every = min((run.every for run in self.runs), default=1)
        found = every * self.fastest(values, of)
        kinds = {(run.hold, every * self.band / run.sample_rate) for run in self.matrix.runs}
        on = [effect for effect in self.preset.effects if kinks and self._is_on(effect, values)]
        least = self.preset.steps if kinks and not self.roughly else 1
        needed = [steps_needed(of or self.chain, found, hold, on, band, least, every) for hold, band in kinds]
        if not self.roughly:
            needed += [
                self._reversals.steps(p.at_reversals, values[p.in_equations], values.get("m0"), every)
                for effect in on
                for p in effect.added
                if p.at_reversals is not None
            ]
        return np.asarray(np.max(needed, axis=0))

    @cached_property
    def _reversals(self) -> Reversals:
        """What the records tell of the reversals of their motion."""
        return Reversals.of(self.matrix.runs, self.band, self._motion.get("x", 0.0))

    def fastest(self, values: Mapping[str, Array], of: Chain | None = None) -> Modes:
        """Each vector's fastest mode in radians a sample, of the linear core and the effects at small signals.

        At rest and in motion. Beyond :data:`ident.simulation.steps.FASTEST` it is followed only roughly.
        """
        chain, last = of or self.chain, self._last_modes
        asked = (*(value.tobytes() for value in values.values()), *values, chain)
        if last is None or last[0] != asked:
            found = fastest(chain, self._extreme, self.matrix.actuator, values, self._motion)
            last = self._last_modes = asked, found
        return last[1]

    @cached_property
    def _motion(self) -> dict[str, float]:
        """How far the moving mass goes, and how fast."""
        return motion(self.matrix.runs, self.band)

    def _is_on(self, effect: Effect, values: Mapping[str, Array]) -> bool:
        """Whether an effect has a strength that is not zero."""
        return bool(np.any(values[effect.added[0].in_equations]))

    @cached_property
    def _extreme(self) -> tuple[Run, ...]:
        """The runs of the whole matrix on which modes are fastest: whatever part of it is simulated has their steps."""
        return extreme(self.matrix.runs)


def is_simulated(preset: Preset, matrix: Matrix) -> bool:
    """Whether a fit simulates its runs: one of a linear model that settles reduces them instead."""
    return not preset.is_linear or integrates(preset.chain, matrix.of_use("fit") or matrix.runs, matrix.actuator)


def every_run(preset: Preset, matrix: Matrix) -> SimulatedRuns:
    """All runs of a matrix; those that fit it, where there are some, say what its commands excite."""
    return SimulatedRuns(preset, matrix, matrix.runs, excited_band(matrix.of_use("fit") or matrix.runs))
