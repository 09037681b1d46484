"""Lines of arithmetic on rows of numbers as machine code, eight numbers of each row at once.

The lines are those of :mod:`ident.simulation.kernel.machine_code`, each ``name = EXPRESSION``, of the rows by their
names, of numbers that all places of the rows share, and of names set before. They are compiled in a twentieth of the
time that numba takes for the same lines.
"""

from __future__ import annotations

import ctypes
import re
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.simulation.kernel.machine_code import VECTOR, WIDE, Writer, engine, written_by

Array = NDArray[np.float64]
_MASK = f"<{WIDE} x i1>"
_PLACES = ", ".join(f"i64 {i}" for i in range(WIDE))


@lru_cache(maxsize=256)
def elementwise(
    lines: Sequence[str], shared: Sequence[str], rows: Sequence[str], outputs: Sequence[str]
) -> Callable[..., None]:
    """The function apply(c, c_stride, times, x, x_stride, count, out, out_stride, out_time) of some lines.

    For each time o < `times` and place v < `count`, name i of `shared` is c[i c_stride + o], name i of `rows` is
    x[i x_stride + v], and what the lines set name i of `outputs` to goes to out[i out_stride + o out_time + v]. The
    arrays are of float64, each from its first number on; strides are in numbers.
    """
    key = (written_by(__file__), repr((shared, rows, outputs)), *lines)
    kept = engine(lambda: _program(lines, shared, rows, outputs), key)
    pointer, whole = ctypes.c_void_p, ctypes.c_int64
    types = [pointer, whole, whole, pointer, whole, whole, pointer, whole, whole]
    native = ctypes.CFUNCTYPE(None, *types)(kept.get_function_address("apply"))

    def apply(
        c: Array, c_stride: int, times: int, x: Array, x_stride: int, count: int, out: Array, out_stride: int,
        out_time: int, _kept: Any = kept,
    ) -> None:  # fmt: skip
        given = (c.ctypes.data, c_stride, times, x.ctypes.data, x_stride, count, out.ctypes.data)
        native(*given, out_stride, out_time)

    return apply


def _program(lines: Sequence[str], shared: Sequence[str], rows: Sequence[str], outputs: Sequence[str]) -> str:
    """The function in the language of LLVM: places behind the last one of a row are neither read nor written."""
    of = Writer()
    of.names = {name: f"%c{i}" for i, name in enumerate(shared)} | {name: f"%x{i}" for i, name in enumerate(rows)}
    for line in lines:
        of.line(line)
    read = set(re.findall(r"%x\d+", "\n".join([*of.written, *(of.names[name] for name in outputs)])))
    splats = [
        part
        for i in range(len(shared))
        for part in (
            f"%c{i}_row = mul i64 %c_stride, {i}",
            f"%c{i}_at = add i64 %c{i}_row, %o",
            f"%c{i}_place = getelementptr double, ptr %c, i64 %c{i}_at",
            f"%c{i}_number = load double, ptr %c{i}_place",
            f"%c{i}_alone = insertelement {VECTOR} undef, double %c{i}_number, i32 0",
            f"%c{i} = shufflevector {VECTOR} %c{i}_alone, {VECTOR} undef, <{WIDE} x i32> zeroinitializer",
        )
    ]
    loads = [
        part
        for i in range(len(rows))
        if f"%x{i}" in read
        for part in (
            f"%x{i}_row = mul i64 %x_stride, {i}",
            f"%x{i}_at = add i64 %x{i}_row, %v",
            f"%x{i}_place = getelementptr double, ptr %x, i64 %x{i}_at",
            f"%x{i} = call {VECTOR} @llvm.masked.load.v{WIDE}f64.p0(ptr %x{i}_place, i32 8, {_MASK} %mask, "
            f"{VECTOR} zeroinitializer)",
        )
    ]
    stores = [
        part
        for i, name in enumerate(outputs)
        for part in (
            f"%y{i}_row = mul i64 %out_stride, {i}",
            f"%y{i}_of = add i64 %y{i}_row, %out_begin",
            f"%y{i}_at = add i64 %y{i}_of, %v",
            f"%y{i}_place = getelementptr double, ptr %out, i64 %y{i}_at",
            f"call void @llvm.masked.store.v{WIDE}f64.p0({VECTOR} {of.names[name]}, ptr %y{i}_place, i32 8, "
            f"{_MASK} %mask)",
        )
    ]
    return _PROGRAM.format(
        vector=VECTOR, mask=_MASK, wide=WIDE, places=_PLACES, splats="\n  ".join(splats), loads="\n  ".join(loads),
        lines="\n  ".join(of.written), stores="\n  ".join(stores),
    )  # fmt: skip


_PROGRAM = """
declare {vector} @llvm.masked.load.v{wide}f64.p0(ptr, i32, {mask}, {vector})
declare void @llvm.masked.store.v{wide}f64.p0({vector}, ptr, i32, {mask})

define void @apply(ptr noalias readonly %c, i64 %c_stride, i64 %times, ptr noalias readonly %x, i64 %x_stride,
    i64 %count, ptr noalias %out, i64 %out_stride, i64 %out_time) {{
entry:
  %any = icmp sgt i64 %count, 0
  %some = icmp sgt i64 %times, 0
  %both = and i1 %any, %some
  br i1 %both, label %time, label %done
time:
  %o = phi i64 [ 0, %entry ], [ %o_next, %time_end ]
  {splats}
  %out_begin = mul i64 %o, %out_time
  br label %place
place:
  %v = phi i64 [ 0, %time ], [ %v_next, %place ]
  %left = sub i64 %count, %v
  %left_alone = insertelement <{wide} x i64> undef, i64 %left, i32 0
  %left_all = shufflevector <{wide} x i64> %left_alone, <{wide} x i64> undef, <{wide} x i32> zeroinitializer
  %mask = icmp slt <{wide} x i64> <{places}>, %left_all
  {loads}
  {lines}
  {stores}
  %v_next = add i64 %v, {wide}
  %more = icmp slt i64 %v_next, %count
  br i1 %more, label %place, label %time_end
time_end:
  %o_next = add i64 %o, 1
  %again = icmp slt i64 %o_next, %times
  br i1 %again, label %time, label %done
done:
  ret void
}}
"""
