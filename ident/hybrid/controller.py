"""A sampled linear controller of an actuator: what loop shaping designs, a rig runs and a file keeps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.state_space import StateSpace

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SampledController(StateSpace):
    """x(k+1) = A x(k) + B [d(k), y(k)],  u(k) = C x(k) + D [d(k), y(k)].

    d is the displacement that is wanted and y the one that is measured, both m; u is the command of the actuator, m.
    A is (n, n), B (n, 2), C (1, n), D (1, 2); one step is made every 1/`sample_rate` (Hz) seconds. `name` says what it
    is, in words. Raises Unusable where the shapes do not go together or a number is not finite.
    """

    sample_rate: float
    name: str = ""

    def __post_init__(self) -> None:
        n = len(self.A)
        expected = {"A": (n, n), "B": (n, 2), "C": (1, n), "D": (1, 2)}
        got = {name: np.shape(getattr(self, name)) for name in expected}
        if wrong := [name for name in expected if got[name] != expected[name]]:
            first = wrong[0]
            raise Unusable(
                "bad-controller",
                f"{first} is {got[first]}, not {expected[first]}",
                "controller",
                "give A (n, n), B (n, 2), C (1, n), D (1, 2)",
            )
        if not all(np.isfinite(getattr(self, name)).all() for name in expected) or not self.sample_rate > 0:
            raise Unusable(
                "bad-controller",
                "a number is not finite, or the sample rate not positive",
                "controller",
                "design it again",
            )

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        matrices = {name: getattr(self, name).tolist() for name in ("A", "B", "C", "D")}
        return {"name": self.name, "sample_rate": self.sample_rate, **matrices}

    @classmethod
    def from_json(cls, data: object) -> SampledController:
        """The inverse of :meth:`to_json`. Raises Unusable where it is no controller."""
        try:
            given: Any = data
            n = len(given["A"])
            shapes = {"A": (n, n), "B": (n, 2), "C": (1, n), "D": (1, 2)}
            matrices = {name: np.array(given[name], dtype=float).reshape(shapes[name]) for name in shapes}
            return cls(**matrices, sample_rate=float(given["sample_rate"]), name=str(given.get("name", "")))
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise Unusable(
                "bad-controller",
                f"not the JSON of a controller: {error}",
                "controller",
                "give the controller.json that `servoident control` wrote",
            ) from None


class Compensator(Protocol):
    """A controller that is no sampled linear one: what is wanted and what was measured in, the command out, all m."""

    def step(self, d: float, y: float) -> float:
        """The command u(k) that answers d(k) and y(k), called once a sample, in their order."""
        ...


class AheadController:
    """What was computed ahead is added to what is wanted: u(k) = d(k) + `beside`(k), m, the last sample held."""

    name = "feedforward"

    def __init__(self, beside: Array, sample_rate: float) -> None:
        self.beside, self.sample_rate = beside, sample_rate
        self.reset()

    def reset(self) -> None:
        """Back to the first sample."""
        self._next = 0

    def step(self, d: float, y: float) -> float:  # noqa: ARG002  the loop itself compares
        """The command u(k) that answers d(k) and y(k), called once a sample, in their order."""
        beside = self.beside[min(self._next, len(self.beside) - 1)]
        self._next += 1
        return float(d + beside)


Controller = SampledController | AheadController | Compensator


def no_controller(sample_rate: float) -> SampledController:
    """u = d: the machine is told what is wanted."""
    return SampledController(
        np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([[1.0, 0.0]]), sample_rate, "none"
    )


def name_of(controller: Controller) -> str:
    """What a controller is called: by its own name, else by what it is."""
    return getattr(controller, "name", "") or type(controller).__name__.lower()
