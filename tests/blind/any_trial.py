"""A lab's machine, no model named: which structure is taken, what is found.

python -m tests.blind.any_trial 0 10   [--seconds N] [--out FILE]    seeds, of each one with and one without an effect
"""

from __future__ import annotations

import argparse
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path

from ident.fit.settings import Settings
from ident.workflows import diagnose, identify
from tests.blind.any_machine import Lab, sound
from tests.blind.campaign import add
from tests.blind.interval import rate
from tests.blind.sure import sure
from tests.blind.table import LABS
from tests.blind.worth import COUNTS, TRUE, nats

SAME = 0.5  # of the noise: so much may a simpler model differ from the machine and be called right


@dataclass(frozen=True)
class Outcome:
    """What came of a trial.

    `differs` is the noise-free error of the model that was taken, with nothing hidden, 0 for the true one; `nats` what
    the hidden effect is worth on runs withheld.
    """

    lab: Lab
    model: str
    differs: float
    linear: float
    error: float
    effects: tuple[str, ...]
    standing: str | None
    group: tuple[str, ...]
    nats: float
    sure: dict[str, object] = field(default_factory=dict)

    @property
    def counts(self) -> bool:
        """Whether something is hidden that the records show."""
        return self.nats >= COUNTS

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
            f"{self.standing}, worth {self.nats:.3g} nats"
        )

    def row(self) -> dict[str, object]:
        """What is kept of it, plain."""
        of_lab = {name: getattr(self.lab, name) for name in ("seed", "structure", "kind", "hidden", "noise")}
        own = {name: value for name, value in asdict(self).items() if name not in ("lab", "sure")}
        return of_lab | own | self.sure | {"right": self.structure_right, "named": self.named, "counts": self.counts}


def trial(seed: int, hidden: bool, seconds: float | None = None) -> Outcome:
    """A lab by its seed, diagnosed in so many seconds at most."""
    lab = Lab.drawn(seed, hidden)
    worth = nats(lab) if hidden else 0.0
    matrix = lab.measured()
    fit = identify(matrix, Settings(model=""))
    found = diagnose(matrix, fit, seconds=seconds, propose=False)
    last = found.ladder[-1].error if found.ladder else fit.error  # there was no time for a step
    group = next((group for group in found.verdict.indistinguishable if lab.hidden in group), ())
    return Outcome(
        lab,
        fit.model,
        _differs(lab, fit.model),
        fit.error["fit"] or 0.0,
        last["fit"] or 0.0,
        found.verdict.effects,
        found.verdict.standing,
        group,
        worth,
        sure(found),
    )


def _differs(lab: Lab, model: str) -> float:
    """The noise-free error of the best fit of a model that is not the machine's own."""
    if model == TRUE[lab.structure]:
        return 0.0
    return identify(sound(lab).measured(noisy=False), Settings(model=model)).error["fit"] or 0.0


def rates(outcomes: list[Outcome]) -> str:
    """How often each thing was right, as counts with 95 % intervals."""
    hidden, sound_ones = [o for o in outcomes if o.counts], [o for o in outcomes if not o.lab.hidden]
    return "; ".join(
        (
            f"structure right {rate([o.structure_right for o in outcomes])}",
            f"hidden effect named {rate([o.named for o in hidden])}",
            f"nothing found where nothing is hidden {rate([o.standing != 'found' for o in sound_ones])}",
        )
    )


def main() -> None:
    """Trials one after the other, each kept as soon as it is known."""
    parser = argparse.ArgumentParser()
    parser.add_argument("first", type=int)
    parser.add_argument("end", type=int)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--out", type=Path, default=LABS)
    asked, begun, outcomes = parser.parse_args(), time.monotonic(), []
    for seed in range(asked.first, asked.end):
        for hidden in (True, False):
            if time.monotonic() - begun > 60 * asked.minutes:
                break
            outcomes.append(trial(seed, hidden, asked.seconds))
            add(outcomes[-1].row(), asked.out)
            print(outcomes[-1], flush=True)
    print(rates(outcomes))


if __name__ == "__main__":
    main()
