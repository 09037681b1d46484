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
from ident.words.percent import percent
from ident.workflows import diagnose, identify

KNOWN = {
    "mr_damper": "best linear 45 / 50 %; Dahl and viscous friction 17.2 / 18.5 %",
    "dc_motor": "linear 26.4 / 28.8 %; dead zone of 1.91 V 6.88 / 12.7 %, dry friction instead 6.47 / 16.0 %",
    "excavator_boom": "over 1 s linear 8.0 / 6.2 %, dead zone 5.5 / 4.7 %, with delay and skew 4.15 / 3.34 %",
    "emps": "dry friction of 20.4 N beside 203 N·s/m",
    "crane_actuator": "free run on the second half 47 to 58 %, a linear ARX model 95 %",
    "mts_actuator": "second-order linear model of its authors 5.2 % on both runs",
}
"""By the folder's name, what experts found: errors on the fitted and on the held-back record."""


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
        first, last = (rung.error for rung in (self.found.ladder[0], self.found.ladder[-1]))
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
        )

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
