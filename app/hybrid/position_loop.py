"""The margins of a position loop around the servo-actuator of a fit: answered at once, and kept nowhere."""

from __future__ import annotations

from app.context import Context
from app.fits import service as fits
from ident.bench import position_loop as library
from ident.bench.position_loop import PositionLoop
from ident.fit.result import FitResult
from ident.rig.regulator import REGULATOR_UNITS, Regulator
from ident.units.quantity import parameter_value
from schemas.hybrid import PositionLoopRequest


def position_loop(context: Context, fit: str, request: PositionLoopRequest) -> PositionLoop:
    """The margins at each amplitude. Raises Unusable, and Failure 404."""
    given = request.model_dump(include=set(REGULATOR_UNITS), exclude_none=True)
    values = {name: parameter_value(value, REGULATOR_UNITS[name], f"regulator {name}") for name, value in given.items()}
    sizes = [parameter_value(one, "1", "amplitude") for one in request.amplitudes]
    found = FitResult.from_json(fits.find(context, fit).result)
    return library.position_loop(found, Regulator(**values), sizes)
