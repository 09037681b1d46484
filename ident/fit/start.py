"""Where a fit begins that goes on from an earlier result, instead of from a search."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

Origin = Literal["fit", "diagnosis"]


@dataclass(frozen=True)
class Start:
    """The end of a fit, or of a refit that a diagnosis made: where another fit of the same model begins.

    `values` are SI, by the names of the parameters. `horizon` and `memory` (s) are those of the windows that it was
    made over (None: whole runs, see :mod:`ident.fit.windows`), `left_out` the ids of runs that it was not fitted to,
    `error` its eq. (17) over the fitted runs, `data_hash` that of its matrix. With `search` the whole space is
    searched too, and the better of both ends is the fit.
    """

    of: Origin
    values: Mapping[str, float]
    horizon: float | None = None
    memory: float | None = None
    left_out: tuple[str, ...] = ()
    error: float | None = None
    data_hash: str = ""
    search: bool = field(default=False, kw_only=True)
