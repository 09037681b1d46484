"""Functions that numba compiles once for all processes of this user: their machine code is kept on disk.

The machine code of a function is kept under all that numba makes it of: the bytecode of the function and of each that
it calls, the constants that they read, the options, the types of the arguments, the versions and the processor. A
change of any of them is another file, in whatever module it stands, so that nothing on disk can be stale; a comment
changes nothing, and another copy of the program at another place finds what the first one compiled.
"""

from __future__ import annotations

import pickle
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from operator import attrgetter
from types import CodeType, FunctionType, ModuleType
from typing import Any, TypeVar

import llvmlite
import numba
import numpy as np
from numba.core import serialize
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import Dispatcher
from numba.core.extending import _Intrinsic
from numba.core.registry import CPUDispatcher

from ident.cached import cached_property
from ident.simulation.code_cache import found, in_turn, keep
from ident.simulation.uninterrupted import uninterrupted

Function = TypeVar("Function", bound=Callable[..., Any])
_bytes_of: Callable[[Any], bytes] = serialize.dumps
_code_of = attrgetter("library")  # numba's name for the machine code of what it compiled
_watchers: list[Callable[[], None]] = []
VERSIONS = (numba.__version__, llvmlite.__version__, np.__version__, sys.version)


@contextmanager
def watching(tell: Callable[[], None]) -> Iterator[None]:
    """Until the block ends, `tell` is called before each compilation: it takes seconds, once on a machine."""
    _watchers.append(tell)
    try:
        yield
    finally:
        _watchers.remove(tell)


def jit(**options: Any) -> Callable[[Function], Function]:
    """As ``numba.njit(**options)``; compiled once for all processes of this user.

    Without the form for callers in C, which none has: a tenth of the compilation.
    """
    options = {"no_cfunc_wrapper": True, **options}

    def decorated(function: Function) -> Function:
        with uninterrupted():  # the first of a process loads what numba's compiler calls
            made: Function = shared(numba.njit(**options)(function))
        return made

    return decorated


def in_place(**options: Any) -> Callable[[Function], Function]:
    """As :func:`jit` without the interpreter's lock, for a function that makes no array and changes those it is given.

    Numba then counts no references to arrays, which takes a quarter of the compilation and of the run.
    """
    return jit(nogil=True, _nrt=False, **options)


def within(**options: Any) -> Callable[[Function], Function]:
    """As :func:`in_place`, for a function that compiled functions call: no form for callers in Python is compiled.

    That form takes each argument apart, which for a tuple of arrays is as long as the function. Python itself carries
    out the lines of such a function.
    """

    def decorated(function: Function) -> Function:
        made: Any = in_place(no_cpython_wrapper=True, **options)(function)
        made.__class__ = _Within
        inner: Function = made
        return inner

    return decorated


class _Within(CPUDispatcher):  # type: ignore[misc]  # to the type checker a class of numba is any
    """A function of which numba compiled no form that Python could call."""

    def __call__(self, *given: Any) -> Any:
        return self.py_func(*given)


inlined = jit(nogil=True, inline="always")
"""For a function that one compiled function calls: a call of its own is compiled, too, and takes longer than its work.
"""


def shared(function: Any) -> Any:
    """One of numba's functions, from now on compiled once for all processes of this user.

    Processes that need it at once wait for the one that compiles.
    """
    kept = function._cache = _Kept(function)

    def compile_in_turn(signature: Any) -> Any:
        with uninterrupted(), global_compiler_lock, in_turn(kept.made_of):
            return Dispatcher.compile(function, signature)

    function.compile = compile_in_turn
    return function


class _Kept(NullCache):  # type: ignore[misc]  # to the type checker a class of numba is any
    """What numba asks for the machine code of a function, and tells what it compiled."""

    def __init__(self, function: Any) -> None:
        self._function = function

    @cached_property
    def made_of(self) -> str:
        """As :func:`made_of`: looked up when the whole module is there."""
        return "\n".join(made_of(self._function))

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The function for the types of a signature, None where nobody compiled it."""
        target_context.refresh()
        rebuild: Any = CompileResult._rebuild
        code = found(self._text(sig, target_context.codegen()))
        if code is not None:
            return rebuild(target_context, *pickle.loads(code))
        for tell in tuple(_watchers):
            tell()
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled, unless it holds addresses of this process."""
        if not _code_of(data).has_dynamic_globals and all(part.can_cache for part in data.lifted):
            keep(self._text(sig, data.codegen), _bytes_of(data._reduce()))

    def _text(self, signature: Any, codegen: Any) -> str:
        """All that the machine code for a signature is made of."""
        return repr((VERSIONS, codegen.magic_tuple(), signature, self.made_of))


def made_of(function: Any) -> Iterator[str]:
    """What decides on the machine code of a function, apart from its arguments, a line each.

    Raises TypeError where the function reads something of which that cannot be said: a list, or an own class.
    """
    yield from _lines("", function, set())


def _lines(name: str, value: Any, seen: set[int]) -> Iterator[str]:
    """A value that a function reads by a name, and what it reads itself."""
    match value:
        case Dispatcher():
            yield f"{name} {sorted(value.targetoptions.items())}"
            yield from _lines(name, value.py_func, seen)
        case _Intrinsic():
            yield from _lines(name, value._defn, seen)
        case FunctionType():
            if id(value) in seen:  # it calls itself, or is read twice
                yield f"{name} {value.__qualname__} again"
                return
            seen.add(id(value))
            yield f"{name} {value.__module__} {value.__qualname__}"
            yield from _lines("defaults", value.__defaults__, seen)
            yield from _code(value.__code__)
            for read in sorted(_names(value.__code__) & value.__globals__.keys()):
                yield from _lines(read, value.__globals__[read], seen)
            for read, cell in zip(value.__code__.co_freevars, value.__closure__ or (), strict=True):
                yield from _lines(read, cell.cell_contents, seen)
        case tuple():
            yield f"{name} {type(value).__name__} of {len(value)}"
            for part in value:
                yield from _lines("part", part, seen)
        case np.ndarray():
            yield f"{name} {value.dtype} {value.shape} {value.tobytes().hex()}"
        case None | bool() | int() | float() | complex() | str() | bytes() | np.generic() | np.dtype():
            yield f"{name} {type(value).__name__} {value!r}"
        case _ if _is_foreign(value):
            yield f"{name} {getattr(value, '__module__', '')} {getattr(value, '__qualname__', value.__class__)}"
        case _:
            raise TypeError(f"{name} = {value!r}: machine code that depends on it cannot be kept")


def _code(code: CodeType) -> Iterator[str]:
    """The bytecode of a function and of those that are written within it, wherever in its file it stands."""
    names = (code.co_argcount, code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars)
    yield f"{code.co_code.hex()} {names}"
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code(constant)
        else:
            yield f"{type(constant).__name__} {constant!r}"


def _names(code: CodeType) -> set[str]:
    """The names that a function looks up, those of attributes among them."""
    within = (_names(constant) for constant in code.co_consts if isinstance(constant, CodeType))
    return set(code.co_names).union(*within)


def _is_foreign(value: Any) -> bool:
    """Whether it is part of Python or a library: the versions, or nothing, say what it is."""
    of = value.__name__ if isinstance(value, ModuleType) else getattr(value, "__module__", None) or ""
    return of.partition(".")[0] in {"builtins", "math", "numpy", "numba", "llvmlite", "typing"}
