"""The rig of a hybrid simulation put together: machines in their kernels, substructures, controllers; and its run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import FORCE as INTERACTION
from ident.chain.chain import INPUT, Chain
from ident.hybrid.case import Case
from ident.hybrid.controller import AheadController, Controller, SampledController, no_controller
from ident.hybrid.coupled_case import CoupledCase, System
from ident.hybrid.loop import BEFORE, BEHIND, LANES, WHOLE, Rig, advance_under
from ident.hybrid.machine import DISPLACEMENT, FORCE, JOINED, Machine, joined
from ident.hybrid.substructure import numerical
from ident.progress import Progress, Report, silent
from ident.simulation.stepper import Stepper, stepper

Array = NDArray[np.float64]
_CHUNK = 8192  # samples between two reports
_STAGE = "hybrid simulation"
_COMPILED = (SampledController, AheadController)


def run(rig: Rig, acting: Sequence[Controller], report: Report = silent) -> None:
    """Take a rig through its whole record, or until everything in it has run away."""
    n, compiled = len(rig.ground), all(isinstance(one, _COMPILED) for one in acting)
    for first in range(0, n, _CHUNK):
        report(Progress(_STAGE, first, n))
        last = min(first + _CHUNK, n)
        if not (advance_under(first, last, WHOLE, rig) if compiled else _under(first, last, rig, acting)):
            break
    report(Progress(_STAGE, n, n))


def _under(first: int, last: int, rig: Rig, acting: Sequence[Controller]) -> bool:
    """Samples under controllers that are asked sample by sample; whether the system is still there."""
    asked = [(c, one.step) for c, one in enumerate(acting) if not isinstance(one, _COMPILED)]
    for k in range(first, last):
        advance_under(k, k + 1, BEFORE, rig)
        if rig.ended[0] <= k:
            return False
        for c, step in asked:
            rig.held[k + rig.delay[c], c] = step(float(rig.d[k, c]), float(rig.y[k, c]))
        advance_under(k, k + 1, BEHIND, rig)
    return True


def rig_of(
    machines: Sequence[Machine], systems: Sequence[System], acting: Sequence[Controller], ground: Array, limits: Array
) -> tuple[tuple[Stepper, ...], Rig]:
    """The rig of systems side by side, at rest, each of as many actuators: sixteen machines at most, one by one.

    The systems share all but their physical parts. `limits` (m) are those of each machine. The steppers keep the
    machine code that the rig calls.
    """
    n, count, first = len(ground), len(machines), systems[0]
    cases = [case for system in systems for case in system.cases]
    parts = len(first.places)
    joint = [one for one in systems if isinstance(one, CoupledCase) and one.joined]
    steppers, kernels = _kernels(machines, cases, bool(joint))
    linear = [one if isinstance(one, SampledController) else no_controller(first.sample_rate) for one in acting]
    order = max(one.order for one in linear)
    delay = np.array([case.delay for case in cases])
    noises = [case.noise for case in first.cases]
    rng = np.random.default_rng(noises[0].seed)
    noise = np.array([rng.standard_normal((n, 2)) * [one.displacement, one.force] for one in noises])
    numericals = [numerical(one) for one in systems]
    coupling, masses = np.zeros((3, parts, parts)), np.zeros((2, count))
    if joint:
        coupling = joint[0].coupling[[2, 1, 0]]
        moved = [one.moved_mass(case) for one, case in zip(machines, cases, strict=True)]
        masses = np.array([moved, [case.physical.mass for case in cases]])
    return steppers, Rig(
        **kernels, part=np.arange(count) % parts, spare=np.zeros(LANES), delay=delay,
        held=np.zeros((n + int(delay.max()), count)),
        joined=bool(joint), coupling=coupling, inverse=_inverse_masses(masses[0], coupling[2]), masses=masses,
        interaction=np.zeros((3, count)),
        phi=np.array([one.phi for one in numericals]), drives=np.array([one.drives for one in numericals]),
        place=np.array(first.places), z=np.zeros((len(systems), 2 * first.storeys)), before=np.zeros(count),
        **_controllers(linear, order), sampled=np.array([isinstance(one, _COMPILED) for one in acting]),
        x=np.zeros((count, order)), ahead=_ahead(acting), ground=ground, noise=noise,
        quantum=np.array([[one.displacement_step, one.force_step] for one in noises]),
        d=np.zeros((n, count)), y=np.zeros((n, count)), f=np.zeros((n, count)),
        limit=limits, ended=np.full(len(systems), n, dtype=np.int64),
        scratch=np.zeros(max(2 * first.storeys, order)), u=np.zeros(3 * parts),
    )  # fmt: skip


def _ahead(acting: Sequence[Controller]) -> Array:
    """What controllers computed ahead, a column each; the last sample is held."""
    known = [one.beside if isinstance(one, AheadController) else np.zeros(1) for one in acting]
    longest = max(map(len, known))
    return np.stack([np.pad(one, (0, longest - len(one)), mode="edge") for one in known], axis=1)


def _inverse_masses(masses: Array, coupling: Array) -> Array:
    """Of the joint mass of each system, (L, P, P); a machine without inertia moves whatever it takes: it has no row."""
    systems = masses.reshape(-1, len(coupling))
    found = np.zeros((*systems.shape, len(coupling)))
    for inverse, moved in zip(found, systems, strict=True):
        able = np.flatnonzero(moved)
        if len(able):
            inverse[np.ix_(able, able)] = np.linalg.inv(np.diag(moved[able]) + coupling[np.ix_(able, able)])
    return found


def _controllers(linear: Sequence[SampledController], order: int) -> dict[str, Any]:
    """The matrices of controllers, one behind the other, with states that do nothing up to one order."""
    found = {"A": np.zeros((len(linear), order, order)), "B": np.zeros((len(linear), order, 2)),
             "C": np.zeros((len(linear), 1, order)), "D": np.zeros((len(linear), 1, 2))}  # fmt: skip
    for p, one in enumerate(linear):
        n = one.order
        found["A"][p, :n, :n], found["B"][p, :n], found["C"][p, :, :n], found["D"][p] = one.A, one.B, one.C, one.D
    return found


def _kernels(
    machines: Sequence[Machine], cases: Sequence[Case], joint: bool
) -> tuple[tuple[Stepper, ...], dict[str, Any]]:
    """The kernels of machines, one for those of the same equations, as a rig has them."""
    columns: dict[Chain, list[int]] = {}
    for c, one in enumerate(machines):
        columns.setdefault(one.chain, []).append(c)
    steps = [one.steps(case) for one, case in zip(machines, cases, strict=True)]
    built = []
    for chain, of in columns.items():
        known = [machines[c].at(cases[c]) for c in of]
        values = {name: np.array([entry[name] for entry in known]) for name in chain.symbols}
        finest = max(steps) if joint else max(steps[c] for c in of)
        written = joined(chain) if joint else chain
        shown = (DISPLACEMENT, FORCE, *JOINED) if joint else (DISPLACEMENT, FORCE)
        built.append(stepper(written, values, cases[0].sample_rate, finest, shown, (INTERACTION,) if joint else ()))
    kernel, lane = np.zeros(len(machines), dtype=np.int64), np.zeros(len(machines), dtype=np.int64)
    fed = np.zeros((len(built), LANES), dtype=np.int64)
    for g, of in enumerate(columns.values()):
        kernel[of], lane[of] = g, range(len(of))
        fed[g] = np.array([*of, *[of[-1]] * (LANES - len(of))])
    windows = np.cumsum([0, *(one.steps * LANES for one in built)])
    sizes = np.cumsum([0, *(len(one.buffer) for one in built)])
    return tuple(built), {
        "code": np.array([one.code for one in built]), "begin": sizes[:-1],
        "buffer": np.concatenate([one.buffer for one in built]), "rows": np.array([_rows(one) for one in built]),
        "steps": np.array([one.steps for one in built]), "lanes": np.array([one.lanes for one in built]),
        "column": fed, "whole": np.array([one.whole for one in built]),
        "broken": np.array([one.share > 0 for one in built]),
        "window": np.zeros(int(windows[-1])), "window_at": windows[:-1],
        "places": np.zeros(len(built) * LANES, dtype=np.int64), "pushes": np.zeros(len(built) * LANES),
        "pushed_at": np.zeros(len(built) * LANES, dtype=np.int64), "kernel": kernel, "lane": lane,
    }  # fmt: skip


def _rows(of: Stepper) -> list[int]:
    """Where a kernel has what the loop reads and writes, in the order of the loop."""
    displacement, force, *motion = of.shown
    return [of.inputs[INPUT], displacement, force, of.inputs.get(INTERACTION, 0), *(motion or (0, 0, 0))]
