"""The lines of a kernel as machine code: every operation on eight lanes at once, compiled by LLVM within 0.1 s.

Of sixteen lanes the second eight have the same operations behind those of the first. A step is a long chain, in which
each operation waits for the one before it, and the processor carries out those of the second while it waits.

A line is ``name = EXPRESSION`` or ``b[OFFSET + lane] = EXPRESSION``, of names set before, numbers,
``b[OFFSET + lane]``, ``+ - * /``, ``a if x < y else c``, and sqrt, pow, sin, cos, tanh; ``k`` is the number of the
step. Offsets are numbers, so that nothing is read twice that was stored or read before. Operations may be contracted
(x y + z rounded once), never put into another order: the same processor always gives the same digits.

The program is written as it is to be carried out: what was computed or stored is not computed or read again. LLVM's
passes over it took a third of the compilation, and made it no faster.
"""

from __future__ import annotations

import ast
import ctypes
import hashlib
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
import numpy as np
from numpy.typing import NDArray

from ident.equations.grammar import statement_of
from ident.simulation.code_cache import kept
from ident.simulation.kernel.vector_functions import FUNCTIONS, declared, everywhere, function
from ident.simulation.uninterrupted import uninterrupted

LANES = 16
WIDE = 8
"""Lanes of one operation, two registers of AVX2 or one of AVX-512: fewer cost as much."""
VECTOR = f"<{WIDE} x double>"
_FAST = "nnan ninf nsz contract"
_SIGNS: dict[type[ast.AST], str] = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}
_RELATIONS: dict[type[ast.AST], str] = {
    ast.Lt: "olt",
    ast.LtE: "ole",
    ast.Gt: "ogt",
    ast.GtE: "oge",
    ast.Eq: "oeq",
    ast.NotEq: "une",
}
_AT = {"commands": "command_at", "forces": "force_at"}
"""Where each lane begins in an array."""
_CALLS = {"sqrt": 1, "pow": 2, "sin": 1, "cos": 1, "tanh": 1}
Advance = Callable[..., None]
Fed = tuple[int, str, int, int]
"""A row that is filled in each step: the row, from what array, from which column of how many.

The arrays are the `commands`, the `forces`, and `shared`: commands that are those of every lane.
"""


@lru_cache(maxsize=256)
def advance(lines: Sequence[str], fed: Sequence[Fed], shown: int, lanes: int = LANES) -> Advance:
    """The function advance(b, commands, forces, command_at, force_at, first, last, every, out, stride) of some lines.

    It serves the first `lanes` lanes of the buffer, eight or sixteen, and leaves the others alone.

    Before the lines of step k of a lane are carried out, each row of `fed` is filled from commands[command_at[lane] +
    k + 1] or from the forces alike, of which the columns that it names lie side by side, or from the commands of step
    k that all lanes share; row `shown` is what is written to `out` (see
    :class:`ident.simulation.kernel.layout.Kernel`). Arrays are contiguous, of float64 and int64.
    """
    engine = _machine_code(lines, fed, shown, lanes)
    types = [*[ctypes.c_void_p] * 5, *[ctypes.c_int64] * 3, ctypes.c_void_p, ctypes.c_int64]
    native = ctypes.CFUNCTYPE(None, *types)(engine.get_function_address("advance"))

    def run(
        b: NDArray[np.float64],
        commands: NDArray[np.float64],
        forces: NDArray[np.float64],
        command_at: NDArray[np.int64],
        force_at: NDArray[np.int64],
        first: int,
        last: int,
        every: int,
        out: NDArray[np.float64],
        stride: int,
        _kept: object = engine,
    ) -> None:
        given = (array.ctypes.data for array in (b, commands, forces, command_at, force_at))
        native(*given, first, last, every, out.ctypes.data, stride)

    return run


@lru_cache(maxsize=256)
def _machine_code(lines: Sequence[str], fed: Sequence[Fed], shown: int, lanes: int) -> Any:
    return engine(lambda: _program(lines, fed, shown, lanes), (written_by(), repr((fed, shown, lanes)), *lines))


@lru_cache(maxsize=256)
def address(lines: Sequence[str], fed: Sequence[Fed], shown: int, lanes: int) -> tuple[int, object]:
    """Where the machine code of :func:`advance` stands, for a compiled loop to call, and what keeps it there."""
    engine = _machine_code(lines, fed, shown, lanes)
    return engine.get_function_address("advance"), engine


# Lines ------------------------------------------------------------------------------------------------------------


