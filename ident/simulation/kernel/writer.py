"""The body of a kernel: inputs, the four stages of a Runge-Kutta step, dry friction, and what remembers."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ident.chain.chain import INPUT, INPUT_RATE, MEASURED, STEP
from ident.chain.dry_friction import dry_friction
from ident.equations.equation import Equation
from ident.equations.grammar import TIME, tree_of
from ident.simulation.kernel.layout import BEYOND, HELD, SHARE, Filter, Kernel, filter_rows
from ident.simulation.kernel.machine_code import LANES
from ident.simulation.kernel.source import Source, named

STAGES = (1, 2, 3, 4)
_GIVEN_RATE = "u_rate"


@dataclass
class Writer(Source):
    """Writes the source of a kernel."""

    filters: dict[str, Filter] = field(default_factory=dict)
    shift: ast.expr | None = None
    keys: dict[tuple[str, ...], str] = field(default_factory=dict)
    beside: tuple[str, ...] = ()
    followers: frozenset[str] = frozenset()
    """States that the chain writes as lags: their rows are those of the filters."""
    recorded: bool = False

    def kernel(self) -> Kernel:
        """The kernel of the chain for the output."""
        chain = self.chain
        needed, rates = self._folded()
        states = {name: self._row() for name in chain.states}
        memories = {name: self._row() for name in chain.memories}
        read = frozenset().union(*(e.names for e in (*needed, *rates)))
        given = {INPUT, *read.intersection(MEASURED), *({INPUT_RATE, BEYOND} if self._is_given(needed) else ())}
        inputs = {name: self._row(3) for name in (INPUT, INPUT_RATE, BEYOND, *MEASURED) if name in given}
        shown, beside = self._row(), {channel: self._row() for channel in self.beside}
        body = self._body(needed, rates, states, memories, inputs, {self.output: shown} | beside)
        states |= {lag.target: self._row_of(lag) for lag in needed if lag.target in self.followers}
        loads = [f"c{row} = b[{row * LANES} + lane]" for row, _ in self.constants.values()]
        return Kernel(
            chain,
            self.output,
            (*loads, *body),
            self.rows,
            tuple(self.constants.values()),
            tuple(self.filters.values()),
            states,
            memories,
            inputs,
            self.shift,
            shown,
            beside,
        )

    def _is_given(self, needed: Sequence[Equation]) -> bool:
        """Whether rate and bends of the command are inputs: the output reads the rate, and no delay shifts it."""
        shown = self.chain.signal(self.output)
        of_output = any(equation.target == shown and INPUT_RATE in equation.names for equation in needed)
        return self.recorded and of_output and not any("delay(" in ast.unparse(equation.tree) for equation in needed)

    def _row_of(self, lag: Equation) -> int:
        """The row of the state of an equation ``s = lag(E, T)``."""
        arguments = tuple(ast.unparse(argument) for argument in lag.tree.args)  # type: ignore[attr-defined]
        return self.filters[self.keys[arguments]].first

    def _folded(self) -> tuple[list[Equation], list[Equation]]:
        """Signals and rates, with the signals that never change put in where they are read."""
        fixed: dict[str, ast.expr] = {}
        kept = []
        for original in self.chain.needed(self.output, *self.beside):
            found, equation = dry_friction(original), original.with_values(fixed)
            if found and isinstance(limit := fixed.get(found[0]), ast.Constant) and not limit.value:
                fixed[equation.target] = ast.Constant(0.0)
                continue
            bare = isinstance(equation.tree, ast.Constant | ast.Name) and equation.names <= {*self._symbols, INPUT}
            if (bare or self._is_constant(equation.tree)) and not equation.is_memory:
                fixed[equation.target] = equation.tree
            else:
                kept.append(equation)
        rates = [e.with_values(fixed) for e in self.chain.equations if e.is_rate]
        for shown in dict.fromkeys(map(self.chain.signal, (self.output, *self.beside))):
            if shown in fixed:
                kept.append(Equation(f"{shown} = {ast.unparse(fixed[shown])}"))
        return kept, rates

    def _body(
        self,
        needed: Sequence[Equation],
        rates: Sequence[Equation],
        states: Mapping[str, int],
        memories: Mapping[str, int],
        inputs: Mapping[str, int],
        shown: Mapping[str, int],
    ) -> list[str]:
        self.lines = []
        for name, row in [*states.items(), *((f"{name}__old", row) for name, row in memories.items())]:
            self._write(f"{name}_1" if name in states else name, f"b[{row * LANES} + lane]")
        step = self._constant(named(STEP))
        half, sixth = self._text(f"0.5 * {STEP}"), self._text(f"{STEP} / 6.0")
        self._inputs(inputs)
        if TIME in frozenset().union(*(e.names for e in (*needed, *rates))):
            self._time(step)
        for stage in STAGES:
            if stage > 1:
                for name in states:
                    before = f"{half} * {name}_k{stage - 1}" if stage < 4 else f"{step} * {name}_k3"
                    self._write(f"{name}_{stage}", f"{name}_1 + {before}")
            self._stage(needed, str(stage))
            for equation in rates:
                self._write(f"{equation.target}_k{stage}", self._lower(equation.tree, str(stage)))
        for channel, row in shown.items():
            self._write(f"b[{row * LANES} + lane]", self._name(self.chain.signal(channel), "1"))
        for name, row in states.items():
            slope = f"{name}_k1 + 2.0 * ({name}_k2 + {name}_k3) + {name}_k4"
            self._write(f"b[{row * LANES} + lane]", f"{name}_1 + {sixth} * ({slope})")
        for name, row in memories.items():
            self._write(f"b[{row * LANES} + lane]", f"{name}_4")
        for key, known in self.filters.items():
            for i in range(known.order):
                self._write(f"b[{(known.first + i) * LANES} + lane]", f"{key}_{'zp'[i]}_4")
        for row in inputs.values():
            self._write(f"b[{row * LANES} + lane]", f"b[{(row + 1) * LANES} + lane]")
            self._write(f"b[{(row + 1) * LANES} + lane]", f"b[{(row + 2) * LANES} + lane]")
        return self.lines

    # Inputs ----------------------------------------------------------------------------------------------------

    def _inputs(self, inputs: Mapping[str, int]) -> None:
        """The inputs at start, middle and end of the step.

        A delayed command bends inside the step: its middle value is chosen so that Simpson's rule, which the
        Runge-Kutta step is for an input, gives its exact integral. A held command with a delay takes its mean.
        """
        inverse = self._text(f"1.0 / {STEP}")
        held, share = self._constant(named(HELD)), self._constant(named(SHARE))
        for name, row in sorted(inputs.items(), key=lambda one: one[0] == INPUT):  # its rate goes before it
            for i, part in enumerate(("before", "now", "then")):
                self._write(f"{name}_{part}", f"b[{(row + i) * LANES} + lane]")
            if name == INPUT:
                self._write(f"{name}_1", f"{name}_now + {share} * ({name}_before - {name}_now)")
                self._write("u_end", f"{name}_then + {share} * ({name}_now - {name}_then)")
                beyond = f" + {BEYOND}_now" if BEYOND in inputs else ""
                self._write("u_area", f"0.5 * ({name}_now + {share} * {name}_1 + (1.0 - {share}) * u_end){beyond}")
                self._write("u_middle", f"0.25 * (6.0 * u_area - {name}_1 - u_end)")
                for stage, value in ((2, "u_middle"), (3, "u_middle"), (4, "u_end")):
                    self._write(f"{name}_{stage}", f"{value} + {held} * ({name}_1 - {value})")
                self._write("u_rise", f"{inverse} * (u_end - {name}_1)")
                self._write("u_jump", f"{inverse} * ({name}_now - {name}_before)")
                self._write("u_next", f"{inverse} * ({name}_then - {name}_now)")
                between = "0.5 * (u_jump + u_next)"
                for stage, value in ((1, "u_jump"), (2, between), (3, between), (4, "u_next")):
                    rise = f"{_GIVEN_RATE}_{stage}" if INPUT_RATE in inputs else "u_rise"
                    self._write(f"{INPUT_RATE}_{stage}", f"{rise} + {held} * ({value} - {rise})")
            else:
                of = _GIVEN_RATE if name == INPUT_RATE else name
                self._write(f"{of}_1", f"{name}_now")
                self._write(f"{of}_2", f"0.5 * ({name}_now + {name}_then)")
                self._write(f"{of}_3", f"{of}_2")
                self._write(f"{of}_4", f"{name}_then")

    def _time(self, step: str) -> None:
        """The time since the record's start at each stage."""
        for stage, of_step in zip(STAGES, ("k", "(k + 0.5)", "(k + 0.5)", "(k + 1)"), strict=True):
            self._write(f"{TIME}_{stage}", f"{of_step} * {step}")

    # Stages ----------------------------------------------------------------------------------------------------

    def _stage(self, needed: Sequence[Equation], stage: str) -> None:
        for equation in needed:
            found = dry_friction(equation)
            if found and stage == "1":
                self._friction(equation.target, found, needed)
            elif found:
                self._write(f"{equation.target}_{stage}", f"{equation.target}_1")
            else:
                self._write(f"{equation.target}_{stage}", self._lower(equation.tree, stage))

    def _friction(self, force: str, found: tuple[str, str, str, str], needed: Sequence[Equation]) -> None:
        """Dry friction as its mean over the step.

        Without friction the mass would have the acceleration a. If it goes on sliding, friction has its limit. If it
        stops inside the step it either stays, and friction takes just the momentum that is there, or it turns, after
        the share θ of the step, and friction with it. Where the limit depends on the speed it is taken in mid-step.
        """
        limit, speed, acceleration, mass = (tree_of(text) for text in found)
        self._write(f"{force}_f", "0.0")
        for equation in _behind(_names(acceleration), needed, {force}):
            self._write(f"{equation.target}_f", self._lower(equation.tree, "f"))
        free = self._temporary(self._lower(acceleration, "f"))
        v, m = self._temporary(self._lower(speed, "1")), self._temporary(self._lower(mass, "1"))
        of_limit = _behind(_names(limit), needed, {force})
        for stage in ("1", "m") if _names(speed) & frozenset().union(*(e.names for e in of_limit)) else ("1",):
            if stage == "m":
                middle = f"{v} + {self._text(f'0.5 * {STEP}')} * ({free} - {force}_1 / {m})"
                self._write(f"{next(iter(_names(speed)))}_m", middle)
                for equation in of_limit:
                    self._write(f"{equation.target}_m", self._lower(equation.tree, "m"))
            top = self._temporary(self._lower(limit, stage))
            self._write(f"{force}_1", self._mean_friction(top, v, free, m))

    def _mean_friction(self, top: str, v: str, a: str, m: str) -> str:
        drive = self._temporary(f"{m} * {a}")
        momentum = self._temporary(f"{m} * {self._text(f'1.0 / {STEP}')} * {v}")
        against = f"(-1.0 if {drive} > 0.0 else 1.0)"
        s = self._temporary(f"1.0 if {v} > 0.0 else (-1.0 if {v} < 0.0 else {against})")
        stops = self._temporary(f"{momentum} + {drive}")
        pushed = self._temporary(f"{drive} if {drive} > 0.0 else -{drive}")
        turned = self._temporary(f"{s} * {top} * (2.0 * {s} * {momentum} / ({pushed} + {top} + 1e-300) - 1.0)")
        return f"{s} * {top} if {s} * {stops} > {top} else ({stops} if {pushed} <= {top} else {turned})"

    # What remembers --------------------------------------------------------------------------------------------

    def _dynamic(self, name: str, arguments: Sequence[ast.expr], stage: str) -> str:
        x, *parameters = arguments
        if name == "delay" and isinstance(x, ast.Name) and x.id == INPUT:
            self.shift = parameters[0]
            return f"{INPUT}_{'1' if stage == 'f' else stage}"
        if name == "delay":  # the Padé approximant of second order; T → 0 is an exact identity
            T = parameters[0]
            a1 = ast.BinOp(ast.Constant(0.5), ast.Mult(), T)
            a2 = ast.BinOp(ast.BinOp(T, ast.Mult(), T), ast.Div(), ast.Constant(12.0))
            key, value = self._filter(x, (a1, a2), stage)
            return f"({value} - {self._constant(T)} * {key}_p_{stage})"
        key, _ = self._filter(x, tuple(parameters), stage)
        return f"{key}_z_{stage}"

    def _filter(self, x: ast.expr, coefficients: tuple[ast.expr, ...], stage: str) -> tuple[str, str]:
        """Write one stage of a filter; its name, and its input at this stage."""
        order = len(coefficients)
        what = (ast.unparse(x), *map(ast.unparse, coefficients))
        key = self.keys.setdefault(what, f"g{len(self.keys)}")
        if key not in self.filters:
            self.filters[key] = Filter(order, x, coefficients, self._row(filter_rows(order)))
        known = self.filters[key]
        value = f"{key}_x_{stage}"
        self._write(value, self._lower(x, stage))
        memory = [f"b[{(known.first + i) * LANES} + lane]" for i in range(order)]
        if stage == "4":  # their errors of second order cancel
            self._write(f"{key}_x_m", f"0.5 * ({key}_x_2 + {key}_x_3)")
        inputs = {"f": "f", "1": "1", "m": "1m", "2": "12", "3": "13", "4": "1m4"}[stage]
        terms = [*memory, *(f"{key}_x_{of}" for of in inputs)]
        first = known.first + order + sum(order * (order + before) for before in range(1, len(inputs)))
        for i in range(order):
            row = first + i * len(terms)
            gains = [f"b[{(row + j) * LANES} + lane]" for j in range(len(terms))]
            self._write(f"{key}_{'zp'[i]}_{stage}", " + ".join(f"{g} * {t}" for g, t in zip(gains, terms, strict=True)))
        return key, value


def _names(node: ast.expr) -> frozenset[str]:
    return frozenset(n.id for n in ast.walk(node) if isinstance(n, ast.Name))


def _behind(names: frozenset[str], equations: Sequence[Equation], but: set[str]) -> list[Equation]:
    """The equations that these names depend on, in order."""
    wanted, found = set(names), []
    for equation in reversed(equations):
        if equation.target in wanted and equation.target not in but:
            found.append(equation)
            wanted |= equation.names
    return found[::-1]
