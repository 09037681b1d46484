"""How far a machine may be from its fitted parameters when a test is run: half-widths, and the corners that they span.

A fit says how well the data determine the parameters on the day; a machine at another temperature, with other oil or
another specimen of the series, is off by more. So each parameter may be off by what is stated, else by 20 %, and by
three of its standard errors where that is more.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ident.custom.definition import preset_with
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.presets import Preset

Array = NDArray[np.float64]
USUAL = 0.2
"""Of each parameter, to either side, where nothing is stated."""
_ERRORS = 3.0  # standard errors, where these are more
_MOST = 0.9  # of a value: a parameter that has a sign keeps it
_WHOLE = 7  # parameters of which every corner is taken: 128 machines
_DRAWN = 128  # corners of more parameters


@dataclass(frozen=True)
class Spread:
    """`usual` is the share of each parameter that it may be off to either side, `stated` that of some by name."""

    usual: float = USUAL
    stated: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, share in (("every parameter", self.usual), *self.stated.items()):
            if not 0 <= share < 1:
                raise Unusable("bad-value", f"{name} spreads by {share:g}", "spread", "give a share from 0 to below 1")

    def __str__(self) -> str:
        own = "".join(f", {name} ± {100 * share:.3g} %" for name, share in self.stated.items())
        return f"± {100 * self.usual:.3g} % of each parameter{own}"

    def half_widths(self, fit: FitResult, preset: Preset) -> dict[str, float]:
        """How far each parameter of a fit may be off, by its name in the equations, SI. Raises Unusable."""
        stated = {preset.parameter(name).in_equations: share for name, share in self.stated.items()}
        found = {}
        for name, estimate in fit.parameters.items():
            symbol, size = preset.parameter(name).in_equations, abs(estimate.value)
            usual = max(self.usual * size, _ERRORS * (estimate.std_error or 0.0))
            found[symbol] = min(stated[symbol] * size if symbol in stated else usual, _MOST * size)
        return found

    def drawn(self, fit: FitResult, count: int, rng: np.random.Generator) -> dict[str, Array]:
        """`count` values of each parameter, evenly distributed over its width. Raises Unusable."""
        preset = preset_with(fit.model, fit.effects, tuple(fit.settings.get("custom", ())))
        widths = self.half_widths(fit, preset)
        found = {}
        for name, estimate in fit.parameters.items():
            width = widths[preset.parameter(name).in_equations]
            found[name] = estimate.value + width * rng.uniform(-1.0, 1.0, count)
        return found


def corners(half_widths: Mapping[str, float], seed: int = 0) -> dict[str, Array]:
    """Deviations (c,) of each parameter: none of any, then every corner of the box; of more than seven, 128 of them."""
    names = [name for name, width in half_widths.items() if width > 0]
    if not names:
        return {}
    if len(names) <= _WHOLE:
        signs = np.array(list(product((-1.0, 1.0), repeat=len(names))))
    else:
        signs = np.random.default_rng(seed).choice([-1.0, 1.0], (_DRAWN, len(names)))
    return {name: np.concatenate([[0.0], half_widths[name] * signs[:, i]]) for i, name in enumerate(names)}
