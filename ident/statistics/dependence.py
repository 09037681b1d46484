"""A parameter of several sets over a condition of their tests, and what its law says at one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.rig.conditions import CONDITIONS, PREFIX, TEMPERATURE, Condition
from ident.statistics.condition_law import FEWEST_FOR_LAW, ConditionLaw, Level, condition_laws
from ident.words.message import Message, message


@dataclass(frozen=True)
class Dependence:
    """The laws of `values` over a condition by its name, at `conditions`, SI; the most probable law first."""

    over: str
    conditions: tuple[float, ...]
    values: tuple[float, ...]
    laws: tuple[ConditionLaw, ...]

    @classmethod
    def of(cls, over: str, conditions: Sequence[float], values: Sequence[float]) -> Dependence:
        """Of the values of a parameter in several sets, at the conditions of their tests."""
        laws = condition_laws(conditions, values, temperature=over == TEMPERATURE)
        return cls(over, tuple(conditions), tuple(values), laws)

    @classmethod
    def of_sets(cls, over: str, sets: Sequence[Mapping[str, float]], name: str) -> Dependence:
        """The same of sets as mappings, in which the condition stands behind its prefix; of those that have both."""
        both = [(one[PREFIX + over], one[name]) for one in sets if PREFIX + over in one and name in one]
        return cls.of(over, [x for x, _ in both], [y for _, y in both])

    @property
    def condition(self) -> Condition:
        """What it is over."""
        return CONDITIONS[self.over]

    @property
    def law(self) -> ConditionLaw | None:
        """The law of most evidence; None of too few sets, or of sets at one condition."""
        return self.laws[0] if self.laws and np.ptp(self.conditions) > 0 else None

    @property
    def text(self) -> Message:
        """Which law it is and whether it holds, in words."""
        if (law := self.law) is None:
            key = "law.few" if len(self.values) < FEWEST_FOR_LAW else "law.one_condition"
            return message(key, sets=len(self.values), condition=self.condition.title, least=FEWEST_FOR_LAW)
        known = {"condition": self.condition.title, "name": law.name, "p": law.lack_of_fit}
        if not law.holds:
            return message("law.fails", **known)
        scatter = f"{100 * law.scatter:.3g} %" if law.relative else f"{law.scatter:.3g}"
        return message("law.holds", share=law.probability, scatter=scatter, **known)

    def silent(self, value: float) -> Message | None:
        """Why nothing is said at a condition; None where the law says something."""
        law = self.law
        if law is None or not law.holds:
            return self.text
        if not law.covers(value):
            ends = {name: self.condition.said(of(self.conditions)) for name, of in (("low", min), ("high", max))}
            return message("law.beyond", value=self.condition.said(value), **ends)
        return None

    def at(self, value: float) -> Level | None:
        """The parameter at a condition; None where nothing is said."""
        return None if self.law is None or self.silent(value) is not None else self.law.at(value)
