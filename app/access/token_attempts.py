"""Wrong tokens of an address: so many a minute are looked at."""

from __future__ import annotations

from math import ceil

from app.access.caller import Caller
from app.access.identity import PresentedToken, identify
from app.access.rates import Rate
from app.access.roles import unknown
from app.context import Context
from app.errors import Failure
from app.lru import LRU

_KNOWN = 10_000


class TokenAttempts:
    """Counts what fails. What was right before is looked at also where others at its address are wrong too often."""

    def __init__(self, a_minute: float) -> None:
        self._failures = Rate(a_minute / 60, a_minute)
        self._known: LRU[bool] = LRU(_KNOWN)

    def identify(self, context: Context, shown: PresentedToken, address: str) -> Caller:
        """Whose token it is. Raises Failure 401, and 429 where too many of the address were wrong."""
        wait = 0.0 if shown.print in self._known else self._failures.wait(address)
        if wait:
            raise too_often("wrong tokens came from this address", wait)
        who = identify(context, shown)
        if who is None:
            self._failures.count(address)
            raise unknown()
        self._known.put(shown.print, True)
        return who


def too_often(what: str, wait: float) -> Failure:
    """Of what was asked more often than is allowed; `wait` (s) says when it may be asked again."""
    return Failure(
        429,
        "too-often",
        f"too many {what}",
        "Authorization",
        f"try again in {ceil(wait)} s",
        **{"Retry-After": str(ceil(wait))},
    )
