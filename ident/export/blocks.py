"""A machine as matrices for MATLAB and Simulink: its linear part, or the blocks of an actuator of a bench.

An actuator of Kononykhin's kind has no linear part about rest, for it stands within its dead space. Its file holds what
its four blocks are made of.
"""

from __future__ import annotations

import io
from typing import Any

import scipy.io

from ident.chain.conditions import NEVER
from ident.export.machine import ExportedMachine
from ident.export.state_space import as_mat
from ident.stages.bench import FRACTIONS, node_names


def as_blocks(machine: ExportedMachine) -> bytes:
    """A MAT file, version 5: :func:`as_mat`, or of an actuator of a bench its blocks.

    T (s) of the lag, B of the play, I0, kp (Pa) and dPfr (Pa) in rated currents; `Currents` (2 n + 1,) from −1 to 1
    rated currents with `Speeds` (m/s) for a look-up table; Ps (Pa), infinite where none is stated; `Effects` with their
    values, and Ts (s).
    """
    if machine.preset.kind != "bench":
        return as_mat(machine)
    values = machine.values
    speeds, half = [values[name] for name in node_names()], len(FRACTIONS)
    held: dict[str, Any] = {name: values[name] for name in ("T", "B", "I0", "kp", "dPfr")}
    held["Ps"] = values["Ps"] if values["Ps"] < NEVER else float("inf")
    held["Currents"] = [*(-one for one in reversed(FRACTIONS)), 0.0, *FRACTIONS]
    held["Speeds"] = [*reversed(speeds[half:]), 0.0, *speeds[:half]]
    held["Effects"] = {name: value for name, value in values.items() if "__" in name} or []
    file = io.BytesIO()
    scipy.io.savemat(file, {**held, "Ts": 1.0 / machine.sample_rate}, format="5")
    return file.getvalue()
