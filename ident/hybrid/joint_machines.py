"""The linear part of several machines at once, whose specimens may be joined: commands to displacements and forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.hybrid.case import Case
from ident.hybrid.coupled_case import CoupledCase, System
from ident.hybrid.machine import DISPLACEMENT, FELT, FORCE, JOINED, Machine, joined

Array = NDArray[np.float64]
_ONE = np.ones(1)


def joint_machines(
    machines: Sequence[Machine], system: System, gain: Array = _ONE
) -> tuple[Array, Array, Array, Array]:
    """A, B, C, D of machines side by side, (b, n, n), (b, n, P), (b, 2P, n), (b, 2P, P).

    Kp is times `gain`, (b,) for all of them or (P, b) for each.

    They give the displacements that are measured, then the forces. A specimen that joins them adds what each feels of
    the others, E = K x + C x' + M x'' of the matrices beside the diagonals: a feedback, closed here.
    """
    felt = isinstance(system, CoupledCase) and system.joined
    of_each = np.broadcast_to(gain, (len(machines), gain.shape[-1]))
    blocks = [_alone(of, case, one, felt) for of, case, one in zip(machines, system.cases, of_each, strict=True)]
    parts = len(blocks)
    A = _diagonal([block["A"] for block in blocks])
    rows = {name: _rows(blocks, name) for name in (DISPLACEMENT, FORCE, *(JOINED if felt else ()))}
    B, felt_by = (_diagonal([block[name][:, :, None] for block in blocks]) for name in ("B", "E"))
    C = np.concatenate([rows[DISPLACEMENT][0], rows[FORCE][0]], axis=1)
    D = np.concatenate([rows[DISPLACEMENT][1], rows[FORCE][1]], axis=1)
    if not (felt and isinstance(system, CoupledCase)):
        return A, B, C, D
    mass, damping, stiffness = system.coupling
    x, v, a = (rows[name] for name in JOINED)
    of_state = stiffness @ x[0] + damping @ v[0] + mass @ a[0]
    of_itself = stiffness @ x[2] + damping @ v[2] + mass @ a[2]
    of_command = stiffness @ x[1] + damping @ v[1] + mass @ a[1]
    inverse = np.linalg.inv(np.eye(parts) - of_itself)
    state, command = inverse @ of_state, inverse @ of_command
    shown = np.concatenate([rows[DISPLACEMENT][2], rows[FORCE][2]], axis=1)
    return A + felt_by @ state, B + felt_by @ command, C + shown @ state, D + shown @ command


def _alone(of: Machine, case: Case, gain: Array, felt: bool) -> dict[str, Any]:
    """Of one machine: A, B by its command, E by what it feels, and by each channel (C, D, by what it feels)."""
    chain, known = joined(of.small, FELT) if felt else of.small, of.at(case)
    values: dict[str, Any] = {name: known.get(name, 0.0) for name in chain.symbols}
    values["Kp"] = known.get("Kp", 1.0) * gain
    found: dict[str, Any] = {}
    for channel in (DISPLACEMENT, FORCE, *(JOINED if felt else ())):
        model = chain.linearise(values, channel)
        n, pushed, of_felt = model.A.shape[-1], np.zeros(len(gain)), np.zeros((len(gain), model.A.shape[-1]))
        if felt:
            rest, moved = (chain.evaluator(channel)(0.0, [0.0] * n, {**values, FELT: force}) for force in (0.0, 1.0))
            for i, (one, zero) in enumerate(zip(moved[0], rest[0], strict=True)):
                of_felt[:, i] = one - zero
            pushed = pushed + (moved[1] - rest[1])
        found |= {"A": model.A, "B": model.B, "E": of_felt, channel: (model.C, model.D, pushed)}
    return found


def _diagonal(blocks: Sequence[Array]) -> Array:
    """Matrices (b, m, n) of each block, one behind the other along the diagonal."""
    rows, columns = (np.cumsum([0, *(one.shape[axis] for one in blocks)]) for axis in (1, 2))
    found = np.zeros((len(blocks[0]), rows[-1], columns[-1]))
    for p, one in enumerate(blocks):
        found[:, rows[p] : rows[p + 1], columns[p] : columns[p + 1]] = one
    return found


def _rows(blocks: Sequence[dict[str, Any]], channel: str) -> tuple[Array, Array, Array]:
    """A channel of each block by states, commands and what is felt: (b, P, n), (b, P, P), (b, P, P)."""
    by_state, by_command, by_felt = zip(*(block[channel] for block in blocks), strict=True)
    through, felt = (_diagonal([one[:, None, None] for one in given]) for given in (by_command, by_felt))
    return _diagonal([one[:, None, :] for one in by_state]), through, felt
