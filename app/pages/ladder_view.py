"""The way that led to a fit, as the rows of a table."""

from __future__ import annotations

from dataclasses import dataclass

from app.pages.effect_view import strength
from ident.words.error import ErrorOf
from ident.words.error_change import error_change
from ident.words.titles import title
from schemas.fit import LadderRung, LadderView


@dataclass(frozen=True)
class Step:
    """A fit on the way: what it added, its strength, its errors, and by how much they fell."""

    fit: str
    before: str
    here: bool
    added: tuple[tuple[str, str], ...]
    said_fit: ErrorOf
    said_verify: ErrorOf
    change: str
    seed: int
    version: str
    data: str
    made: str
    state: str
    state_text: str


def steps(ladder: LadderView) -> tuple[Step, ...]:
    """A row a fit, the first one first."""
    before: list[LadderRung | None] = [None, *ladder.rungs[:-1]]
    return tuple(_step(rung, earlier, ladder.fit) for rung, earlier in zip(ladder.rungs, before, strict=True))


def _step(rung: LadderRung, before: LadderRung | None, here: str) -> Step:
    state = ("approved", "current set") if rung.current else ("succeeded", "fitted")
    if rung.approved_at and not rung.current:
        state = ("succeeded", "approved earlier")
    return Step(
        fit=rung.fit,
        before=before.fit if before else "",
        here=rung.fit == here,
        added=tuple((title(name), strength(name, rung.parameters)) for name in rung.added),
        said_fit=_said(rung, "fit"),
        said_verify=_said(rung, "verify"),
        change=_change(rung, before),
        seed=rung.seed,
        version=rung.version,
        data=rung.data_hash[:12],
        made=rung.created_at,
        state=state[0],
        state_text=state[1],
    )


def _said(rung: LadderRung, use: str) -> ErrorOf:
    """The error of a step on the runs of a use."""
    return ErrorOf(rung.error[use], rung.error_with_mean.get(use), rung.unstable.get(use, ()))


def _change(rung: LadderRung, before: LadderRung | None) -> str:
    """By how much the error fell on runs that no fit saw, else on those that were fitted."""
    for use in ("verify", "fit"):
        if before is not None and (use in rung.unstable or use in before.unstable):
            return "–"
        now, then = rung.error[use], before.error[use] if before else None
        if now is not None and then:
            return error_change(then, now)
    return "–"
