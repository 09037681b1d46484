"""A kernel's machine code called from a compiled loop, by its address."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_POINTERS, _NUMBERS = 5, 3  # arguments of `advance` before its output and the output's stride


def _typed(_typing: Any, code: Any, b: Any, u: Any, fm: Any, u_at: Any, fm_at: Any, first: Any, last: Any,
           every: Any, out: Any, stride: Any) -> Any:  # fmt: skip
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
