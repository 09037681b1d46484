"""How long a token is valid: `90d`."""

from __future__ import annotations

import re
from datetime import timedelta

from ident.errors import Unusable

_LONGEST = timedelta(days=36_525)


def duration(text: str) -> timedelta:
    """`12h`, `90d` or `2w`. Raises Unusable."""
    found = re.fullmatch(r"([1-9][0-9]{0,6})\s*([hdw])", text.strip(), re.ASCII)
    unit = {"h": "hours", "d": "days", "w": "weeks"}
    lasts = timedelta(**{unit[found[2]]: int(found[1])}) if found else _LONGEST
    if found is None or lasts > _LONGEST:
        raise Unusable("bad-duration", f"cannot read {text!r}", "expires", "write hours, days or weeks: 12h, 90d, 2w")
    return lasts
