"""Poles and zeros of an identified machine under the conditions of a run, lags and delays of effects as states."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import scipy  # linalg, which takes a tenth of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.changed_machine import Change, changed_machine
from ident.hybrid.servo_loop import servo_loop
from ident.linear import LinearModel
from ident.matrix import Actuator
from ident.run import Run, Specimen
from ident.words.number import plain

_FAR = 1e3  # times the fastest pole: a zero beyond is one at infinity that rounding brought in


@dataclass(frozen=True)
class Root:
    """A pole or a zero in Hz, s/(2π)."""

    kind: Literal["pole", "zero"]
    real: float
    imaginary: float

    @property
    def frequency(self) -> float:
        """Natural frequency |s|/(2π), Hz."""
        return float(np.hypot(self.real, self.imaginary))

    @property
    def damping(self) -> float:
        """Damping ratio −Re s/|s|."""
        return -self.real / self.frequency if self.frequency else 1.0

    @property
    def words(self) -> str:
        """ "12.3 Hz, ζ 0.42", of a real one "3.1 Hz"."""
        real = abs(self.imaginary) < 1e-9 * self.frequency
        damping = "" if real else f", ζ {plain(self.damping, 3)}"
        return f"{plain(self.frequency, 3)} Hz{damping}"


@dataclass(frozen=True)
class PolesAndZeros:
    """The roots, and the effects that have no linear response."""

    roots: tuple[Root, ...]
    left_out: tuple[str, ...] = ()

    def slowest(self, count: int) -> tuple[Root, ...]:
        """The poles of the lowest natural frequencies, one of each pair."""
        poles = (root for root in self.roots if root.kind == "pole" and root.imaginary >= 0)
        return tuple(sorted(poles, key=lambda root: root.frequency)[:count])


def poles_and_zeros(fit: FitResult, run: Run, actuator: Actuator) -> PolesAndZeros:
    """Of what the output depends on; the gain Kp and the specimen are those of the run.

    Raises Unusable for a model that has no linear part.
    """
    try:
        machine = changed_machine(replace(fit, actuator=actuator), Change(specimen=run.specimen or Specimen()))
    except Unusable as error:
        raise Unusable("cannot-draw", error.what, "poles and zeros", error.remedy) from error
    model = servo_loop(machine, run.Kp).linear({}, {})
    poles = np.linalg.eigvals(model.A[0]).astype(complex)
    found = (*_roots("pole", poles), *_roots("zero", zeros(model, float(np.abs(poles).max()))))
    return PolesAndZeros(found, machine.left_out)


def zeros(model: LinearModel, fastest: float) -> NDArray[np.complex128]:
    """Zeros (z,) in 1/s: where det [[A − sI, B], [C, D]] = 0; those beyond a thousand times `fastest` are none."""
    n = model.A.shape[-1]
    system = np.asarray(model.system[..., 0], float)
    # Signals differ by ten decades in SI: states are scaled to their size, which moves no zero.
    scale = np.maximum(np.abs(model.sizes(fastest)[0]), 1e-300)
    system[:n, :n] *= scale[None, :] / scale[:, None]
    system[:n, n] /= scale
    system[n, :n] *= scale
    found = scipy.linalg.eigvals(system, np.diag([*np.ones(n), 0.0]))
    return np.asarray(found[np.isfinite(found) & (np.abs(found) < _FAR * fastest)], complex)


def _roots(kind: Literal["pole", "zero"], found: NDArray[np.complex128]) -> Iterator[Root]:
    for root in sorted(found / (2 * np.pi), key=lambda r: (r.real, -r.imag)):
        yield Root(kind, float(root.real), float(root.imag))
