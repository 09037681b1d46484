"""A fit in, a controller out: designed on the linear part, with its margins and with their uncertainty by that of the
fit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.hybrid_loop import EarlierCase, judge_hybrid
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.linear_plant import LinearPlant, linear_plant
from ident.hybrid.loop_shaping import Design, design
from ident.hybrid.machine import machine
from ident.hybrid.margins import Margins, margins
from ident.hybrid.parameter_samples import DRAWS, Covariance, Spread, drawn_parameters
from ident.hybrid.rig_limits import limits_of
from ident.hybrid.robustness import (
    Robustness,
    frequencies,
    held_in,
    robustness,
)
from ident.hybrid.servo_loop import plant_loop, values_before
from ident.hybrid.target_loop import QIAN2014_TARGET, Target
from ident.plain import written
from ident.run import Specimen
from ident.stability.judgement import Judgement, judge
from ident.words.message import message
from ident.words.number import trimmed
from ident.words.result_tables import Listing, TabularResult

_TITLES = {"gain": "gain margin", "phase": "phase margin", "sensitivity_peak": "sensitivity peak"}
LITTLE_MARGIN = 2.5
"""The sensitivity peak from which on a design warns: of gain only 4.4 dB, of phase only 23° are then certain."""


@dataclass(frozen=True)
class ControllerDesign(TabularResult):
    """A design, its margins, its robustness over the fitted covariance (None where that is unknown), and notes.

    `beyond` says what leaves the limits of the rig where the controller runs its case, `stability` whether that loop is
    stable: None where it was not run, or has no poles.
    """

    design: Design
    margins: Margins
    robustness: Robustness | None
    notes: tuple[str, ...]
    beyond: tuple[str, ...] = ()
    stability: Judgement | None = None

    def to_json(self) -> dict[str, Any]:
        """The JSON of the controller, with the design beside it."""
        made = self.design
        found: dict[str, Any] = {
            "state": self.stability.state if self.stability else None,
            "stability": self.stability.to_json() if self.stability else None,
            "structure": made.structure,
            "target": made.target.to_json(),
            "delay": made.delay,
            "gamma": {
                "target": made.gamma_target,
                "min": made.stabilised.gamma_min,
                "used": made.stabilised.gamma,
            },
            "order": {"full": made.full.order, "reduced": made.controller.order},
            "margins": written(self.margins),
            "notes": [*self.beyond, *self.notes],
        }
        if self.robustness is not None:
            counts = {name: getattr(self.robustness, name) for name in ("draws", "stable", "within")}
            found["robustness"] = {
                **counts,
                "held": list(self.robustness.held),
                "spread": self.robustness.spread,
                "margins": written(self.robustness.margins),
            }
        return {**made.controller.to_json(), "design": found}

    def listings(self) -> Iterator[Listing | str]:
        """What is unstable or leaves the limits of the rig, what the loop can stand and how it follows, the notes."""
        yield from self.stability.text if self.stability else ()
        yield from self.beyond
        yield Listing("", ("quantity", "value", "unit"), self.rows, ("value",))
        for note in self.notes:
            yield f"note: {note}"

    @property
    def rows(self) -> list[tuple[str, str, str]]:
        """What a reader wants to know: quantity, value, unit."""
        made, found, judged = self.design, self.margins, self.robustness
        rows = [
            ("structure", made.structure, ""),
            ("γmin of the target", f"{made.gamma_target:.3f}", ""),
            ("γmin with its roll-off", f"{made.stabilised.gamma_min:.3f}", ""),
            ("states, and before the reduction", f"{made.controller.order}, {made.full.order}", ""),
            ("gain margin", _or_none(found.gain, 1.0), "dB"),
            ("phase margin", _or_none(found.phase, 1.0), "°"),
            ("delay margin", _or_none(found.delay, 1e3), "ms"),
            ("sensitivity peak", f"{found.sensitivity_peak:.2f}", ""),
            ("magnitude to 5 Hz, within", f"{found.magnitude_5:.2g}", "dB"),
            ("magnitude to 25 Hz, within", f"{found.magnitude_25:.2g}", "dB"),
            ("phase to 10 Hz, within", f"{found.phase_10:.2g}", "°"),
            ("phase to 25 Hz, within", f"{found.phase_25:.2g}", "°"),
            ("largest gain", f"{found.peak:.1f}", "dB"),
            ("command by sensor noise", f"{found.noise_gain:.0f}", "m/m RMS"),
        ]
        if judged is not None:
            within = "design.nominal" if made.structure == "feedback" else "design.wanted"
            rows += [
                ("drawn actuators that stay stable", f"{judged.stable} of {judged.draws}", ""),
                (str(message(within)), f"{judged.within} of {judged.draws}", ""),
                *(
                    (f"{_TITLES[name]} of 90 % of them", one.ends, one.unit.removesuffix("1"))
                    for name, one in judged.margins.items()
                ),
            ]
        return rows


def _or_none(value: float | None, factor: float) -> str:
    return "no limit" if value is None else f"{factor * value:.3g}"


def design_controller(
    fit: FitResult,
    specimen: Specimen,
    *,
    sample_rate: float,
    gain: float | None = None,
    piston_area: float | None = None,
    delay: float = 1.0,
    target: Target = QIAN2014_TARGET,
    structure: str = "feedback",
    draws: int = DRAWS,
    seed: int = 0,
    before: EarlierCase | None = None,
    spread: Spread | None = None,
) -> ControllerDesign:
    """A controller for the actuator of a fit with this specimen, gain Kp and piston area (m²).

    `sample_rate` in Hz, `delay` in samples; `draws` plants are drawn with `seed` from a `spread`, without one from the
    fitted covariance. Raises Unusable where the fit has no displacement that a command drives, or no stable loop is
    found. That error names the mode of an unstable servo loop and its remedies, and the cause where the loop is known
    as it was `before`.
    """
    plant = linear_plant(fit, specimen, gain, piston_area)
    _refuse_unstable(plant, before)
    made = design(plant.model, sample_rate, delay, target, structure)
    drawn = drawn_parameters(fit, draws, seed, spread)
    judged = None
    if drawn:
        wanted = made.loop.response(frequencies()) if structure == "feedback" else None
        plants = plant.drawn({name: np.asarray(values) for name, values in drawn.items()})
        judged = robustness(made.loop, plants, wanted, held_in(fit, drawn), str(spread or Covariance()))
    found = margins(made.loop)
    return ControllerDesign(made, found, judged, _notes(found, plant.left_out, judged))


def _refuse_unstable(plant: LinearPlant, before: EarlierCase | None) -> None:
    """Raise Unusable where the servo loop that a controller is to be designed for is unstable."""
    loop, known = plant_loop(plant), None
    if before is not None:
        case = before.case
        earlier = linear_plant(before.fit, case.physical, case.gain, case.piston_area)
        known = values_before(earlier.known, loop)
    found = judge(loop, known, f"at Kp = {trimmed(plant.known['Kp'])}")
    if not found.stable:
        raise Unusable(
            "unstable-plant",
            f"the identified servo loop is {found.what}",
            "case",
            found.remedy or "lower the gain, or correct the specimen",
        )


def on_case(made: ControllerDesign, fit: FitResult, case: Case, before: EarlierCase | None = None) -> ControllerDesign:
    """The design with whether its case is stable under it, and what leaves the limits of the rig.

    The cause of an unstable case is named where the case is known as it was `before`. The case is simulated where
    limits are stated. Raises Unusable as :func:`ident.hybrid.hybrid_simulation.simulate_hybrid`.
    """
    of = machine(fit, case)
    if not of.nonlinear:
        made = replace(made, stability=judge_hybrid(of, case, made.design.controller, before))
    if not limits_of(fit, case):
        return made
    run = simulate_hybrid(fit, case, made.design.controller)
    beyond = run.beyond if run.ended is None else ("beyond the rig: the case runs away under this controller",)
    return replace(made, beyond=beyond)


def _notes(found: Margins, left_out: tuple[str, ...], judged: Robustness | None) -> tuple[str, ...]:
    """What a reader should know before trusting it."""
    notes = []
    if found.sensitivity_peak > LITTLE_MARGIN:
        notes.append(
            f"a sensitivity peak of {found.sensitivity_peak:.1f} leaves little margin: choose a slower target, or a "
            "shorter delay"
        )
    if left_out:
        notes.append(f"designed on the linear part of the model, without {', '.join(left_out)}")
    if judged is None:
        notes.append("the fit states no standard errors: nothing is known about the robustness over its covariance")
    elif judged.held:
        why = "the data do not determine" if judged.spread == str(Covariance()) else "the spread does not state"
        notes.append(f"{why} {', '.join(judged.held)}: fixed at the fitted values in every draw")
    return tuple(notes)
