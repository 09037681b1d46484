"""The chain: stages and effects put together into one model, and its linearisation.

A chain is a set of equations. Each state has a rate, each memory and signal an expression; signals are put in an
order in which every one is known before it is read, so that loops (feedback, pressure against flow) close through
states only.
"""

from __future__ import annotations

import ast
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from functools import lru_cache
from graphlib import CycleError, TopologicalSorter
from types import CodeType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.channels import BESIDE_MEAN, read_whole
from ident.chain.conditions import conditions, zeros
from ident.chain.dry_friction import dry_friction
from ident.chain.linearity import LINEAR, OTHER, ZERO, degree
from ident.chain.refused_effects import of_other_unit, of_state, unfit
from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.equations.grammar import ARITHMETIC, TIME
from ident.errors import Unusable
from ident.linear import LinearModel
from ident.matrix import Actuator
from ident.run import Run
from ident.stages import Stage
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
INPUT, INPUT_RATE, FORCE, DISTURBANCE, STEP = "u", "du", "fm", "dm", "dt"
"""What drives a chain: the command, its rate, a measured force or disturbance; and the step of the simulation."""
SUPPLY, VERTICAL = "dPs", "dNv"
"""What a measured supply pressure (Pa) and vertical load (N) are beside their mean, which is a condition of the run."""
MEASURED = (FORCE, DISTURBANCE, SUPPLY, VERTICAL, *BESIDE_MEAN)
"""The inputs beside the command."""
_SMALL, _SHARE = 1e-9, 1e-7  # of a unit, and of what stands there: the step of slopes
Evaluator = Callable[..., tuple[tuple[Any, ...], Any]]
"""The function (u, states, values) → (rates, output) of a chain."""
_TOGETHER = 2048  # numbers of a signal that are worked out at once: more are slower, by what they take of the cache


