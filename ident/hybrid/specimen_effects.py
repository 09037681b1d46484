"""The whole structure with what of its specimen is not linear: hysteresis, play, a spring that hardens.

    M x'' + C x' + K x = −M ι a(t) − e (S(x_p, x_p') − k x_p − c x_p')

S is the reaction of the specimen by the same equations that the machine is loaded with: those of the effects that
change nothing but it. With these off it is k x_p + c x_p', and the structure the one of the case.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import Chain
from ident.effects.effect import Effect
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.machine import DISPLACEMENT, Machine, machine
from ident.hybrid.substructure import reference
from ident.run import Run
from ident.simulation.simulate import responses
from ident.simulation.steps import fastest_mode, steps_needed
from ident.stages import Quantity
from ident.stages.stage import Stage, stage

Array = NDArray[np.float64]
_REACTION = {"S", "xk"}
"""What an effect redefines that is one of the specimen alone: its reaction, and the stretch of its spring."""
_BAND = 80.0  # Hz: a structure moves by less


def of_specimen(of: Machine) -> tuple[Effect, ...]:
    """The effects of a machine that are on and change the reaction of the specimen alone."""
    core = {equation.target for one in of.chain.stages for equation in one.equations}
    return tuple(
        effect
        for effect in of.chain.effects
        if of.values[effect.added[0].in_equations] and {e.target for e in effect.equations} & core <= _REACTION
    )


def reference_of(of: Machine, case: Case, ground: Array) -> Array:
    """The displacement (m) of the storey of the specimen that a perfect machine would give, (n,).

    Exact at the samples as :func:`ident.hybrid.substructure.reference` where the specimen is linear, else by
    Runge-Kutta steps.
    """
    effects = of_specimen(of)
    if not effects or case.table is not None:
        return reference(case, ground)
    chain = Chain((_structure(case),), {DISPLACEMENT: "xL"}, effects)
    known = {name: np.array([value]) for name, value in of.at(case).items()}
    values = {name: known[name] for name in chain.symbols}
    fastest = fastest_mode(chain, values, DISPLACEMENT) / case.sample_rate
    steps = int(steps_needed(chain, fastest, "linear", effects, 2 * np.pi * _BAND / case.sample_rate).max())
    run = Run(
        "whole",
        "",
        case.sample_rate,
        {"command": ground, DISPLACEMENT: np.zeros(len(ground))},
        {"command": "m/s^2", DISPLACEMENT: "m"},
        hold="linear",
    )
    return np.asarray(responses(chain, [run], {name: value[:, None] for name, value in values.items()}, steps)[:, 0, 0])


def wanted_in(fit: FitResult, case: Case, effects: Mapping[str, float] | None = None) -> Array:
    """The reference solution of a case on the machine of a fit, (n,), with its effects and further ones."""
    return reference_of(machine(fit, case, effects), case, case.ground.samples(case.sample_rate))


def references(of: Machine, cases: Sequence[Case], ground: Array) -> list[Array]:
    """:func:`reference_of` each of cases that share their whole structure."""
    by_spring = any(equation.target == "xk" for effect in of_specimen(of) for equation in effect.equations)
    first = reference_of(of, cases[0], ground)
    return [reference_of(of, case, ground) if by_spring else first for case in cases]


def _structure(case: Case) -> Stage:
    """The structure as a load that the acceleration u of the ground moves, and the specimen at its place."""
    n, p = case.storeys, case.place + 1
    states = [
        Quantity(f"{name}{i}", unit, "motion of the structure")
        for name, unit in (("v", "m/s"), ("x", "m"))
        for i in range(1, n + 1)
    ]
    specimen = (
        Quantity("xL", "m", "position of the specimen"),
        Quantity("vL", "m/s", "speed of the specimen"),
        Quantity("xk", "m", "stretch of the specimen's spring"),
        Quantity("S", "N", "reaction of the specimen"),
    )
    return stage(
        "load",
        (*states, *specimen),
        (f"xL = x{p}", "the specimen stands at its storey"),
        (f"vL = v{p}", "it has the speed of its storey"),
        ("xk = xL", "the spring has no play"),
        ("S = k * xk + cL * vL", "spring and damper of the specimen"),
        *_motion(case),
    )


def _motion(case: Case) -> Iterator[tuple[str, str]]:
    """x' = v, and v' = −ι u − M⁻¹ (C_n v + K_n x + e S), with numbers for the matrices."""
    inverse = np.linalg.inv(case.mass)
    by_speed, by_way = inverse @ case.numerical_damping, inverse @ case.numerical_stiffness
    by_force = inverse[:, case.place]
    for i in range(case.storeys):
        terms = [(case.influence[i], "u"), (by_force[i], "S")]
        terms += [(by_speed[i, j], f"v{j + 1}") for j in range(case.storeys)]
        terms += [(by_way[i, j], f"x{j + 1}") for j in range(case.storeys)]
        sum_of = " - ".join(f"({float(factor)!r}) * {name}" for factor, name in terms if factor)
        yield f"v{i + 1}' = 0 - {sum_of}", "the structure under the motion of its ground"
        yield f"x{i + 1}' = v{i + 1}", "its way"
