"""The inverse of the fifth-order actuator: the drive of the valve with which its table follows a reference.

The equations of the preset `strano` (S. Strano, M. Terzo et al., eqs. (1) to (4)), each solved for what goes into it:

    P  = ((m + mL) y'' + (σ + cL) y' + k y + (Fc + μ N) s) / A          s: the side of the speed, sgn y' smoothed
    Q  = A y' + C P'
    ve = Q / (kq √(Ps − sgn(Q) P)) + edge                               kq, edge: kqp, vep for Q > 0, else kqn, ven
    vc = ve'' / ωn² + 2 ξ ve' / ωn + ve
    u  = (vc − ve0) / kep where that is positive, else (vc − ve0) / ken

Five derivatives of the reference would be needed, and the spool would have to jump across the dead zone: reference,
side and spool signal pass a Gaussian filter without delay first, whose derivatives are exact. So the inverse is proper,
and the reference has to be known ahead by some six widths of the filter.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ident.errors import Unusable

Array = NDArray[np.float64]
WIDTH = 0.4
"""Of the valve's time 1/ωn: the width of the filter where none is asked for."""
_REACH = 6.0  # widths to either side
_LEAST = 1.5  # samples of a width: below it the sampled kernel's derivatives are off
_STILL = 1e-6  # of the largest flow: at rest the spool stays where the bias holds it
_HIGHEST = 0.95  # of the supply pressure that the motion may need


@dataclass(frozen=True)
class Inverse:
    """The inverse at `values`: every parameter of `strano`, and the conditions A, Ps, Nv, mL, k, cL (SI and V).

    `width` (s) is the standard deviation of the filter, 0.4/ωn where it is 0.
    """

    values: Mapping[str, float]
    width: float = 0.0

    def drive(self, reference: Array, sample_rate: float) -> Array:
        """The voltage u (V), (n,), for a reference (m), (n,), at `sample_rate` (Hz).

        Raises Unusable where the reference asks for more force than the supply pressure gives.
        """
        of = self.values
        width = max((self.width or WIDTH / of["wn"]) * sample_rate, _LEAST)
        y, v, a, jerk = (_smoothed(reference, width, order, sample_rate) for order in range(4))
        side = np.sign(np.where(np.abs(v) > _STILL * np.abs(v).max(initial=1e-300), v, 0.0))
        s, turn = (_smoothed(side, width, order, sample_rate) for order in range(2))
        mass, damping, dry = of["m"] + of["mL"], of["sigma"] + of["cL"], of["Fc"] + of["mu"] * of["Nv"]
        P = (mass * a + damping * v + of["k"] * y + dry * s) / of["A"]
        flow = of["A"] * v + of["C"] * (mass * jerk + damping * a + of["k"] * v + dry * turn) / of["A"]
        ve = self._spool(P, flow)
        ve, rate, bend = (_smoothed(ve, width, order, sample_rate) for order in range(3))
        beside = bend / of["wn"] ** 2 + 2.0 * of["xi"] * rate / of["wn"] + ve - of["ve0"]
        return np.asarray(beside / np.where(beside >= 0, of["kep"], of["ken"]))

    def _spool(self, P: Array, flow: Array) -> Array:
        """The spool signal that lets a flow through."""
        of, forward = self.values, flow > 0
        needed = float(np.max(np.sign(flow) * P, initial=0.0))
        if needed > _HIGHEST * of["Ps"]:
            raise Unusable(
                "too-fast",
                f"the reference needs a load pressure of {1e-5 * needed:.3g} bar of {1e-5 * of['Ps']:.3g}",
                "reference",
                "take a slower or a smaller motion",
            )
        opening = flow / (np.where(forward, of["kqp"], of["kqn"]) * np.sqrt(of["Ps"] - np.sign(flow) * P))
        moving = np.abs(flow) > _STILL * np.abs(flow).max(initial=1e-300)
        return np.where(moving, opening + np.where(forward, of["vep"], of["ven"]), of["ve0"])


def _smoothed(signal: Array, width: float, order: int, sample_rate: float) -> Array:
    """A signal, or its derivative of an order, behind a Gaussian filter of a width in samples."""
    filtered = gaussian_filter1d(signal, width, order=order, mode="nearest", truncate=_REACH)
    return np.asarray(filtered * sample_rate**order)