@dataclass
class Writer:
    """Operations on eight lanes, from the `lane` on, in the order of the lines.

    What was computed or stored once is known by what it is.
    """

    lane: int = 0
    written: list[str] = field(default_factory=list)
    known: dict[tuple[object, ...], str] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)
    called: set[str] = field(default_factory=set)
    count: int = 0
    begins: dict[str, tuple[str, int, int]] = field(default_factory=dict)
    """Where a lane begins in an array of so many columns, by its name."""

    def feed(self, row: int, array: str, column: int, columns: int) -> None:
        """Fill a row from the next value of every lane, or from the one that is that of all."""
        if array == "shared":
            at = self._new(f"add i64 {self._once(f'mul i64 %k, {columns}')}, {column}")
            value = self._new(f"load double, ptr {self._new(f'getelementptr double, ptr %commands, i64 {at}')}")
            self.store(row * LANES, self._everywhere(value))
            return
        vector = "undef"
        at = "%k" if columns == 1 else self._once(f"mul i64 %k, {columns}")
        at = at if column == 0 else self._once(f"add i64 {at}, {column}")
        for lane in range(WIDE):
            begin = f"%{array}_{columns}_{self.lane + lane}"
            self.begins[begin] = (array, self.lane + lane, columns)
            value = self._new(f"load double, ptr {self._new(f'getelementptr double, ptr {begin}, i64 {at}')}")
            vector = self._new(f"insertelement {VECTOR} {vector}, double {value}, i32 {lane}")
        self.store(row * LANES, vector)

    def line(self, text: str) -> None:
        """Carry out a line."""
        match _statement(text):
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                self.names[name] = self._value(value)
            case ast.Assign(targets=[ast.Subscript() as place], value=value):
                self.store(_offset(place), self._value(value))
            case _:
                raise TypeError(f"{text!r} is not a line of a kernel")

    def store(self, offset: int, value: str) -> None:
        """Put a value into the buffer."""
        self.written.append(f"store {VECTOR} {value}, ptr {self._place(offset)}, align 8")
        self.known["at", offset] = value

    def load(self, offset: int) -> str:
        """What stands in the buffer."""
        if ("at", offset) not in self.known:
            self.known["at", offset] = self._new(f"load {VECTOR}, ptr {self._place(offset)}, align 8")
        return self.known["at", offset]

    def _place(self, offset: int) -> str:
        return self._once(f"getelementptr double, ptr %b, i64 {offset + self.lane}")

    def _new(self, operation: str) -> str:
        self.count += 1
        name = f"%v{self.lane}_{self.count}"
        self.written.append(f"{name} = {operation}")
        return name

    def _once(self, operation: str) -> str:
        key = (operation,)
        if key not in self.known:
            self.known[key] = self._new(operation)
        return self.known[key]

    def _everywhere(self, number: str) -> str:
        alone = self._once(f"insertelement {VECTOR} undef, double {number}, i32 0")
        return self._once(f"shufflevector {VECTOR} {alone}, {VECTOR} undef, <{WIDE} x i32> zeroinitializer")

    def _value(self, node: ast.expr) -> str:
        match node:
            case ast.Constant(value=value):
                return everywhere(float(value), WIDE)  # type: ignore[arg-type]
            case ast.Name(id="k"):
                return self._everywhere(self._once("sitofp i64 %k to double"))
            case ast.Name(id=name):
                return self.names[name]
            case ast.Subscript():
                return self.load(_offset(node))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self._once(f"fneg {_FAST} {VECTOR} {self._value(operand)}")
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self._value(operand)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _SIGNS:
                return self._once(f"{_SIGNS[type(op)]} {_FAST} {VECTOR} {self._value(left)}, {self._value(right)}")
            case ast.IfExp(test=ast.Compare(left=left, ops=[op], comparators=[right]), body=body, orelse=other):
                a, b = self._value(left), self._value(right)
                holds = self._once(f"fcmp {_FAST} {_RELATIONS[type(op)]} {VECTOR} {a}, {b}")
                then, els = self._value(body), self._value(other)
                return self._once(f"select <{WIDE} x i1> {holds}, {VECTOR} {then}, {VECTOR} {els}")
            case ast.Call(func=ast.Name(id=name), args=arguments) if len(arguments) == _CALLS.get(name):
                self.called.add(name)
                given = ", ".join(f"{VECTOR} {self._value(argument)}" for argument in arguments)
                called = f"@lanes_{name}" if name in FUNCTIONS else f"@llvm.{name}.v{WIDE}f64"
                return self._once(f"call {VECTOR} {called}({given})")
        raise TypeError(f"{ast.unparse(node)!r} is nothing that a kernel can do")


@lru_cache(maxsize=65_536)
def _statement(text: str) -> ast.stmt:
    """A line's syntax: kernels of one machine with other effects have most of their lines in common."""
    return statement_of(text)


def _offset(node: ast.Subscript) -> int:
    """The number in ``b[NUMBER + lane]``."""
    match node.slice:
        case ast.BinOp(left=ast.Constant(value=int(offset)), op=ast.Add(), right=ast.Name(id="lane")):
            return offset
    raise TypeError(f"{ast.unparse(node)!r} is not a place of the buffer")


