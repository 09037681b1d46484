"""How large the residual is in the unit of the output: beside eq. (17), which is a ratio."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from app.context import Context
from app.fits.studied import study
from ident.comparison.compare import RunComparison
from ident.residuals.whiteness import by_use
from ident.words.engineering import quantity
from schemas.fit import ErrorSize, ErrorSizesView, WhitenessView


def sizes(context: Context, fit_id: str) -> ErrorSizesView:
    """RMSE and MAE of each run, and their means over the runs of each use that have one unit. Raises Failure 404."""
    found = study(context, fit_id)
    comparison = found.compared(found.matrix.runs)
    compared = comparison.runs
    uses = {use: [one for one in compared if one.run.use == use] for use in ("fit", "verify")}
    means = {use: _mean(runs) for use, runs in uses.items() if len({one.unit for one in runs}) == 1}
    each = {one.run.id: _mean([one]) for one in compared}
    return ErrorSizesView(
        uses={use: size for use, size in means.items() if size},
        runs={run: size for run, size in each.items() if size},
        whiteness={use: WhitenessView(**asdict(white)) for use, white in by_use(comparison).items()},
    )


def _mean(runs: Sequence[RunComparison]) -> ErrorSize | None:
    """Averaged over runs; None where the model is unstable on one, so that there is no such number."""
    sizes = [(one.rmse, one.mae) for one in runs if one.rmse is not None and one.mae is not None]
    if len(sizes) < len(runs):
        return None
    (rmse, mae), unit = (float(mean) for mean in np.mean(sizes, axis=0)), runs[0].unit
    return ErrorSize(
        rmse=rmse, mae=mae, unit=unit, rmse_in_print=quantity(rmse, unit), mae_in_print=quantity(mae, unit)
    )
