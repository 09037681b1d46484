"""The judgement of a loop: stable or not, its mode, the cause where it is known, and the remedies."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ident.parallel import one_thread
from ident.plain import written
from ident.stability.cause import Cause, causes
from ident.stability.gain_margin import WANTED, gain_margin
from ident.stability.loop import Loop
from ident.stability.mode import Mode, growth, leading_mode
from ident.stability.remedy import Remedy, remedies
from ident.words.number import trimmed

STABLE, UNSTABLE = "stable", "unstable"
_NAMED = 3  # remedies that a sentence lists
_REMEDY = "For a gain margin of"


@dataclass(frozen=True)
class Judgement:
    """`state` is "stable" or "unstable"; `mode` the one that grows fastest, or dies out last.

    `gain_margin` in dB is below 0 where the loop is unstable, None where no gain loses stability. `causes` are known
    only where the loop was given as it was before. `remedies` leave a gain margin of 3 dB, the smallest change first:
    none where the loop has it.
    """

    state: str
    mode: Mode
    gain_margin: float | None
    causes: tuple[Cause, ...] = ()
    remedies: tuple[Remedy, ...] = ()
    text: tuple[str, ...] = ()

    @property
    def stable(self) -> bool:
        """Whether no mode grows."""
        return self.state == STABLE

    @property
    def what(self) -> str:
        """What is unstable and why, as a phrase of an error: the mode, and the cause where it is known."""
        return "; ".join(_phrase(one) for one in self.text if not one.startswith(_REMEDY))

    @property
    def remedy(self) -> str:
        """What would make it stable, as a phrase of an error; "" where nothing alone does."""
        return next((_phrase(one) for one in self.text if one.startswith(_REMEDY)), "")

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        data: dict[str, Any] = written(self)
        return data


def judge(loop: Loop, before: Mapping[str, float] | None = None, where: str = "") -> Judgement:
    """Whether a loop is stable, and what makes it unstable. `before` are values of its parts when it was stable.

    `where` names it in the sentences, as in "at Kp = 12".
    """
    with one_thread():  # thousands of small matrices, which several threads make slower
        return _judged(loop, before, where)


def _judged(loop: Loop, before: Mapping[str, float] | None, where: str) -> Judgement:
    poles = loop.poles({}, {})[0]
    unstable, margin = bool(growth(poles) > 0), gain_margin(loop)
    if not unstable and (margin is None or margin >= WANTED):
        return Judgement(STABLE, leading_mode(poles), margin)
    mode, offered = leading_mode(poles), remedies(loop)
    found = causes(loop, before) if unstable and before else ()
    text = tuple(_sentences(unstable, mode, margin, found, offered, where))
    return Judgement(UNSTABLE if unstable else STABLE, mode, margin, found, offered, text)


def _sentences(
    unstable: bool, mode: Mode, margin: float | None, found: tuple[Cause, ...], offered: tuple[Remedy, ...], where: str
) -> Iterator[str]:
    at = f" {where}" if where else ""
    if unstable:
        yield f"Unstable{at}: {mode}."
    elif margin is not None:
        yield f"Little gain margin{at}: {trimmed(margin)} dB."
    if len(found) == 1:
        yield f"The cause is the {found[0].kind}: {found[0]}."
    elif found:
        yield f"The cause is one of these, which act alike: {'; '.join(f'{one.kind}: {one}' for one in found)}."
    if offered:
        listed = " or ".join(str(one) for one in offered[:_NAMED])
        yield f"{_REMEDY} {trimmed(WANTED)} dB, the smallest change first: {listed}."
    elif margin is not None:
        yield f"No single change gives a gain margin of {trimmed(WANTED)} dB."


def _phrase(sentence: str) -> str:
    """A sentence as a phrase of an error: without a capital and a full stop."""
    return f"{sentence[:1].lower()}{sentence[1:].removesuffix('.')}"
