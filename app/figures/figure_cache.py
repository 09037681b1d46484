"""A figure of what is stored as bytes, from memory where it was drawn lately."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from app.context import Context
from app.errors import Failure
from app.lru import LRU
from ident.errors import Unusable
from ident.figures import MEDIA, figure, render
from ident.figures.options import number
from ident.words.display import display_units
from ident.words.nearest import did_you_mean

_MOST = 96  # figures in memory, about 100 kB each: what they are of never changes
_figures: LRU[bytes] = LRU(_MOST)


def drawn(
    context: Context,
    of: str,
    name: str,
    kind: str,
    options: dict[str, Any],
    subject: Callable[[dict[str, Any]], object],
) -> tuple[bytes, str]:
    """The figure `name` of a `subject` and its media type; the subject takes the options that choose it.

    `of` names the subject in the memory of the process. Raises Unusable, and Failure 404.
    """
    if kind not in MEDIA:
        raise Failure(404, "no-such-format", f"no figures as {kind!r}", "figure", did_you_mean(kind, MEDIA))
    key = json.dumps([str(context.storage.folder), of, name, kind, options, display_units()], sort_keys=True)
    return _figures.get(key, lambda: _drawn(name, kind, dict(options), subject)), MEDIA[kind]


def _drawn(name: str, kind: str, options: dict[str, Any], subject: Callable[[dict[str, Any]], object]) -> bytes:
    theme, share = options.pop("theme", "light"), number(options, "share") or 1.0
    live = bool(options.pop("live", ""))
    options.pop("share", None)
    if not 0.2 <= share <= 4:
        raise Unusable("out-of-range", f"share is {share:g}", "figure option share", "give 0.2 to 4")
    shown = subject(options)
    return render(figure(name, shown, theme, share, **options), kind, live=live)