# Programs ---------------------------------------------------------------------------------------------------------


def _program(lines: Sequence[str], fed: Sequence[Fed], shown: int, lanes: int) -> str:
    """The function in the language of LLVM: in each step the operations on eight lanes, then those on the next."""
    parts = [Writer(first) for first in range(0, lanes, WIDE)]
    for of in parts:
        for row, array, column, columns in fed:
            of.feed(row, array, column, columns)
        for line in lines:
            of.line(line)
    outputs = [of.load(shown * LANES) for of in parts]
    begins = [
        line
        for of in parts
        for begin, (array, lane, columns) in of.begins.items()
        for line in (
            f"{begin}_place = getelementptr i64, ptr %{_AT[array]}, i64 {lane}",
            f"{begin}_at = load i64, ptr {begin}_place",
            f"{begin}_next = add i64 {begin}_at, 1",
            f"{begin}_flat = mul i64 {begin}_next, {columns}",
            f"{begin} = getelementptr double, ptr %{array}, i64 {begin}_flat",
        )
    ]
    stores = [
        line
        for of, output in zip(parts, outputs, strict=True)
        for line in (
            f"%target_{of.lane} = getelementptr double, ptr %shown, i64 {of.lane}",
            f"store {VECTOR} {output}, ptr %target_{of.lane}, align 8",
        )
    ]
    functions = [declared(WIDE)] if FUNCTIONS.keys() & parts[0].called else []
    for name in sorted(parts[0].called):
        is_own = name in FUNCTIONS
        functions.append(function(name, WIDE) if is_own else f"declare {VECTOR} @llvm.{name}.v{WIDE}f64({VECTOR})")
    steps = [line for of in parts for line in of.written]
    return _PROGRAM.format(
        functions="\n".join(functions), begins="\n  ".join(begins), steps="\n  ".join(steps), stores="\n  ".join(stores)
    )


# The step is counted in memory: LLVM took a fifth of the compilation to look for better ways to count it.
_PROGRAM = """{functions}

define void @advance(ptr noalias %b, ptr noalias readonly %commands, ptr noalias readonly %forces,
    ptr noalias readonly %command_at, ptr noalias readonly %force_at, i64 %first, i64 %last, i64 %every,
    ptr noalias %out, i64 %stride) {{
entry:
  %row_before = sdiv i64 %first, %every
  {begins}
  %k_place = alloca i64
  store i64 %first, ptr %k_place
  %any = icmp slt i64 %first, %last
  br i1 %any, label %steps, label %done
steps:
  %k = load i64, ptr %k_place
  {steps}
  %rest = srem i64 %k, %every
  %is_shown = icmp eq i64 %rest, 0
  br i1 %is_shown, label %show, label %steps_end
show:
  %sample = sdiv i64 %k, %every
  %row = sub i64 %sample, %row_before
  %row_begin = mul i64 %row, %stride
  %shown = getelementptr double, ptr %out, i64 %row_begin
  {stores}
  br label %steps_end
steps_end:
  %k_next = add i64 %k, 1
  store i64 %k_next, ptr %k_place
  %more = icmp slt i64 %k_next, %last
  br i1 %more, label %steps, label %done
done:
  ret void
}}
"""


# LLVM -------------------------------------------------------------------------------------------------------------


@cache
def _target() -> llvm.Target:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple()


def _processor() -> tuple[str, str]:
    """Name and features of this processor, or of the one that numba is told to compile for."""
    asked = os.environ.get("NUMBA_CPU_NAME")
    return (asked, os.environ.get("NUMBA_CPU_FEATURES", "")) if asked else _host()


@cache
def _host() -> tuple[str, str]:
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


@cache
def written_by(*files: str) -> str:
    """What writes programs, these files among it: a change of one makes others of the same lines."""
    functions = str(Path(__file__).with_name("vector_functions.py"))
    return hashlib.sha256(b"".join(Path(file).read_bytes() for file in (__file__, functions, *files))).hexdigest()


def engine(program: Callable[[], str], written: Sequence[str]) -> llvm.ExecutionEngine:
    """The program, compiled, as long as the engine lives; all that it is `written` from says which one it is."""
    with uninterrupted():
        return _engine(program, written)


def _engine(program: Callable[[], str], written: Sequence[str]) -> llvm.ExecutionEngine:
    processor, features = _processor()
    machine = _target().create_target_machine(cpu=processor, features=features, opt=2, jit=True)
    decides = (".".join(map(str, llvm.llvm_version_info)), machine.triple, processor, features, *written)
    code = kept("\n".join(decides), lambda: _object(program(), machine))
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return engine


def _object(program: str, machine: llvm.TargetMachine) -> bytes:
    """The program as an object file."""
    code: bytes = machine.emit_object(llvm.parse_assembly(program))
    return code
