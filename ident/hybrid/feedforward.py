"""Feedforward from the inverse of the nonlinear model, with the position loop's feedback for what it does not know.

    u = K (r − y) + u_ff(r)    V,   given to the loop as the command  r + u_ff(r)/K    m

(S. Strano, M. Terzo et al., Fig. 4). The loop's own gain K stays as it is, so that the feedforward changes nothing of
its stability; how far K may go is :func:`gain_limit`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.chain.conditions import conditions
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.controller import AheadController
from ident.hybrid.inverse import Inverse
from ident.matrix import Actuator
from ident.presets.strano import STRANO
from ident.run import Run, Specimen
from ident.simulation.simulate import responses
from ident.simulation.steps import fastest_mode, steps_needed

Array = NDArray[np.float64]
_SIDES = ((("q1", "vep - ve0"), ("u", "1")), (("q1", "ven - ve0 - 1e-6"), ("u", "-1")))
_REACH = (1e-3, 1e7)  # V/m: where the limit is looked for
_BAND = (5.0, 95.0)  # per cent


@dataclass(frozen=True, eq=False)
class Plant:
    """A machine under its position loop: values by name (SI and V; numbers, or one an entry of a batch), gain in V/m.

    `supply` in Pa, `vertical` in N; `specimen` is what the table moves beside itself. Raises Unusable where something
    of the model is missing, or the gain is none.
    """

    values: Mapping[str, float | Array]
    area: float
    supply: float
    gain: float
    vertical: float = 0.0
    specimen: Specimen = field(default_factory=Specimen)

    def __post_init__(self) -> None:
        missing = [p.name for p in STRANO.parameters if p.name not in self.values]
        if missing:
            raise Unusable("not-that-model", f"no value of {', '.join(missing)}", "fit", f"fit the model {STRANO.name}")
        if not self.gain > 0:
            raise Unusable("zero-gain", f"gain {self.gain:g} V/m", "gain", "give the gain of the position loop, V/m")

    @property
    def known(self) -> dict[str, float | Array]:
        """Every symbol of its equations."""
        run = Run("", "", 1.0, {}, gain=self.gain, specimen=self.specimen)
        actuator = Actuator("", piston_area=self.area, supply_pressure=self.supply)
        return {**conditions(run, actuator), "Nv": self.vertical, **self.values}


def plant_of(fit: FitResult, actuator: Actuator, gain: float, vertical: float = 0.0) -> Plant:
    """The machine of a fit of `strano`. Raises Unusable for another model, or where area or supply are not stated."""
    if fit.model != STRANO.name:
        raise Unusable("not-that-model", f"the fit is of {fit.model}", "fit", f"fit the model {STRANO.name}")
    if actuator.piston_area is None or actuator.supply_pressure is None:
        what = "piston_area" if actuator.piston_area is None else "supply_pressure"
        raise Unusable("not-stated", f"{what} is not stated", f"actuator.{what}", "state it, with its unit")
    return Plant(fit.values, actuator.piston_area, actuator.supply_pressure, gain, vertical)


def command(plant: Plant, reference: Array, sample_rate: float, width: float = 0.0) -> Array:
    """The command (m), (n,), that makes the loop of a plant follow a reference (m), (n,): r + u_ff(r)/K."""
    values = {name: float(value) for name, value in plant.known.items()}
    return np.asarray(reference + Inverse(values, width).drive(reference, sample_rate) / plant.gain)


def gain_limit(plant: Plant) -> float:
    """The gain (V/m) from which the loop is unstable about an open valve, infinite where there is none.

    The smaller one of both sides, with the valve just open, where no flow damps the oil: the least favourable point.
    The computer's delay, if it has one, is not in it.
    """
    chain = STRANO.chain
    values = {name: np.asarray(value, dtype=float) for name, value in plant.known.items()}

    def growth(gain: float, about: tuple[tuple[str, str], ...]) -> float:
        A = replace(chain, about=about).linearise({**values, "Kp": np.array(gain)}).A
        return float(np.linalg.eigvals(A).real.max())

    limits = [np.inf]
    for about in _SIDES:
        grid = np.geomspace(*_REACH, 101)
        first = next((i for i, gain in enumerate(grid) if growth(gain, about) > 0), 0)
        if first:
            limits.append(float(scipy.optimize.brentq(growth, grid[first - 1], grid[first], args=(about,), rtol=1e-6)))
    return min(limits)


def followed(plant: Plant, commanded: Array, sample_rate: float) -> Array:
    """The position (m) of each machine of a plant under a command (m), (v, n), from rest."""
    known = {name: np.atleast_1d(np.asarray(value, dtype=float)) for name, value in plant.known.items()}
    symbols = {name: known[name] for name in STRANO.chain.symbols}
    fastest = fastest_mode(STRANO.chain, symbols, "displacement") / sample_rate
    steps = int(steps_needed(STRANO.chain, np.atleast_1d(fastest), "linear", (), kinks=STRANO.steps).max())
    run = Run("", "", sample_rate, {"command": commanded, "displacement": commanded}, gain=plant.gain)
    wide = {name: value[None] for name, value in symbols.items()}
    return np.asarray(responses(STRANO.chain, [run], wide, steps)[:, 0].T)


@dataclass(frozen=True, eq=False)
class Tracked:
    """How a machine follows a reference with the feedback alone and with the feedforward beside it.

    All m, (n,): `reference`, `command`; the errors r − y with `feedback` alone and `both`, of the machine itself, (n,),
    and of what was drawn, (draws, n). `limit` and `gain` in V/m.
    """

    sample_rate: float
    gain: float
    limit: float
    reference: Array
    command: Array
    feedback: Array
    both: Array
    drawn_feedback: Array
    drawn_both: Array

    @property
    def margin(self) -> float:
        """By how much the gain could rise before the loop is unstable, dB."""
        return float(20.0 * np.log10(self.limit / self.gain))

    def rms(self, skip: float = 0.0) -> dict[str, Array]:
        """RMS errors (m) after `skip` s: `feedback`, `both`, and those of the draws."""
        first = round(skip * self.sample_rate)
        shown = ("feedback", "both", "drawn_feedback", "drawn_both")
        return {name: np.sqrt(np.mean(getattr(self, name)[..., first:] ** 2, axis=-1)) for name in shown}

    def band(self) -> Array:
        """Between what 90 % of the draws lie with the feedforward, m, (2, n)."""
        return np.asarray(np.percentile(self.drawn_both, _BAND, axis=0))


def tracked(
    model: Plant,
    machine: Plant,
    reference: Array,
    sample_rate: float,
    draws: Mapping[str, Array] | None = None,
    width: float = 0.0,
) -> Tracked:
    """A `machine` that follows a reference by the feedforward of a `model` of it, and so do machines drawn around it.

    `draws` holds values (v,) by name, in place of those of the machine.
    """
    given = command(model, reference, sample_rate, width)
    several = dict(draws or {})
    drawn = Plant(
        {**machine.values, **several}, machine.area, machine.supply, machine.gain, machine.vertical, machine.specimen
    )
    left = [reference - followed(one, what, sample_rate) for one in (machine, drawn) for what in (reference, given)]
    errors = {"feedback": left[0][0], "both": left[1][0], "drawn_feedback": left[2], "drawn_both": left[3]}
    return Tracked(sample_rate, model.gain, gain_limit(model), reference, given, **errors)


class FeedforwardController(AheadController):
    """The controller of a rig: d wanted and y measured in this sample (m) → the actuator's command (m).

    The feedforward of a `reference` known ahead is added to d; the loop's own feedback does the rest.
    """

    def __init__(self, plant: Plant, reference: Array, sample_rate: float, width: float = 0.0) -> None:
        super().__init__(command(plant, reference, sample_rate, width) - reference, sample_rate)
