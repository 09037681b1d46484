"""The compiled simulation of a chain with its effects: generated from the equations, one vector a SIMD lane.

Classical Runge-Kutta steps of order 4, sixteen systems side by side. What an equation writes with `lag`, `lag2` and
`delay` is advanced exactly over each stage for an input that is a parabola through its values every half step, so that
a time constant may go to zero without making the equations stiff, and is an exact identity there. Dry friction is a
force held over a step: what would stop the mass at its end, at most the limit; so it sticks.

One flat buffer holds everything at constant offsets, and comparisons stand for min, max, abs and sgn: only so does the
compiler see that nothing overlaps and put the lanes side by side.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.chain import FORCE, INPUT, INPUT_RATE, STEP, Chain, friction
from ident.compiled import function
from ident.expression import DYNAMIC, FUNCTIONS, Equation

Array = NDArray[np.float64]
LANES = 16
STAGES = (1, 2, 3, 4)


@dataclass(frozen=True)
class Filter:
    """One `lag` or `lag2` of the equations: its row of memory, its rows of coefficients, and its coefficients' source."""

    order: int
    input: ast.expr
    coefficients: tuple[ast.expr, ...]  # T, or a1 and a2: expressions of symbols only
    first: int  # of the rows that it has in the buffer


@dataclass(frozen=True)
class Kernel:
    """The generated kernel of a chain and one output, and where things are in its buffer (rows of lanes).

    `advance(b, commands, forces, where, first, last, every, out, stride)` takes the buffer b over the steps first to
    last − 1 and writes the output of every `every`-th of them to the flat array out, rows `stride` apart. Step k of a
    lane reads its inputs at where[lane] + k.
    """

    chain: Chain
    output: str
    source: str
    rows: int
    constants: tuple[tuple[int, ast.expr], ...]
    filters: tuple[Filter, ...]
    states: Mapping[str, int]
    memories: Mapping[str, int]
    inputs: Mapping[str, int]  # the rows previous, current, next begin here, one triple an input
    shift: ast.expr | None  # delay of the command

    @property
    def advance(self) -> Callable[..., None]:
        """The compiled function."""
        return function("advance", self.source)


@lru_cache(maxsize=64)
def kernel(chain: Chain, output: str, plain: frozenset[tuple[str, float]] = frozenset()) -> Kernel:
    """The kernel of a chain for one output; `plain` are symbols that stand as numbers in the code."""
    return _Writer(chain, output, dict(plain)).kernel()


