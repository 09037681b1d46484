"""The linear core of each place of the chain; a preset picks one core a place."""

from ident.stages.controller import PROPORTIONAL
from ident.stages.flow import LINEAR_FLOW
from ident.stages.load import MASS_SPRING_DAMPER
from ident.stages.pressure import COMPRESSIBLE
from ident.stages.sensor import IDEAL_SENSOR
from ident.stages.spool import RIGID_SPOOL
from ident.stages.stage import PLACES, Quantity, Stage
from ident.stages.valve import FIRST_ORDER_VALVE

__all__ = [
    "COMPRESSIBLE",
    "FIRST_ORDER_VALVE",
    "IDEAL_SENSOR",
    "LINEAR_FLOW",
    "MASS_SPRING_DAMPER",
    "PLACES",
    "PROPORTIONAL",
    "RIGID_SPOOL",
    "Quantity",
    "Stage",
]
