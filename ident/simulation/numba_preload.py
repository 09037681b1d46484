"""Imported by a process from which others are forked: what numba looks through before its first function is there.

It takes 0.2 s, which each of the others takes that runs a compiled function.
"""

from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target

from ident.simulation.uninterrupted import uninterrupted

with uninterrupted(), global_compiler_lock:
    cpu_target.typing_context.refresh()
    cpu_target.target_context.refresh()
