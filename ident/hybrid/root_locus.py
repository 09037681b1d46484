"""The poles of an identified machine over the gain Kp of its loop, with the gains that a reader looks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.hybrid.changed_machine import ChangedMachine

_POINTS = 121


@dataclass(frozen=True)
class Pole:
    """A pole of the closed loop in Hz, s/(2π): it settles where `real` is below 0."""

    real: float
    imaginary: float


@dataclass(frozen=True)
class Mark:
    """What a gain means for the stability of the loop, with the poles (Hz) there."""

    meaning: str
    gain: float
    poles: tuple[Pole, ...] = field(repr=False)


@dataclass(frozen=True)
class RootLocus:
    """The poles (Hz) over the gain, those of one gain a row; `marks` are the gains that a reader looks for."""

    gain: tuple[float, ...] = field(repr=False)
    poles: tuple[tuple[Pole, ...], ...] = field(repr=False)
    marks: tuple[Mark, ...] = ()


def poles(roots: NDArray[Any]) -> tuple[Pole, ...]:
    """Roots (n,) in Hz as poles, those furthest from the imaginary axis first."""
    return tuple(Pole(float(root.real), float(root.imag)) for root in sorted(roots, key=lambda r: (r.real, -r.imag)))


def root_locus(machine: ChangedMachine, lower: float, upper: float, marked: Mapping[str, float]) -> RootLocus:
    """The poles from the gain `lower`, or the lowest that is `marked`, to `upper`; gains by their meaning are marked.

    A marked gain above `upper` is left out: far beyond what is asked, it would shrink all else.
    """
    within = {meaning: gain for meaning, gain in marked.items() if gain <= upper}
    gain = np.geomspace(min(lower, *within.values()) if within else lower, upper, _POINTS)
    roots = np.linalg.eigvals(machine.linear(np.array([*gain, *within.values()])).A).astype(complex) / (2 * np.pi)
    found = [poles(row) for row in roots]
    marks = (Mark(meaning, at, there) for (meaning, at), there in zip(within.items(), found[_POINTS:], strict=True))
    return RootLocus(tuple(gain.tolist()), tuple(found[:_POINTS]), tuple(marks))
