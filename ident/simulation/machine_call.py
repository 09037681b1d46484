"""A kernel's machine code called from a compiled loop, by its address."""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

from ident.simulation.jit import jit

Array = NDArray[np.float64]
_POINTERS, _NUMBERS = 5, 3  # arguments of `advance` before its output and the output's stride


def _typed(
    _typing: Any,
    code: Any,
    b: Any,
    u: Any,
    fm: Any,
    u_at: Any,
    fm_at: Any,
    first: Any,
    last: Any,
    every: Any,
    out: Any,
    stride: Any,
) -> Any:
    given = (code, b, u, fm, u_at, fm_at, first, last, every, out, stride)
    taken = [types.int64 if isinstance(one, types.Integer) else one for one in given]

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        word, pointer = ir.IntType(64), ir.IntType(8).as_pointer()
        kinds = [*[pointer] * _POINTERS, *[word] * _NUMBERS, pointer, word]
        function = builder.inttoptr(values[0], ir.FunctionType(ir.VoidType(), kinds).as_pointer())
        passed = []
        for kind, of, value in zip(kinds, signature.args[1:], values[1:], strict=True):
            if kind is pointer:
                made: Any = cgutils.create_struct_proxy
                data = made(of)(context, builder, value=value).data
                passed.append(builder.bitcast(data, pointer))
            else:
                passed.append(value)
        builder.call(function, passed)
        return context.get_dummy_value()

    return types.void(*taken), generate


advance_at: Any = intrinsic(_typed)
"""advance(b, u, fm, u_at, fm_at, first, last, every, out, stride) of the kernel that stands at the address `code`.

Called as ``advance_at(code, b, u, …)``; arguments as in :class:`ident.simulation.kernel.layout.Kernel`, arrays
contiguous.
"""


def _typed_from(
    _typing: Any,
    code: Any,
    b: Any,
    b_from: Any,
    u: Any,
    fm: Any,
    u_at: Any,
    fm_at: Any,
    at_from: Any,
    first: Any,
    last: Any,
    every: Any,
    out: Any,
    stride: Any,
) -> Any:
    given = (code, b, b_from, u, fm, u_at, fm_at, at_from, first, last, every, out, stride)
    taken = [types.int64 if isinstance(one, types.Integer) else one for one in given]

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        word, pointer = ir.IntType(64), ir.IntType(8).as_pointer()
        kinds = [*[pointer] * _POINTERS, *[word] * _NUMBERS, pointer, word]
        function = builder.inttoptr(values[0], ir.FunctionType(ir.VoidType(), kinds).as_pointer())
        begins = {1: values[2], 5: values[7], 6: values[7]}

        def place(i: int) -> Any:
            made: Any = cgutils.create_struct_proxy
            data = made(signature.args[i])(context, builder, value=values[i]).data
            data = builder.gep(data, [begins[i]]) if i in begins else data
            return builder.bitcast(data, pointer)

        builder.call(function, [*map(place, (1, 3, 4, 5, 6)), *values[8:11], place(11), values[12]])
        return context.get_dummy_value()

    return types.void(*taken), generate


advance_from: Any = intrinsic(_typed_from)
"""As :data:`advance_at`, of a buffer that begins at `b_from` of b, and places at `at_from` of those arrays.

``advance_from(code, b, b_from, u, fm, u_at, fm_at, at_from, first, last, every, out, stride)``: a loop that calls it
each sample need not slice, which counts references.
"""


@jit(nogil=True)
def advance_groups(
    code: int,
    wide: int,
    groups: tuple[int, int],
    buffers: Array,
    u: Array,
    fm: Array,
    u_at: NDArray[np.int64],
    fm_at: NDArray[np.int64],
    first: int,
    last: int,
    every: int,
    out: Array,
    lanes: int,
) -> None:
    """Advance a kernel of 8 or 16 lanes, `wide`, over groups of as many, from one to before another, without Python.

    `buffers` are those of sixteen lanes, one after the other; a step of all `lanes` is a row of `out`.
    """
    size = 16 * len(buffers) // lanes  # of a buffer
    for group in range(groups[0], groups[1]):
        lane = wide * group
        b = buffers[lane // 16 * size + lane % 16 :]
        advance_at(code, b, u, fm, u_at[lane:], fm_at[lane:], first, last, every, out[lane:], lanes)