@dataclass
class _Writer:
    """Writes the source of a kernel."""

    chain: Chain
    output: str
    plain: Mapping[str, float]
    lines: list[str] = field(default_factory=list)
    constants: dict[str, tuple[int, ast.expr]] = field(default_factory=dict)
    filters: dict[str, Filter] = field(default_factory=dict)
    rows: int = 0
    temporaries: int = 0
    shift: ast.expr | None = None
    written: set[str] = field(default_factory=set)
    keys: dict[tuple[str, ...], str] = field(default_factory=dict)

    def kernel(self) -> Kernel:
        chain = self.chain
        needed, rates = self._folded()
        states = {name: self._row() for name in chain.states}
        memories = {name: self._row() for name in chain.memories}
        read = frozenset().union(*(e.names for e in (*needed, *rates)))
        inputs = {name: self._row(3) for name in (INPUT, FORCE) if name == INPUT or name in read}
        shown = self._row()
        body = self._body(needed, rates, states, memories, inputs, shown)
        loads = [f"c{row} = b[{row * LANES} + lane]" for row, _ in self.constants.values()]
        source = _SOURCE.format(
            lanes=LANES,
            feed="\n".join(
                f"            b[{(row + 2) * LANES} + lane] = {'commands' if name == INPUT else 'forces'}[where[lane] + k + 1]"
                for name, row in inputs.items()
            ),
            body="\n".join(f"            {line}" for line in (*loads, *body)),
            shown=shown * LANES,
        )
        return Kernel(
            chain, self.output, source, self.rows, tuple(self.constants.values()), tuple(self.filters.values()),
            states, memories, inputs, self.shift,
        )  # fmt: skip

    def _folded(self) -> tuple[list[Equation], list[Equation]]:
        """Signals and rates, with the signals that never change put in where they are read."""
        fixed: dict[str, ast.expr] = {}
        kept = []
        for equation in self.chain.needed(self.output):
            found = friction(equation)
            if found and isinstance(limit := fixed.get(found[0]), ast.Constant) and not limit.value:
                fixed[equation.target] = ast.Constant(0.0)
                continue
            equation = equation.with_values(fixed)
            bare = isinstance(equation.tree, ast.Constant | ast.Name) and equation.names <= {*self._symbols, INPUT}
            if (bare or self._is_constant(equation.tree)) and not equation.is_memory:
                fixed[equation.target] = equation.tree
            else:
                kept.append(equation)
        rates = [e.with_values(fixed) for e in self.chain.equations if e.is_rate]
        shown = self.chain.signal(self.output)
        if shown in fixed:
            kept.append(Equation(f"{shown} = {ast.unparse(fixed[shown])}"))
        return kept, rates

    def _row(self, count: int = 1) -> int:
        self.rows += count
        return self.rows - count

    def _body(
        self, needed: Sequence[Equation], rates: Sequence[Equation], states: Mapping[str, int],
        memories: Mapping[str, int], inputs: Mapping[str, int], shown: int,
    ) -> list[str]:  # fmt: skip
        self.lines = []
        for name, row in [*states.items(), *((f"{name}__old", row) for name, row in memories.items())]:
            self._write(f"{name}_1" if name in states else name, f"b[{row * LANES} + lane]")
        step = self._constant(_named(STEP))
        half, sixth = self._text(f"0.5 * {STEP}"), self._text(f"{STEP} / 6.0")
        self._inputs(inputs)
        for stage in STAGES:
            if stage > 1:
                for name in states:
                    before = f"{half} * {name}_k{stage - 1}" if stage < 4 else f"{step} * {name}_k3"
                    self._write(f"{name}_{stage}", f"{name}_1 + {before}")
            self._stage(needed, str(stage))
            for equation in rates:
                self._write(f"{equation.target}_k{stage}", self._lower(equation.tree, str(stage)))
        self._write(f"b[{shown * LANES} + lane]", self._name(self.chain.signal(self.output), "1"))
        for name, row in states.items():
            slope = f"{name}_k1 + 2.0 * ({name}_k2 + {name}_k3) + {name}_k4"
            self._write(f"b[{row * LANES} + lane]", f"{name}_1 + {sixth} * ({slope})")
        for name, row in memories.items():
            self._write(f"b[{row * LANES} + lane]", f"{name}_4")
        for key, known in self.filters.items():
            for i in range(known.order):
                self._write(f"b[{(known.first + i) * LANES} + lane]", f"{key}_{'zp'[i]}_4")
            self._write(f"b[{(known.first + known.order) * LANES} + lane]", f"{key}_x_m")
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
        held, share = self._constant(_named(HELD)), self._constant(_named(SHARE))
        for name, row in inputs.items():
            for i, part in enumerate(("before", "now", "then")):
                self._write(f"{name}_{part}", f"b[{(row + i) * LANES} + lane]")
            if name == INPUT:
                self._write(f"{name}_1", f"{name}_now + {share} * ({name}_before - {name}_now)")
                self._write("u_end", f"{name}_then + {share} * ({name}_now - {name}_then)")
                self._write("u_area", f"0.5 * ({name}_now + {share} * {name}_1 + (1.0 - {share}) * u_end)")
                self._write("u_middle", f"0.25 * (6.0 * u_area - {name}_1 - u_end)")
                for stage, value in ((2, "u_middle"), (3, "u_middle"), (4, "u_end")):
                    self._write(f"{name}_{stage}", f"{value} + {held} * ({name}_1 - {value})")
                self._write("u_rise", f"{inverse} * (u_end - {name}_1)")
                self._write("u_jump", f"{inverse} * ({name}_now - {name}_before)")
                self._write("u_next", f"{inverse} * ({name}_then - {name}_now)")
                between = "0.5 * (u_jump + u_next)"
                for stage, value in ((1, "u_jump"), (2, between), (3, between), (4, "u_next")):
                    self._write(f"{INPUT_RATE}_{stage}", f"u_rise + {held} * ({value} - u_rise)")
            else:
                self._write(f"{name}_1", f"{name}_now")
                self._write(f"{name}_2", f"0.5 * ({name}_now + {name}_then)")
                self._write(f"{name}_3", f"{name}_2")
                self._write(f"{name}_4", f"{name}_then")

    # Stages ----------------------------------------------------------------------------------------------------

    def _stage(self, needed: Sequence[Equation], stage: str) -> None:
        for equation in needed:
            found = friction(equation)
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
        limit, speed, acceleration, mass = (ast.parse(text, mode="eval").body for text in found)
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

    def _write(self, target: str, value: str) -> None:
        self.written.add(target)
        self.lines.append(f"{target} = {value}")

    def _temporary(self, value: str) -> str:
        self.temporaries += 1
        self._write(f"t{self.temporaries}", value)
        return f"t{self.temporaries}"

    def _text(self, text: str) -> str:
        return self._constant(ast.parse(text, mode="eval").body)

    def _constant(self, node: ast.expr) -> str:
        """The local name of an expression of symbols only, which is computed once for each lane, outside the loop."""
        key = ast.unparse(node)
        if key not in self.constants:
            self.constants[key] = (self._row(), node)
        return f"c{self.constants[key][0]}"

    def _name(self, name: str, stage: str) -> str:
        if name in self._symbols:
            return repr(float(self.plain[name])) if name in self.plain else self._constant(_named(name))
        if name.endswith("__old"):
            return name
        if stage == "f" and (name in self.chain.states or name in (INPUT, INPUT_RATE, FORCE)):
            return f"{name}_1"
        if stage == "m" and f"{name}_m" not in self.written:
            return f"{name}_1"
        return f"{name}_{stage}"

    @property
    def _symbols(self) -> frozenset[str]:
        return frozenset((*self.chain.symbols, STEP))

    def _lower(self, node: ast.expr, stage: str) -> str:
        """An expression of the grammar as source for one stage."""
        if isinstance(node, ast.Constant):
            return repr(float(node.value))  # type: ignore[arg-type]
        if isinstance(node, ast.Name):
            return self._name(node.id, stage)
        if self._is_constant(node):
            return self._constant(node)
        match node:
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._power(self._lower(left, stage), _folded(right, self.plain), stage)
            case ast.BinOp(left=left, op=ast.Div(), right=right) if self._is_constant(right):
                inverse = ast.BinOp(ast.Constant(1.0), ast.Div(), right)
                return f"({self._lower(left, stage)} * {self._constant(inverse)})"
            case ast.BinOp(left=left, op=op, right=right):
                return f"({self._lower(left, stage)} {_SIGNS[type(op)]} {self._lower(right, stage)})"
            case ast.UnaryOp(op=op, operand=operand):
                return f"({'-' if isinstance(op, ast.USub) else '+'}{self._lower(operand, stage)})"
            case ast.Compare():
                return f"(1.0 if {self._condition(node, stage)} else 0.0)"
            case ast.Call(func=ast.Name(id=name), args=arguments) if name in DYNAMIC:
                return self._dynamic(name, arguments, stage)
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return self._call(name, arguments, stage)
        raise TypeError(f"{ast.dump(node)} passed the grammar but cannot be compiled")

    def _is_constant(self, node: ast.expr) -> bool:
        calls = {n.func.id for n in ast.walk(node) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)}
        names = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)} - calls
        return bool(names) and names <= self._symbols and not calls & set(DYNAMIC)

    def _condition(self, node: ast.expr, stage: str) -> str:
        if isinstance(node, ast.Compare):
            left, right = self._lower(node.left, stage), self._lower(node.comparators[0], stage)
            return f"{left} {_SIGNS[type(node.ops[0])]} {right}"
        return f"{self._lower(node, stage)} != 0.0"

    def _call(self, name: str, arguments: Sequence[ast.expr], stage: str) -> str:
        if name == "where":
            a, b = (self._temporary(self._lower(argument, stage)) for argument in arguments[1:])
            return f"({a} if {self._condition(arguments[0], stage)} else {b})"
        x, *more = (self._temporary(self._lower(argument, stage)) for argument in arguments)
        match name, more:
            case "abs", []:
                return f"({x} if {x} >= 0.0 else -{x})"
            case "sgn", []:
                return f"(1.0 if {x} > 0.0 else (-1.0 if {x} < 0.0 else 0.0))"
            case "clip", [low, high]:
                return f"({high} if {x} > {high} else ({low} if {x} < {low} else {x}))"
            case "max", [y]:
                return f"({x} if {x} > {y} else {y})"
            case "min", [y]:
                return f"({x} if {x} < {y} else {y})"
            case "exp", []:
                return self._exponential(x)
            case _:
                return f"{name}({x})"

    def _exponential(self, x: str) -> str:
        """exp(x) as the 32nd power of a polynomial in x/32, |x| ≤ 60: relative error 3e-6 at |x| = 3, 4e-8 at 1.

        A call of a mathematics library would be scalar, one lane after the other.
        """
        z = self._temporary(f"0.03125 * (60.0 if {x} > 60.0 else (-60.0 if {x} < -60.0 else {x}))")
        power = self._temporary(
            f"1.0 + {z} * (1.0 + {z} * (0.5 + {z} * ({1 / 6!r} + {z} * ({1 / 24!r} + {z} * {1 / 120!r}))))"
        )
        for _ in range(5):
            power = self._temporary(f"{power} * {power}")
        return power

    def _power(self, base: str, exponent: ast.expr, stage: str) -> str:
        if not isinstance(exponent, ast.Constant):
            return f"pow({base}, {self._lower(exponent, stage)})"
        value = float(exponent.value)  # type: ignore[arg-type]
        if value == 1.0:
            return base
        if value in (2.0, 3.0, 4.0):
            x = self._temporary(base)
            return "(" + " * ".join([x] * int(value)) + ")"
        return {0.5: f"sqrt({base})", 0.25: f"sqrt(sqrt({base}))"}.get(value, f"pow({base}, {value!r})")

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
        before = f"b[{(known.first + order) * LANES} + lane]"
        inputs = {name: f"{key}_x_{name}" for name in "f1234"}
        through = {
            "f": [inputs["f"]], "1": [inputs["1"]], "2": [before, inputs["1"], inputs["2"]],
            "3": [before, inputs["1"], inputs["3"]], "4": [inputs["1"], f"{key}_x_m", inputs["4"]],
        }  # fmt: skip
        if stage == "4":  # their errors of second order cancel
            self._write(f"{key}_x_m", f"0.5 * ({inputs['2']} + {inputs['3']})")
        terms = [*memory, *through[stage]]
        first = known.first + order + 1 + {"f": 0, "1": 0, "2": 1, "3": 1, "4": 2}[stage] * order * (order + 3)
        for i in range(order):
            row = first + i * (order + 3)
            gains = [f"b[{(row + j) * LANES} + lane]" for j in range(len(terms))]
            self._write(f"{key}_{'zp'[i]}_{stage}", " + ".join(f"{g} * {t}" for g, t in zip(gains, terms, strict=True)))
        return key, value


