"""The linear part of an exported machine: as matrices for MATLAB and Simulink, and for python-control."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.io
from numpy.typing import NDArray

from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.export.machine import ExportedMachine
from ident.hybrid.lags_as_states import with_states
from ident.hybrid.state_space import StateSpace


@dataclass(frozen=True, eq=False)
class LinearPart(StateSpace):
    """x' = A x + B u, y = C x + D u of one input, in SI, and what each input, output and state is called.

    `left_out` are effects that are on and have no linear response.
    """

    input: str
    outputs: tuple[str, ...]
    states: tuple[str, ...]
    left_out: tuple[str, ...]


def linear_part(machine: ExportedMachine) -> LinearPart:
    """The small signals of a machine about its point of rest; lags and delays are states, delays by their Padé form.

    Raises Unusable where the equations leave the range of a computer.
    """
    preset, values = machine.preset, machine.values
    on = tuple(effect for effect in preset.effects if values.get(effect.added[0].in_equations))
    kept = tuple(with_states(effect) for effect in on if _is_linear(machine, effect))
    chain = preset.core.with_effects(kept)
    known = {name: values[name] for name in chain.symbols}
    models = [chain.linearise(known, output) for output in machine.outputs]
    off = {name for name, value in known.items() if value == 0}
    states = sorted({place for output in machine.outputs for place in chain.observed(output, off)})
    A, B = models[0].A[np.ix_(states, states)], models[0].B[states, None]
    C, D = np.array([model.C[states] for model in models]), np.array([[float(model.D)] for model in models])
    if not all(np.isfinite(matrix).all() for matrix in (A, B, C, D)):
        raise Unusable(
            "out-of-range", "the linear part exceeds the range of floating-point numbers", "fit", "correct the fit"
        )
    left_out = tuple(effect.name for effect in on if not _is_linear(machine, effect))
    return LinearPart(A, B, C, D, machine.driven_by, machine.outputs, tuple(chain.states[i] for i in states), left_out)


def _is_linear(machine: ExportedMachine, effect: Effect) -> bool:
    core = machine.preset.core
    return not core.is_linear or core.with_effects((with_states(effect),)).is_linear


def as_mat(machine: ExportedMachine) -> bytes:
    """A MAT file, version 5, for ``ss(A, B, C, D)`` and for Simulink's block State-Space, which takes it as it is.

    Beside A, B, C, D: `x0` at rest, `Ts` (s) of the machine's samples, `InputName`, `OutputName`, `OutputUnit`,
    `StateName`, and in `LeftOut` the effects that the linear part does not know.
    """
    part = linear_part(machine)
    held: dict[str, Any] = {name: getattr(part, name) for name in ("A", "B", "C", "D")}
    held |= {
        "x0": np.zeros((len(part.A), 1)),
        "Ts": 1.0 / machine.sample_rate,
        "InputName": _cells((part.input,)),
        "OutputName": _cells(part.outputs),
        "OutputUnit": _cells(tuple(map(machine.unit, part.outputs))),
        "StateName": _cells(part.states),
        "LeftOut": _cells(part.left_out),
    }
    file = io.BytesIO()
    scipy.io.savemat(file, held, format="5")
    return file.getvalue()


def _cells(names: tuple[str, ...]) -> NDArray[Any]:
    """Names as MATLAB's column of cells."""
    return np.array(names, dtype=object).reshape(-1, 1)


def as_control(machine: ExportedMachine) -> Any:
    """The linear part as a ``control.StateSpace`` with the names of its channels and states."""
    import control  # noqa: PLC0415

    part = linear_part(machine)
    return control.ss(
        part.A, part.B, part.C, part.D, inputs=[part.input], outputs=list(part.outputs), states=list(part.states)
    )
