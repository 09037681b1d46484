"""A place of the chain in, its core out: the equations that a preset picks there, with the parameters they bring."""

from ident.stages.controller import OPENED_BY_COMMAND, PROPORTIONAL
from ident.stages.drive import CASCADE, DIRECT_FORCE, IDEAL_DRIVE
from ident.stages.flow import LINEAR_FLOW, SQUARE_ROOT_FLOW
from ident.stages.load import DRIVEN_MASS, MASS_SPRING_DAMPER, MEASURED_LOAD
from ident.stages.pressure import COMPRESSIBLE
from ident.stages.scale import Scale
from ident.stages.sensor import IDEAL_SENSOR
from ident.stages.spool import RIGID_SPOOL
from ident.stages.stage import PLACES, Quantity, Stage
from ident.stages.valve import FIRST_ORDER_VALVE

__all__ = [
    "CASCADE",
    "COMPRESSIBLE",
    "DIRECT_FORCE",
    "DRIVEN_MASS",
    "FIRST_ORDER_VALVE",
    "IDEAL_DRIVE",
    "IDEAL_SENSOR",
    "LINEAR_FLOW",
    "MASS_SPRING_DAMPER",
    "MEASURED_LOAD",
    "OPENED_BY_COMMAND",
    "PLACES",
    "PROPORTIONAL",
    "RIGID_SPOOL",
    "SQUARE_ROOT_FLOW",
    "Quantity",
    "Scale",
    "Stage",
]