@dataclass(frozen=True)
class Chain:
    """Stages in the order of the signal, the signal that each recordable channel shows, and the effects added.

    `about` names states, or the command, that are not at zero where small signals are taken, with what they are there:
    a valve with overlap answers none at rest.
    Raises Unusable where an effect finds nothing to act on, or a signal in another unit than it is made for.
    """

    stages: tuple[Stage, ...]
    outputs: Mapping[str, str]
    effects: tuple[Effect, ...] = ()
    about: tuple[tuple[str, str], ...] = ()

    def __post_init__(self) -> None:
        places = {stage.place for stage in self.stages}
        for effect in self.effects:
            if effect.place not in places or not self._core & {equation.target for equation in effect.equations}:
                raise unfit(effect)
            for signal, unit in effect.units.items():
                if unit and self.units.get(signal, unit) != unit:
                    raise of_other_unit(effect, signal, self.units[signal])

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash((self.stages, tuple(self.outputs.items()), self.effects, self.about))

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name != "_hash"}  # another in each process

    def with_effects(self, effects: tuple[Effect, ...]) -> Chain:
        """The chain with these effects instead of its own: one object each time, which keeps what it worked out."""
        return _with_effects(self, effects)

    def showing(self, channel: str, quantity: str) -> Chain:
        """The chain whose channel shows another quantity: one object each time, which keeps what it worked out."""
        return _showing(self, channel, quantity)

    @cached_property
    def _core(self) -> frozenset[str]:
        return frozenset(equation.target for stage in self.stages for equation in stage.equations)

    @cached_property
    def _core_states(self) -> frozenset[str]:
        return frozenset(e.target for stage in self.stages for e in stage.equations if e.is_rate)

    @cached_property
    def units(self) -> Mapping[str, str]:
        """The unit of each state and signal, as its stage states it."""
        return {quantity.name: quantity.unit for stage in self.stages for quantity in stage.publishes}

    @property
    def has_oil(self) -> bool:
        """Whether one of its quantities is a pressure."""
        return "Pa" in self.units.values()

    @cached_property
    def equations(self) -> tuple[Equation, ...]:
        """Every equation, stage by stage, each with the effects of its place behind it.

        A signal that effects redefine has its last definition under its own name, those before as name__0, name__1 …
        An effect's own quantities are called effect__name, a memory's value at the start of the step name__old.
        """
        return tuple(self._assembled())

    def _assembled(self) -> Iterator[Equation]:
        entries: list[tuple[Effect | None, Equation]] = []
        for stage in self.stages:
            entries += [(None, equation) for equation in stage.equations]
            entries += [(e, equation) for e in self.effects if e.place == stage.place for equation in e.equations]
        total = Counter(equation.target for _, equation in entries if equation.target in self._core)
        so_far: Counter[str] = Counter()

        def version(target: str, number: int) -> str:
            return target if number == total[target] - 1 else f"{target}__{number}"

        for effect, written in entries:
            equation, target, names = written, written.target, {}
            if effect is not None:
                names = effect.names_in(equation, self._core)
                redefined = {e.target for e in effect.equations} & self._core
                names |= {name: version(name, so_far[name] - 1) for name in redefined & equation.names}
                equation = read_whole(written, self._core | names.keys())
            if target in self._core:
                if so_far[target] and (equation.is_rate or equation.is_memory or target in self._core_states):
                    raise of_state(effect, target) if effect else AssertionError(target)
                own = version(target, so_far[target])
                so_far[target] += 1
            else:
                own = effect.symbol(target) if effect else target
            yield equation.renamed(names, own)

    @cached_property
    def states(self) -> tuple[str, ...]:
        """Names of the states, in the order of the state vector."""
        return tuple(equation.target for equation in self.equations if equation.is_rate)

    @cached_property
    def memories(self) -> tuple[str, ...]:
        """Names of the memories."""
        return tuple(equation.target for equation in self.equations if equation.is_memory)

    @cached_property
    def remembered(self) -> tuple[str, ...]:
        """Names of the memories that go on from their own past, as a friction's, and not only copy a signal."""
        own = (equation for equation in self.equations if equation.is_memory)
        return tuple(equation.target for equation in own if f"{equation.target}__old" in equation.names)

    @property
    def begun(self) -> tuple[str, ...]:
        """What a run that starts moving begins in: the states, then by how much what remembers is off its rest."""
        return (*self.states, *self.remembered)

    @cached_property
    def symbols(self) -> tuple[str, ...]:
        """What the equations read but do not define: parameters and conditions."""
        defined = {equation.target for equation in self.equations} | {f"{name}__old" for name in self.memories}
        read = frozenset().union(*(equation.names for equation in self.equations))
        return tuple(sorted(read - defined - {INPUT, INPUT_RATE, *MEASURED, STEP, TIME}))

    @cached_property
    def signals(self) -> tuple[Equation, ...]:
        """The equations of signals and memories, each after those that it reads.

        Raises Unusable where signals depend on each other in a circle without a state between them.
        """
        equations = {equation.target: equation for equation in self.equations if not equation.is_rate}
        needs = {name: _needs(equation) & equations.keys() for name, equation in equations.items()}
        try:
            order = tuple(TopologicalSorter(needs).static_order())
        except CycleError as error:
            circle = " → ".join(error.args[1])
            raise Unusable("algebraic-loop", f"{circle} has no state", "chain", "put a lag between them") from None
        return tuple(equations[name] for name in order)

    @cached_property
    def is_linear(self) -> bool:
        """Whether the command alone drives equations that are linear in it and in the states.

        What was measured is a second input, and what remembers or depends on time is not linear in this sense.
        """
        if self.memories:
            return False
        known = dict.fromkeys((*self.states, INPUT, INPUT_RATE), LINEAR) | dict.fromkeys((*MEASURED, TIME), OTHER)
        for equation in self.signals:
            dry = dry_friction(equation)
            off = dry is not None and known.get(dry[0]) == ZERO
            known[equation.target] = ZERO if off else degree(equation.tree, known)
        needed = {name for output in self.outputs for name in (e.target for e in self.needed(output))}
        found = [degree(equation.tree, known) for equation in self.equations if equation.is_rate]
        return all(one in (ZERO, LINEAR) for one in found) and all(known[name] != OTHER for name in needed)

    def signals_at(self, known: Mapping[str, Any]) -> dict[str, Any]:
        """Every signal beside what is `known`: states, inputs, symbols, and memories at the start of the step.

        Dry friction takes nothing here: what it takes hangs on the step.
        """
        values = dict(known)
        exec(self._signals_in_turn, ARITHMETIC, values)  # own text, each name checked: equations.equation
        return values

    @cached_property
    def _signals_in_turn(self) -> CodeType:
        lines = (f"{equation.target} = {_still(equation)}" for equation in self.signals)
        return compile("\n".join(lines), "<signals>", "exec")

    @cached_property
    def exponents(self) -> tuple[str, ...]:
        """Symbols that stand as exponents."""
        powers = (node for e in self.equations for node in ast.walk(e.tree) if isinstance(node, ast.BinOp))
        names = {p.right.id for p in powers if isinstance(p.op, ast.Pow) and isinstance(p.right, ast.Name)}
        return tuple(sorted(names & set(self.symbols)))

    def needed(self, *outputs: str) -> tuple[Equation, ...]:
        """Of the signals, in order, those that the rates, the memories or the channels `outputs` depend on."""
        wanted = {*map(self.signal, outputs), *self.memories}
        wanted |= frozenset().union(*(equation.names for equation in self.equations if equation.is_rate))
        kept = []
        for equation in reversed(self.signals):
            if equation.target in wanted:
                kept.append(equation)
                wanted |= equation.names
        return tuple(reversed(kept))

    def reads(self, name: str) -> bool:
        """Whether a rate or memory depends on a quantity, or calls a function of this name."""
        return name in self._read

    @cached_property
    def _read(self) -> frozenset[str]:
        """Every quantity and function that a rate, a memory or the first output depends on."""
        needed = (*self.needed(next(iter(self.outputs))), *(e for e in self.equations if e.is_rate))
        return frozenset(n.id for e in needed for n in ast.walk(e.tree) if isinstance(n, ast.Name))

    def signal(self, output: str) -> str:
        """The signal that the channel `output` shows; raises Unusable with the channels there are."""
        if output not in self.outputs:
            raise Unusable(
                "unknown-output",
                f"the model does not produce {output!r}",
                "output of a run",
                did_you_mean(output, self.outputs, f"choose one of {', '.join(self.outputs)} or another model"),
            )
        return self.outputs[output]

    @cached_property
    def _evaluators(self) -> dict[str, Evaluator]:
        return {}

    def evaluator(self, output: str) -> Evaluator:
        """The function (u, states, values) → (rates, output), compiled once from the checked equations.

        `values` maps the names in :attr:`symbols` to numbers or arrays that broadcast against the states.
        """
        if output not in self._evaluators:
            needed = self.needed(output)
            read = frozenset().union(*(e.names for e in (*needed, *(e for e in self.equations if e.is_rate))))
            lines = [f"    {name} = values[{name!r}]" for name in self.symbols if name in read]
            lines += [
                f"    ({', '.join(self.states)},) = states",
                f"    {' = '.join((INPUT_RATE, *MEASURED, STEP, TIME))} = 0.0",
            ]
            lines += [f"    {name}__old = 0.0" for name in self.memories]
            lines += [f"    {equation.target} = {_still(equation)}" for equation in needed]
            rates = ", ".join(equation.python for equation in self.equations if equation.is_rate)
            returned = f"    return ({rates},), {self.signal(output)}"
            source = "\n".join(["def evaluate(u, states, values):", *lines, returned])
            namespace = dict(ARITHMETIC)
            exec(compile(source, "<chain>", "exec"), namespace)  # own text, each name checked: equations.equation
            self._evaluators[output] = namespace["evaluate"]
        return self._evaluators[output]

    def linearise(
        self, values: Mapping[str, Array | float], output: str = "displacement", about: Sequence[Any] | None = None
    ) -> LinearModel:
        """State matrices: where the equations are linear exact, by applying them to unit vectors.

        Else they are the slopes about an operating point, the states and the command `about` (n + 1 numbers; that of
        the chain where None), over a step of 1e-9 of a unit: a kink that lies there is seen from its larger side.
        `values` holds every symbol, as numbers or arrays of one broadcast shape, which with that of `about` is that of
        the batch whether the equations read them all or not; `output` is a channel's name.
        """
        about = about or self.operating_point(values)
        shape = np.broadcast_shapes(*(np.shape(value) for value in (*values.values(), *about)))
        system, together = np.zeros((len(about), len(about), *shape)), max(1, _TOGETHER // max(math.prod(shape), 1))
        units = np.eye(len(about)).reshape(len(about), len(about), *[1] * len(shape))
        columns = self._columns(self.evaluator(output), values, about)
        for begin in range(0, len(about), together):
            some = slice(begin, begin + together)
            for row, column in zip(system, columns(units[:, some]), strict=True):
                row[some] = column
        return LinearModel(system)

    def operating_point(self, values: Mapping[str, Any], moved: Mapping[str, float] | None = None) -> list[Any]:
        """States and command where small signals are taken; those of the states that are `moved` as given."""
        at = {name: Equation(f"{name} = {text}").value(values) for name, text in self.about} | dict(moved or {})
        return [at.get(name, 0.0) for name in (*self.states, INPUT)]

    def _columns(
        self, evaluate: Evaluator, values: Mapping[str, Any], about: Sequence[Any]
    ) -> Callable[[Any], Iterable[Any]]:
        """Each rate and the output by the states and the command, along m directions (n + 1, m, ...) at once."""

        def signals(at: Any) -> tuple[Any, ...]:
            rates, shown = evaluate(at[-1], at[:-1], values)
            return (*rates, shown)

        def slopes(directions: Array) -> Iterator[Any]:
            moved = [step * unit for step, unit in zip(steps, directions, strict=True)]
            there = signals([value + step for value, step in zip(about, moved, strict=True)])
            wide = sum(moved)  # of the steps along a direction one alone is not zero
            return ((a - b) / wide for a, b in zip(there, rest, strict=True))

        if self.is_linear:
            return signals
        rest, steps = signals(about), [np.maximum(_SMALL, _SHARE * np.abs(there)) for there in about]
        return slopes

    def pattern(self, output: str) -> tuple[tuple[bool, ...], ...]:
        """Which entries of the system matrix can be other than zero, found at generic values of every symbol."""
        return tuple(tuple(row) for row in (self._generic(output, frozenset()) != 0).tolist())

    def _generic(self, output: str, off: AbstractSet[str]) -> Array:
        """The system matrix at generic values of every symbol but those `off`, which are 0, (n + 1, n + 1)."""
        generic = {name: 0.0 if name in off else np.sqrt(2.0 + i) for i, name in enumerate(self.symbols)}
        return self.linearise(generic, output).system

    def integrates(self, output: str, off: AbstractSet[str]) -> bool:
        """Whether an output has a pole at zero whatever the parameters are, where the symbols `off` are 0.

        A cylinder that no loop and no spring holds integrates its flow: no value of a parameter makes it settle.
        """
        states = np.array(self.observed(output, off), dtype=np.intp)
        seen = self._generic(output, off)[np.ix_(states, states)]
        return bool(len(states) and np.linalg.matrix_rank(seen) < len(states))

    def observed(self, output: str, off: AbstractSet[str]) -> tuple[int, ...]:
        """The states that an output depends on, by their places, where the symbols `off` are 0.

        Without a spring a pressure knows no position: that state integrates beside the rest of the machine.
        """
        reads, states = self._generic(output, off) != 0, len(self.states)
        found = {j for j in range(states) if reads[states, j]}
        while more := {j for i in found for j in range(states) if reads[i, j]} - found:
            found |= more
        return tuple(sorted(found))


@lru_cache(maxsize=1024)
def _with_effects(chain: Chain, effects: tuple[Effect, ...]) -> Chain:
    return replace(chain, effects=effects)


@lru_cache(maxsize=256)
def _showing(chain: Chain, channel: str, quantity: str) -> Chain:
    return replace(chain, outputs={**chain.outputs, channel: quantity})


def integrates(chain: Chain, runs: Iterable[Run], actuator: Actuator) -> bool:
    """See :meth:`Chain.integrates`: under the conditions of any of the runs."""
    return any(chain.integrates(output, off) for output, off in {(run.output, zeros(run, actuator)) for run in runs})


def settles(chain: Chain, values: Mapping[str, float], run: Run, actuator: Actuator) -> bool:
    """Whether what a run shows of the linearised chain settles: states that it does not depend on do not count."""
    seen = chain.observed(run.output, zeros(run, actuator))
    A = linear_model(chain, values, run, actuator).of_states(seen).A
    return bool(np.linalg.eigvals(A).real.max(initial=-np.inf) < 0)


def linear_model(chain: Chain, values: Mapping[str, float], run: Run, actuator: Actuator) -> LinearModel:
    """The linearised chain under the conditions of a run, as a batch of one."""
    known = conditions(run, actuator) | dict(values)
    return chain.linearise({name: np.array([known[name]]) for name in chain.symbols}, run.output)


def _needs(equation: Equation) -> frozenset[str]:
    """What must be known before: dry friction does not wait for the acceleration, which is found without it first."""
    found = dry_friction(equation)
    return frozenset({found[0], found[3]}) if found else equation.names


def _still(equation: Equation) -> str:
    return "0.0" if dry_friction(equation) else equation.python
