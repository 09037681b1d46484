"""A recheck as it is sent, and in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from app.regress.recheck import Change, Recheck
from ident.words.error import ErrorOf
from ident.words.number import trimmed
from schemas.regression import ChangeView, Outcome, RecheckView


def as_view(one: Recheck, job: str = "", ended: bool = True) -> RecheckView:
    """A recheck as it is sent; `job` is what made it, where one did."""
    outcome: Outcome = "open" if not ended else "failed" if one.failure else "moved" if one.moved else "same"
    return RecheckView(
        serial=one.serial,
        fit=one.fit,
        job=job,
        outcome=outcome,
        failure=one.failure if ended else "",
        seconds=one.seconds or None,
        moved=[_change(change, one.tolerance) for change in one.moved],
        largest=_change(one.largest, one.tolerance) if one.largest else None,
    )


def _change(one: Change, tolerance: float) -> ChangeView:
    return ChangeView(
        quantity=one.quantity,
        before=one.before,
        after=None if math.isnan(one.after) else one.after,
        std_error=one.std_error,
        relative=one.relative if math.isfinite(one.relative) else None,
        moved=one.moved(tolerance),
        kind=one.kind,
    )


def told(one: RecheckView) -> str:
    """What became of an actuator: why it failed, what moved, or the largest change."""
    if one.failure:
        return one.failure
    if one.moved:
        return "; ".join(
            f"{each.quantity} {_shown(each, each.before)} → {_shown(each, each.after)}" for each in one.moved
        )
    if one.largest is None or one.largest.relative is None:
        return ""
    return f"largest change {one.largest.relative:.1e} ({one.largest.quantity})"


def _shown(of: ChangeView, value: float | None) -> str:
    """A value as a plain number; an error from which on the model is unstable on a run is no number."""
    if of.kind == "error" and ErrorOf(value).is_unstable:
        return "unstable"
    return "none" if value is None else f"{value:.5g}"


def rows(rechecks: Sequence[RecheckView]) -> list[tuple[RecheckView, str, str]]:
    """Each recheck with its time and what is told of it, those first that are not the same."""
    order = {"moved": 0, "failed": 1, "open": 2, "same": 3}
    found = sorted(rechecks, key=lambda one: (order[one.outcome], one.serial))
    return [(one, "–" if one.seconds is None else f"{trimmed(round(one.seconds, 2))} s", told(one)) for one in found]
