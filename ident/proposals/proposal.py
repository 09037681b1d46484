"""What a search for missing terms came to, in the contract's words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Errors = Mapping[str, float | None]


@dataclass(frozen=True, kw_only=True)
class Proposal:
    """A term that helps beyond the bar: where it acts, its equation, the effect of its own that it is.

    `terms` counts the terms that were added up to this one, `shapes` the numbers within it that were fitted. `nats` are
    those of runs that neither the search nor the choice saw, `bar` what they had to exceed. `alike` are the forms that
    the data cannot tell from it. Of a `hypothesis` there were too few runs to confirm it on others.
    """

    place: tuple[str, ...]
    equation: str
    effect: Mapping[str, Any]
    strength: float = 0.0
    terms: int = 1
    shapes: int = 0
    error: Errors = field(default_factory=dict)
    nats: float = 0.0
    bar: float = 0.0
    alike: tuple[str, ...] = ()
    meaning: str = ""
    formula: str = ""
    hypothesis: bool = False


@dataclass(frozen=True, kw_only=True)
class Refused:
    """The best term that stayed below the bar."""

    equation: str
    nats: float
    bar: float


@dataclass(frozen=True, kw_only=True)
class Proposals:
    """What was found, one term on top of the other, the best that was refused, and how many were looked at."""

    found: tuple[Proposal, ...] = ()
    refused: Refused | None = None
    looked_at: int = 0
