"""A lab's machine, no model named: which structure is taken, what is found. `python -m tests.blind.any_trial 0 10`."""

from __future__ import annotations

import sys
from dataclasses import dataclass

from ident.fit.settings import Settings
from ident.workflows import diagnose, identify
from tests.blind.any_machine import Lab, sound

SAME = 0.5  # of the noise: so much may a model differ from the machine that is called right


@dataclass(frozen=True)
class Outcome:
    """What came of a trial. `differs` is the noise-free error of the model that was taken, with nothing hidden."""

    lab: Lab
    model: str
    differs: float
    linear: float
    error: float
    effects: tuple[str, ...]
    standing: str | None
    group: tuple[str, ...]

    @property
    def structure_right(self) -> bool:
        """Whether the model can be the machine."""
        return self.differs <= SAME * self.lab.noise

    @property
    def named(self) -> bool:
        """Whether the verdict has what is hidden, alone or in a group of three at most."""
        of_group = self.group if len(self.group) <= 3 else ()
        return self.lab.hidden in (*self.effects, *of_group)

    def __str__(self) -> str:
        lab = self.lab
        errors = " → ".join(f"{error / lab.noise:.2f}" for error in (self.linear, self.error))
        return (
            f"{lab.seed} {lab.structure} {lab.kind}, hidden {lab.hidden or 'nothing'}: {self.model} "
            f"{'right' if self.structure_right else 'wrong'}, {errors} × noise, {', '.join(self.effects) or 'nothing'} "
            f"{self.standing}"
        )


def trial(seed: int, hidden: bool, seconds: float | None = None) -> Outcome:
    """A lab by its seed, diagnosed in so many seconds at most."""
    lab = Lab.drawn(seed, hidden)
    matrix = lab.measured()
    fit = identify(matrix, Settings(model=""))
    clean = identify(sound(lab).measured(noisy=False), Settings(model=fit.model))
    found = diagnose(matrix, fit, seconds=seconds)
    group = next((group for group in found.verdict.indistinguishable if lab.hidden in group), ())
    return Outcome(
        lab, fit.model, clean.error["fit"] or 0.0, fit.error["fit"] or 0.0, found.ladder[-1].error["fit"] or 0.0,
        found.verdict.effects, found.verdict.standing, group,
    )  # fmt: skip


def rates(outcomes: list[Outcome]) -> str:
    """How often each thing was right, as counts."""
    hidden, sound_ones = [o for o in outcomes if o.lab.hidden], [o for o in outcomes if not o.lab.hidden]
    return (
        f"structure right {sum(o.structure_right for o in outcomes)} of {len(outcomes)}; "
        f"hidden effect named {sum(o.named for o in hidden)} of {len(hidden)}; "
        f"nothing found where nothing is hidden {sum(o.standing != 'found' for o in sound_ones)} of {len(sound_ones)}"
    )


if __name__ == "__main__":
    first, last = (int(number) for number in sys.argv[1:3])
    outcomes = []
    for seed in range(first, last):
        for hidden in (True, False):
            outcomes.append(trial(seed, hidden, 60.0))
            print(outcomes[-1], flush=True)
    print(rates(outcomes))
