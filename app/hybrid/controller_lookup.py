"""The controller of a hybrid simulation over HTTP: by a name, by the id of a stored one, or as its JSON."""

from __future__ import annotations

from typing import Any

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller import Controller, SampledController
from ident.hybrid.controller_lookup import NAMED, for_rate
from ident.units.quantity import shown
from ident.words.nearest import did_you_mean

MOST_STATES, _LONGEST = 200, 200  # of a controller that is sent; characters of its name


def is_named(given: str) -> bool:
    """Whether a controller goes by this name."""
    return given in NAMED


def controller_of(given: str | dict[str, Any], fit: FitResult, case: Case, wanted: Any = None) -> Controller:
    """As :func:`ident.hybrid.controller_lookup.controller_called`: the controller of that name, or of that JSON."""
    if isinstance(given, str):
        if given not in NAMED:
            raise Unusable(
                "unknown-controller",
                f"{shown(given)!r} is not a controller",
                "controller",
                did_you_mean(given, NAMED, f"give {', '.join(NAMED)}, or the id of one"),
            )
        return NAMED[given](fit, case, wanted)
    rows = given.get("A")
    if isinstance(rows, list) and len(rows) > MOST_STATES:
        raise Unusable("bad-controller", f"{len(rows)} states", "controller", f"give at most {MOST_STATES}")
    name = given.get("name") or ""
    if not isinstance(name, str) or len(name) > _LONGEST or not name.isprintable():
        raise Unusable("bad-controller", "its name is not a line of text", "controller name", "give a short text")
    return for_rate(SampledController.from_json(given), case)
