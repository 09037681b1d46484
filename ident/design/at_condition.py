"""The machine of a fit at another condition: each parameter moves by its law over the sets of machines like it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ident.errors import Unusable
from ident.fit.result import Estimate, FitResult
from ident.rig.conditions import CONDITIONS, PREFIX, Condition
from ident.statistics import Change
from ident.statistics.dependence import Dependence
from ident.units.quantity import quantity
from ident.words.engineering import printed_unit
from ident.words.message import message
from ident.words.nearest import did_you_mean

Set = Mapping[str, float]


@dataclass(frozen=True)
class Moved:
    """A fit at another condition, and what was moved by which law, in words."""

    fit: FitResult
    text: tuple[str, ...]


@dataclass(frozen=True)
class AtCondition:
    """The `value` of a condition at which a machine is wanted, SI, and the sets whose laws move it there."""

    over: str
    value: float
    sets: tuple[Set, ...]
    of: str

    @classmethod
    def stated(cls, over: str, value: str, sets: Sequence[Set], of: str) -> AtCondition:
        """From a value with its unit. Raises Unusable where there is no such condition, or its unit is another."""
        return cls(over, condition_value(over, value), tuple(sets), of)

    @property
    def condition(self) -> Condition:
        """What it is."""
        return CONDITIONS[self.over]

    def move(self, fit: FitResult) -> Moved:
        """The fit with its parameters at the condition.

        Where y(x) is the law of a parameter, its value becomes y(there)/y(here) of what it was, or moves by the
        difference where the sets scatter by an amount. A parameter of which no law holds stays as it is. Raises
        Unusable where the fit does not know its own condition, or the sets reach neither it nor the one that is wanted.
        """
        here = fit.conditions.get(self.over)
        if here is None:
            raise Unusable(
                "no-condition",
                f"the fit does not know its {self.condition.title}",
                "at",
                "state it in the block test of matrix.yaml, and fit again",
            )
        found = {name: Dependence.of_sets(self.over, self.sets, name) for name in fit.parameters}
        self._check(found, here)
        moved, said, kept = {}, [], []
        for name, estimate in fit.parameters.items():
            law = found[name].law
            if law is None or not law.holds:
                kept.append(name)
            elif law.name != "constant":
                moved[name] = _moved(estimate, law.change(here, self.value))
                said.append(
                    str(
                        message(
                            "moved.by",
                            name=name,
                            law=law.name,
                            before=estimate.value,
                            after=moved[name].value,
                            unit=printed_unit(estimate.unit),
                        )
                    )
                )
        text = [
            message(
                "moved.from",
                there=self.condition.said(self.value),
                here=self.condition.said(here),
                of=self.of,
                sets=self._known,
                what="; ".join(said) or "nothing moves",
            )
        ]
        text += [message("moved.kept", names=kept)] if kept else []
        conditions = {**fit.conditions, self.over: self.value}
        return Moved(replace(fit, parameters={**fit.parameters, **moved}, conditions=conditions), tuple(map(str, text)))

    @property
    def _known(self) -> int:
        """The number of sets that know the condition."""
        return sum(PREFIX + self.over in one for one in self.sets)

    def _check(self, found: Mapping[str, Dependence], here: float) -> None:
        """Raise Unusable where the sets have no law at all, or do not reach both conditions."""
        with_law = [one for one in found.values() if one.law is not None]
        if not with_law:
            told = next(iter(found.values())).text if found else message("law.none")
            raise Unusable("no-law", str(told).rstrip("."), "at", "approve fits at several conditions")
        for value in (here, self.value):
            if (why := next((one.silent(value) for one in with_law if one.law and one.law.holds), None)) is not None:
                raise Unusable("beyond-sets", str(why).rstrip("."), "at", "add sets there, or stay between them")


def condition_called(over: str) -> Condition:
    """The condition of that name. Raises Unusable where there is none."""
    if over not in CONDITIONS:
        remedy = did_you_mean(over, CONDITIONS, f"give one of {', '.join(CONDITIONS)}")
        raise Unusable("unknown-condition", f"no condition {over[:40]!r}", "over", remedy)
    return CONDITIONS[over]


def condition_value(over: str, value: str, where: str = "at") -> float:
    """A condition with its unit, SI. Raises Unusable for a name that there is not, and for another unit."""
    return quantity(value, condition_called(over).unit, where)


def _moved(estimate: Estimate, change: Change) -> Estimate:
    """An estimate after a change; the errors of value and law are independent, for the law is of other sets."""
    value = change.factor * estimate.value + change.shift
    own = change.factor * (estimate.std_error or 0.0)
    size = abs(value) if change.shift == 0 else 1.0
    return replace(estimate, value=value, std_error=math.hypot(own, size * change.std_error))
