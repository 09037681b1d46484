"""What a change would do to an identified machine: answered at once, and kept nowhere."""

from __future__ import annotations

from dataclasses import replace

from app.context import Context
from app.fits import service as fits
from app.hybrid.at_condition import moved_to
from app.hybrid.request_parsing import change_of, gains_of, peak_of
from app.hybrid.spread import spread_of
from app.lru import LRU
from ident.fit.result import FitResult
from ident.hybrid import what_if as library
from ident.hybrid.chosen_gain import GainTarget
from ident.hybrid.what_if import Before, WhatIf
from schemas.hybrid import BeforeRequest, ChooseRequest, WhatIfRequest

_MOST = 16  # answers in memory, about 1 MB each: one with a peak takes seconds
_answers: LRU[WhatIf] = LRU(_MOST)


def what_if(context: Context, fit: str, request: WhatIfRequest) -> WhatIf:
    """The machine of a fit after a change. Raises Unusable, and Failure 404."""

    def made() -> WhatIf:
        moved = moved_to(context, _fit(context, fit), request.at)
        found = moved.fit
        change, target, before = change_of(found, request), peak_of(request), _before(context, request.before)
        spread = spread_of(context, request.spread, found.model)
        told = library.what_if(
            found,
            change,
            gains_of(request),
            target,
            request.seed,
            before=before,
            choose=_wanted(request.choose),
            spread=spread,
        )
        return replace(told, notes=(*moved.text, *told.notes))

    return _answers.get((str(context.storage.folder), fit, request.model_dump_json()), made)


def _fit(context: Context, fit: str) -> FitResult:
    return FitResult.from_json(fits.find(context, fit).result)


def _before(context: Context, asked: BeforeRequest | None) -> Before | None:
    """The loop when it was stable, where something is said of it. Raises Failure 404."""
    if asked is None:
        return None
    return Before(None if asked.fit is None else _fit(context, asked.fit), asked.gain)


def _wanted(asked: ChooseRequest | None) -> GainTarget | None:
    """What a gain is to be chosen for. Raises Unusable."""
    return None if asked is None else GainTarget(asked.quantity, asked.value)
