"""What the documented way makes of a measured machine, beside what is known of it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from ident.diagnosis.result import Diagnosis
from ident.diagnosis.structure_selection import choose_structure
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.readers import read_matrix
from ident.words.engineering import quantity
from ident.words.percent import percent
from ident.workflows import diagnose, identify

KNOWN = {
    "mr_damper": "best linear 45 / 50 %; Dahl and viscous friction 17.2 / 18.5 %",
    "dc_motor": "linear 26.4 / 28.8 %; dead zone of 1.91 V 6.88 / 12.7 %, dry friction instead 6.47 / 16.0 %",
    "excavator_boom": "over 1 s linear 8.0 / 6.2 %, dead zone 5.5 / 4.7 %, with delay and skew 4.15 / 3.34 %",
    "emps": "dry friction of 20.4 N beside 203 N·s/m",
    "crane_actuator": "free run on the second half 47 to 58 %, a linear ARX model 95 %",
    "mts_actuator": "second-order linear model of its authors 5.2 % on both runs",
    "damper_sine": "viscous and Coulomb friction 16.5 / 15.8 %, viscous and Dahl friction, as published, 12.2 / 9.3 %",
    "hoop_motor": "linear 13.9 / 14.6 %, with a saturating drive 4.3 / 2.9 %",
    "hsm150_measured_torque": "J 1.23e-4 kg·m², B 7.2e-5 N·m·s, dry friction 0.033 N·m, constant torque −0.007 N·m",
    "rc_column": "linear 52 / 83 %, Dahl friction 24 / 34 %, Bouc–Wen with degradation 13 / 24 %",
    "wheel_loader": "the lever that lowers the boom is not recorded",
    "coupled_drives": "speed as its absolute value, a resonance; best published black box 0.097 / 0.073 ticks/s",
    "cascaded_tanks": "overflow and a bent sensor 0.244 V, the best published grey box 0.191 V",
    "silverbox": "cubic stiffness; best published black box 0.30 / 0.26 mV",
    "bouc_wen": "hysteresis with free shape; best published black box 1.9e-5 / 1.2e-5 m",
    "eha": "a lag on extension that grows with the load",
    "rack": "viscous, dry and Stribeck friction, 25.6 to 23.3 %, fitted only",
    "motor_generator": "linear 50 / 54 %, fast up and slow down 33 / 36 %",
    "emps_volts": "mass, viscous and dry friction, constant force: 4.85 mm on the pulses",
    "emps_newtons": "mass, viscous and dry friction, constant force: 4.85 mm on the pulses",
    "hsm150": "the commanded torque is not what the drive gives: J from 1.2e-4 to 3.7e-4 kg·m² by run",
}
"""By the folder's name, what experts found: errors on the fitted and on the held-back record."""
BY_HAND = {
    "coupled_drives": "0.037 / 0.047 ticks/s",
    "silverbox": "0.239 / 0.306 mV",
    "bouc_wen": "2.4e-7 / 2.3e-6 m",
    "cascaded_tanks": "0.24 V",
    "emps_volts": "4.85 mm",
    "emps_newtons": "4.85 mm",
    "dc_motor": "6.88 / 12.7 %",
    "excavator_boom": "4.15 / 3.34 % over 1 s",
    "mr_damper": "14.9 / 15.9 %",
    "damper_sine": "12.2 / 9.3 %",
    "hoop_motor": "4.3 / 2.9 %",
    "rc_column": "13 / 24 %",
    "rack": "23.3 %, fitted",
    "motor_generator": "33 / 36 %",
    "mts_actuator": "2.95 / 2.55 %",
}
"""What an expert reached with this program, or with least squares of his own; errors as the benchmark defines them."""
PUBLISHED = {
    "coupled_drives": "0.097 / 0.073 ticks/s",
    "silverbox": "0.30 / 0.26 mV",
    "bouc_wen": "1.9e-5 / 1.2e-5 m",
    "cascaded_tanks": "0.191 V",
    "emps_volts": "2.64 mm",
    "emps_newtons": "2.64 mm",
    "crane_actuator": "47 / 58 %",
    "mts_actuator": "5.2 / 5.2 %",
}
"""The best published figures."""


@dataclass(frozen=True)
class Judged:
    """A machine's fit and diagnosis, and how long both took, s."""

    name: str
    fit: FitResult
    found: Diagnosis
    seconds: float

    @property
    def row(self) -> tuple[str, ...]:
        """Machine, model, errors before and after on fitted and held-back runs, what was named, standing, terms, s."""
        over = "" if self.found.horizon is None else f" over {self.found.horizon:.2g} s"
        first, last = (rung.error for rung in (self.found.ladder[0], self.found.confirmed_ladder[-1]))
        before, after = (f"{percent(error['fit'])} / {percent(error['verify'])}" for error in (first, last))
        named = ", ".join(self.found.verdict.effects) or "–"
        standing = str(self.found.verdict.standing).replace("_", "-")
        return (
            self.name,
            self.fit.model,
            before + over,
            after + over,
            named,
            standing,
            self._proposed,
            f"{self.seconds:.0f}",
            self._size,
            BY_HAND.get(self.name, "–"),
            PUBLISHED.get(self.name, "–"),
            time.strftime("%Y-%m-%d"),
        )

    @property
    def _size(self) -> str:
        """The RMSE of the last step of the ladder on the held-back record, its mean counted."""
        last = self.found.confirmed_ladder[-1]
        size = last.rmse.get("verify")
        return "–" if size is None else quantity(size, last.rmse_unit)

    @property
    def _proposed(self) -> str:
        """What the search proposes beyond the catalogue, with its errors."""
        terms = self.found.proposals or ()
        if not terms:
            return "none" if self.found.looked_at else "–"
        last = terms[-1].error
        errors = f"{percent(last['fit'])} / {percent(last['verify'])}"
        against = ", contradicted" if any(one.contradicted for one in terms) else ""
        return f"{', '.join(f'`{one.equation}`' for one in terms)}: {errors}{against}"


def judged(folder: Path) -> Judged:
    """What `fit` and `diagnose` make of a matrix where nothing else is said."""
    begun = time.monotonic()
    choice = choose_structure(read_matrix(folder))
    settings = Settings(model=choice.structures[0].machine)
    fit = choice.made(settings) or identify(choice.matrix, settings)
    found = diagnose(choice.matrix, fit)
    return Judged(folder.name, fit, found, time.monotonic() - begun)
