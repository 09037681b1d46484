"""The chain: stages put together into one model, and its linearisation.

A chain is a set of equations. Each state has a rate, each signal an expression; signals are put in an order in which
every one is known before it is read, so that loops (feedback, pressure against flow) close through states only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.expression import FUNCTIONS, Equation
from ident.matrix import Actuator, Run, Specimen
from ident.stages import Quantity, Stage

Array = NDArray[np.float64]
INPUT = "u"
CONDITIONS = {
    "Kp": Quantity("Kp", "1", "gain of the position loop, a dial"),
    "mL": Quantity("mL", "kg", "mass of the specimen"),
    "k": Quantity("k", "N/m", "stiffness of the specimen"),
    "cL": Quantity("cL", "N*s/m", "damping of the specimen"),
    "A": Quantity("A", "m^2", "piston area"),
}
"""What an equation may read of a run and its actuator."""


def conditions(run: Run, actuator: Actuator) -> dict[str, float]:
    """The values of :data:`CONDITIONS` for a run.

    Without a stated area A = 1 m²: every parameter that is divided by A² in the model is then that ratio.
    """
    specimen = run.specimen or Specimen()
    area = 1.0 if actuator.piston_area is None else actuator.piston_area
    return {"Kp": run.Kp, "mL": specimen.mass, "k": specimen.stiffness, "cL": specimen.damping, "A": area}


@dataclass(frozen=True)
class LinearModel:
    """ẋ = A x + B u, y = C x + D u for a batch of parameter vectors and runs.

    `system` is [[A, B], [C, D]], shape (n + 1, n + 1, ...), the batch last: one coefficient of the whole batch lies
    together in memory. A (..., n, n), B (..., n), C (..., n) and D (...) are views of it.
    """

    system: Array

    @classmethod
    def of(cls, A: Array, B: Array, C: Array, D: Array) -> LinearModel:
        """From batches of matrices of the shapes above."""
        top = np.concatenate([A, B[..., None]], axis=-1)
        bottom = np.concatenate([C, D[..., None]], axis=-1)[..., None, :]
        return cls(np.moveaxis(np.concatenate([top, bottom], axis=-2), (-2, -1), (0, 1)))

    @property
    def A(self) -> Array:
        """System matrix (..., n, n)."""
        return np.moveaxis(self.system[:-1, :-1], (0, 1), (-2, -1))

    @property
    def B(self) -> Array:
        """Input vector (..., n)."""
        return np.moveaxis(self.system[:-1, -1], 0, -1)

    @property
    def C(self) -> Array:
        """Output vector (..., n)."""
        return np.moveaxis(self.system[-1, :-1], 0, -1)

    @property
    def D(self) -> Array:
        """Feed-through (...)."""
        return np.asarray(self.system[-1, -1])

    def frequency_response(self, frequency: Array) -> NDArray[np.complex128]:
        """G(jω) = C (jωI − A)⁻¹ B + D at `frequency` in Hz, shape (f,) → (..., f).

        The states are scaled first: in SI they differ by ten decades, which would cost digits in the solution.
        """
        s = 2j * np.pi * np.asarray(frequency)
        A, B, C = self.A, self.B, self.C
        scale = np.abs(np.linalg.solve(np.abs(s).max() * np.eye(A.shape[-1]) - 1j * A, B[..., None])[..., 0])
        scale = np.where(scale > 0, scale, 1.0)
        A, B, C = A * scale[..., None, :] / scale[..., :, None], B / scale, C * scale
        resolvent = s[:, None, None] * np.eye(A.shape[-1]) - A[..., None, :, :]
        states = np.linalg.solve(resolvent, np.broadcast_to(B[..., None, :, None], (*resolvent.shape[:-1], 1)))[..., 0]
        response: NDArray[np.complex128] = np.einsum("...fn,...n->...f", states, C) + self.D[..., None]
        return response


@dataclass(frozen=True)
class Chain:
    """Stages in the order of the signal, and the signal that each recordable channel shows."""

    stages: tuple[Stage, ...]
    outputs: Mapping[str, str]

    @cached_property
    def equations(self) -> tuple[Equation, ...]:
        """Every equation, stage by stage."""
        return tuple(equation for stage in self.stages for equation in stage.equations)

    @cached_property
    def states(self) -> tuple[str, ...]:
        """Names of the states, in the order of the state vector."""
        return tuple(equation.target for equation in self.equations if equation.is_rate)

    @cached_property
    def symbols(self) -> tuple[str, ...]:
        """What the equations read but do not define: parameters and conditions."""
        defined = {equation.target for equation in self.equations}
        read = frozenset().union(*(equation.names for equation in self.equations))
        return tuple(sorted(read - defined - {INPUT}))

    @cached_property
    def signals(self) -> tuple[Equation, ...]:
        """The signals' equations, each after those that it reads.

        Raises Unusable where signals depend on each other in a circle without a state between them.
        """
        equations = {equation.target: equation for equation in self.equations if not equation.is_rate}
        needs = {name: equation.names & equations.keys() for name, equation in equations.items()}
        try:
            order = tuple(TopologicalSorter(needs).static_order())
        except CycleError as error:
            circle = " → ".join(error.args[1])
            raise Unusable("algebraic-loop", f"{circle} has no state", "chain", "put a lag between them") from None
        return tuple(equations[name] for name in order)

    @cached_property
    def evaluate(self) -> Callable[..., tuple[tuple[Any, ...], dict[str, Any]]]:
        """The function (u, states, values) → (rates, every signal), compiled once from the checked equations.

        `values` maps the names in :attr:`symbols` to numbers or arrays that broadcast against the states.
        """
        lines = [f"    {name} = values[{name!r}]" for name in self.symbols]
        lines += [f"    ({', '.join(self.states)},) = states"]
        lines += [f"    {equation.target} = {equation.python}" for equation in self.signals]
        rates = ", ".join(equation.python for equation in self.equations if equation.is_rate)
        named = ", ".join(f"{name!r}: {name}" for name in (*(s.target for s in self.signals), *self.states))
        source = "\n".join(["def evaluate(u, states, values):", *lines, f"    return ({rates},), {{{named}}}"])
        namespace: dict[str, Any] = {"__builtins__": {}, **FUNCTIONS}
        exec(compile(source, "<chain>", "exec"), namespace)  # own text, every name checked by ident.expression
        function: Callable[..., tuple[tuple[Any, ...], dict[str, Any]]] = namespace["evaluate"]
        return function

    def linearise(self, values: Mapping[str, Array | float], output: str = "displacement") -> LinearModel:
        """State matrices by applying the equations to unit vectors: exact, because the cores are linear.

        `values` holds every symbol, as numbers or arrays of one broadcast shape; `output` is a channel's name.
        """
        if output not in self.outputs:
            raise Unusable(
                "unknown-output",
                f"the model does not produce {output!r}",
                "output of a run",
                f"choose one of {', '.join(self.outputs)} or another model",
            )
        n, signal = len(self.states), self.outputs[output]
        shape = np.broadcast_shapes(*(np.shape(values[name]) for name in self.symbols))
        system = np.zeros((n + 1, n + 1, *shape))
        for j in range(n + 1):
            unit = [float(i == j) for i in range(n)]
            rates, signals = self.evaluate(float(j == n), unit, values)
            for i, rate in enumerate(rates):
                system[i, j] = rate
            system[n, j] = signals[signal]
        return LinearModel(system)

    def pattern(self, output: str) -> tuple[tuple[bool, ...], ...]:
        """Which entries of the system matrix can be other than zero, found at generic values of every symbol."""
        generic = {name: np.sqrt(2.0 + i) for i, name in enumerate(self.symbols)}
        return tuple(tuple(bool(entry) for entry in row) for row in self.linearise(generic, output).system)