HELD, SHARE = "held", "share"
"""Rows that the packing fills: 1 where a lane's command is held between samples; the delay's fraction of a step."""

_SIGNS = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/",
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=",
}  # fmt: skip

_SOURCE = """from math import cos, sin, sqrt, tanh

from numba import njit


@njit(cache=True, fastmath=True, nogil=True, error_model="numpy")
def advance(b, commands, forces, where, first, last, every, out, stride):
    for k in range(first, last):
        for lane in range({lanes}):
{feed}
        for lane in range({lanes}):
{body}
        if k % every == 0:
            row = (k // every - first // every) * stride
            for lane in range({lanes}):
                out[row + lane] = b[{shown} + lane]
"""


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


def filter_rows(order: int) -> int:
    """Rows of a filter in the buffer: states, its input half a step ago, gains of start, half and whole step."""
    return order + 1 + 3 * order * (order + 3)


def _folded(node: ast.expr, plain: Mapping[str, float]) -> ast.expr:
    """The expression with the plain symbols as numbers."""
    if isinstance(node, ast.Name) and node.id in plain:
        return ast.Constant(float(plain[node.id]))
    return node


def constant(node: ast.expr, values: Mapping[str, Any]) -> Any:
    """The value of an expression of symbols for all lanes."""
    return eval(compile(ast.Expression(ast.fix_missing_locations(node)), "<constant>", "eval"),
                {"__builtins__": {}, **FUNCTIONS}, dict(values))  # fmt: skip


def _named(name: str) -> ast.Name:
    return ast.Name(name, ast.Load())
