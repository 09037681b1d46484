"""Searches by well-kept libraries, as cross-checks of the program's own: differential evolution and CMA-ES."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA

Array = NDArray[np.float64]
Errors = Callable[[Array], Array]
_OF = FIT_CRITERIA.cross_check_searches
GENERATIONS = dict.fromkeys(("differential-evolution", "cma-es"), _OF.generations)
_SILENT = -9
"""Of pycma: it prints nothing. No answer depends on it."""


def differential_evolution(axes: int, seed: int, errors: Errors) -> list[tuple[Array, Array]]:
    """(population, errors) of each generation of SciPy's differential evolution."""
    history: list[tuple[Array, Array]] = []

    def vectorised(columns: Array) -> Array:
        points = np.atleast_2d(columns.T)
        cost = errors(points)
        history.append((points.copy(), cost))
        return cost

    scipy.optimize.differential_evolution(
        vectorised,
        [(0.0, 1.0)] * axes,
        maxiter=_OF.generations,
        popsize=max(1, _OF.differential_evolution // axes),
        tol=_OF.tolerance,
        rng=np.random.default_rng(seed),
        polish=False,
        vectorized=True,
        updating="deferred",
    )
    return history


def cma_es(axes: int, seed: int, errors: Errors) -> list[tuple[Array, Array]]:
    """(population, errors) of each generation of CMA-ES (pycma), started in the middle of the cube."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import cma  # noqa: PLC0415  slow to import, and seldom wanted

    # One axis is beyond pycma, so a second one without effect is put beside it.
    width = max(axes, 2)
    options = {
        "bounds": [0, 1],
        "popsize": _OF.cma_es,
        "seed": seed + 1,
        "verbose": _SILENT,
        "maxiter": _OF.generations,
        "tolfun": _OF.change,
    }
    strategy = cma.CMAEvolutionStrategy(width * [0.5], _OF.deviation, options)
    history: list[tuple[Array, Array]] = []
    while not strategy.stop():
        asked = strategy.ask()
        points = np.array(asked)[:, :axes]
        cost = errors(points)
        strategy.tell(asked, cost.tolist())
        history.append((points, cost))
    return history
