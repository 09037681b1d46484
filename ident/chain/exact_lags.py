"""Stages that do nothing but follow: their lags as what a simulation advances exactly, and no step has to resolve."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache

from ident.chain.chain import Chain
from ident.equations.equation import Equation
from ident.equations.grammar import reads
from ident.errors import Unusable
from ident.stages import Stage


@lru_cache(maxsize=1024)
def with_exact_lags(chain: Chain) -> Chain:
    """The chain with its first-order lags as signals, ``s = lag(E, T)`` for ``d = (E − s)/T, s' = d``.

    Only where T is one of the chain's symbols and nothing else reads it or the rate d, no effect redefines d, small
    signals are taken about no state of it, and the signals still have an order: so the equations stay what they are,
    and a small T makes none of them stiff.
    """
    lags = {lag.target: lag for lag in _lags(chain)}
    if not lags or len(lags) == len(chain.states):
        return chain
    found = replace(chain, stages=tuple(_rewritten(stage, lags) for stage in chain.stages))
    try:
        _ = found.signals
    except Unusable:  # what it follows hangs on it at once
        return chain
    return found


def exact_lags(chain: Chain) -> frozenset[str]:
    """The states of a chain that are such lags."""
    return frozenset(chain.states) - frozenset(with_exact_lags(chain).states)


def _lags(chain: Chain) -> Iterator[Equation]:
    """Each ``s = lag(E, T)`` that stands in the chain as a rate of its own."""
    equations = {equation.target: equation for equation in chain.equations}
    for state in (equation for equation in chain.equations if equation.is_rate):
        rate = ast.unparse(state.tree)
        written = equations.get(rate)
        if written is None or rate in chain.outputs.values() or f"{rate}__0" in equations:
            continue
        if state.target in dict(chain.about):
            continue
        match written.tree:
            case ast.BinOp(
                left=ast.BinOp(left=E, op=ast.Sub(), right=ast.Name(id=state.target)),
                op=ast.Div(),
                right=ast.Name(id=T),
            ) if T in chain.symbols and state.target not in reads(E)[0]:
                readers = [e.target for e in equations.values() if {T, rate} & e.names]
                if sorted(readers) == sorted((rate, state.target)):
                    yield Equation(f"{state.target} = lag({ast.unparse(E)}, {T})", state.place, state.meaning)


def _rewritten(stage: Stage, lags: dict[str, Equation]) -> Stage:
    """The stage with these lags instead of the rates that they come from."""
    own = {e.target: ast.unparse(e.tree) for e in stage.equations if e.is_rate and e.target in lags}
    if not own:
        return stage
    kept = [lags.get(e.target, e) for e in stage.equations if e.target not in own.values()]
    return replace(
        stage,
        publishes=tuple(q for q in stage.publishes if q.name not in own.values()),
        equations=tuple(kept),
    )
