"""Loop shaping for an identified actuator: a target for the open loop, made robust, sampled, with or without a path
forward.

The plant G is the closed servo loop with the specimen on it. W = Gd/G makes the open loop the target Gd; its zeros are
G's poles and cancel them, so that the shaped plant is Gd behind the roll-off, and behind an all-pass where G has zeros
in the right half-plane. K∞ of :mod:`ident.hybrid.glover_mcfarlane` makes it robust, and the controller is W K∞,
sampled by Tustin's rule:

    feedback     u = W K∞ (d − y)
    two-degree   u = F d + W K∞ (P F d − y)

with P the sampled plant and F that of :mod:`ident.hybrid.prefilter`. The second compares the measured displacement
with the one that the path forward is to bring, so that feedback acts only on what the model does not know.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.errors import Unusable
from ident.hybrid.controller import SampledController
from ident.hybrid.glover_mcfarlane import Stabilised, robust_stabilisation
from ident.hybrid.prefilter import prefilter
from ident.hybrid.rational import Rational
from ident.hybrid.reduction import reduced
from ident.hybrid.sampled_loop import SampledLoop
from ident.hybrid.state_space import StateSpace, sampled_plant
from ident.hybrid.target_loop import QIAN2014_TARGET, Target
from ident.linear import LinearModel
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
STRUCTURES = ("feedback", "two-degree")
FACTOR = 1.03
"""γ over γmin: at 1 a pole of K∞ goes to infinity; 1.1 would cost a tenth of the margin."""
LATEST = 64
"""Samples: the longest delay that is designed for; each is a state of the loop, and of a hundred drawn ones."""
_NONE = np.zeros(0, complex)


@dataclass(frozen=True)
class Design:
    """A controller with what it was designed for; `delay` in samples.

    `full` is the controller before its reduction; `gamma_target` is γmin of the target alone, `stabilised` has that of
    the target with its roll-off, which the controller has.
    """

    controller: SampledController
    full: SampledController
    plant: LinearModel
    delay: float
    target: Target
    structure: str
    gamma_target: float
    stabilised: Stabilised

    @cached_property
    def loop(self) -> SampledLoop:
        """The controller around the plant that it was designed on."""
        return SampledLoop(self.plant, self.controller, self.delay)


def design(
    plant: LinearModel,
    sample_rate: float,
    delay: float = 1.0,
    target: Target = QIAN2014_TARGET,
    structure: str = "feedback",
) -> Design:
    """A controller for a stable plant command → displacement (a linear model without a batch, SI).

    `sample_rate` is in Hz; the command acts `delay` samples after the displacement was measured, and is held. Raises
    Unusable where the plant is not stable, and where the sampled loop would not be.
    """
    if structure not in STRUCTURES:
        remedy = did_you_mean(structure, STRUCTURES)
        raise Unusable("unknown-structure", f"no structure {structure!r}", "structure", remedy)
    if delay > LATEST:
        raise Unusable(
            "too-late",
            f"the command acts {delay:g} samples after the measurement",
            "delay",
            f"design for at most {LATEST} samples, at a lower rate",
        )
    outer, through = factored(Rational.of_model(plant))
    rolled = target.rational.times(_roll_off(target, outer))
    stabilised = robust_stabilisation(rolled.times(through).realised(), FACTOR)
    weight = rolled.times(outer.inverse()).bilinear(sample_rate).realised()
    feedback = weight.before(stabilised.controller.bilinear(sample_rate))
    name = f"{structure} for {target.name}"
    if structure == "feedback":
        full = SampledController(*_of_difference(feedback), sample_rate, name)
    else:
        late = (delay + 0.5) / sample_rate + 2.0 * float(np.sum(1.0 / through.zeros).real)
        model = sampled_plant(plant, sample_rate, delay)
        forward = prefilter(outer, model, sample_rate, late).realised()
        full = SampledController(*_two_degree(forward, model, feedback), sample_rate, name)
    whole = SampledLoop(plant, full, delay)
    if not whole.stable:
        raise Unusable(
            "no-controller",
            f"the sampled loop is not stable with it: {whole.mode}",
            "target",
            "choose a slower target, or a shorter delay",
        )
    gamma_target = robust_stabilisation(target.rational.realised(), FACTOR).gamma_min
    return Design(reduced(whole), full, plant, delay, target, structure, gamma_target, stabilised)


def factored(plant: Rational) -> tuple[Rational, Rational]:
    """G = (what can be inverted) × (all-pass): zeros in the right half-plane are mirrored, (1 − s/z)/(1 + s/z̄).

    Raises Unusable where G is unstable, does not fall at high frequency, or does not hold a displacement.
    """
    if plant.poles.real.max(initial=-1.0) >= 0:
        raise Unusable(
            "unstable-plant",
            "the identified servo loop is not stable with this specimen and gain",
            "case",
            "lower the gain, or correct the specimen",
        )
    near_nothing = 1e-9 * np.abs(plant.poles).min(initial=np.inf)
    if not plant.relative_degree or np.abs(plant.zeros).min(initial=np.inf) < near_nothing:
        raise Unusable(
            "no-answer",
            "the plant does not follow a displacement as an actuator does",
            "fit",
            "give the fit of an actuator whose command is a displacement",
        )
    right = plant.zeros.real > 0
    bad = plant.zeros[right]
    mirrored = np.where(right, -plant.zeros.conj(), plant.zeros)
    sign = (-1.0) ** len(bad)
    return Rational(mirrored, plant.poles, sign * plant.gain), Rational(bad, -bad.conj(), sign)


def _roll_off(target: Target, outer: Rational) -> Rational:
    """The poles that make Gd/G proper, of static gain 1."""
    count = max(0, outer.relative_degree - target.rational.relative_degree)
    return Rational(_NONE, np.full(count, -target.roll_off, complex), target.roll_off**count)


def _of_difference(K: StateSpace) -> tuple[Array, Array, Array, Array]:
    """u = K (d − y)."""
    return K.A, np.hstack([K.B, -K.B]), K.C, np.hstack([K.D, -K.D])


def _two_degree(F: StateSpace, P: StateSpace, K: StateSpace) -> tuple[Array, Array, Array, Array]:
    """u = F d + K (P F d − y), with the states of F, P and K."""
    f, p, k = F.order, P.order, K.order
    model = F.before(P)
    A = np.block([[model.A, np.zeros((f + p, k))], [K.B @ model.C, K.A]])
    B = np.block([[model.B, np.zeros((f + p, 1))], [K.B @ model.D, -K.B]])
    C = np.hstack([np.hstack([F.C, np.zeros((1, p))]) + K.D @ model.C, K.C])
    return A, B, C, np.hstack([F.D + K.D @ model.D, -K.D])
