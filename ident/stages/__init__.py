"""A place of the chain in, its core out: the equations that a preset picks there, with the parameters they bring."""

from ident.stages.controller import OPENED_BY_COMMAND, PI, PID, PROPORTIONAL, SPEED_INSIDE
from ident.stages.drive import (
    BASE_AS_RECORDED,
    CASCADE,
    DIRECT_FORCE,
    FORCE_AS_RECORDED,
    IDEAL_DRIVE,
)
from ident.stages.flow import FLOW_TO_SPEED, LINEAR_FLOW, SQUARE_ROOT_FLOW
from ident.stages.level import LOWER_LEVEL, UPPER_LEVEL
from ident.stages.load import (
    BLOCKED,
    DRIVEN_MASS,
    FOLLOWING,
    MASS_ON_BASE,
    MASS_SPRING_DAMPER,
    MEASURED_LOAD,
    PRESSED_SPECIMEN,
)
from ident.stages.long_stroke import DRIVEN_VALVE, OVERLAP, TABLE_ON_GUIDES, TIGHT_CYLINDER, TWO_SIDED_FLOW
from ident.stages.motor import TORQUE
from ident.stages.pressure import ACTING_PRESSURE, COMPRESSIBLE
from ident.stages.scale import Scale
from ident.stages.sensor import IDEAL_SENSOR, transducer
from ident.stages.specimen import MOVED_SPECIMEN
from ident.stages.spool import RIGID_SPOOL
from ident.stages.stage import PLACES, Quantity, Stage
from ident.stages.two_masses import TWO_MASSES, TWO_MASSES_AT_LOAD
from ident.stages.valve import FIRST_ORDER_VALVE, INSTANT_VALVE, SECOND_ORDER_VALVE

__all__ = [
    "ACTING_PRESSURE",
    "BASE_AS_RECORDED",
    "BLOCKED",
    "CASCADE",
    "COMPRESSIBLE",
    "DIRECT_FORCE",
    "DRIVEN_MASS",
    "DRIVEN_VALVE",
    "FIRST_ORDER_VALVE",
    "FLOW_TO_SPEED",
    "FOLLOWING",
    "FORCE_AS_RECORDED",
    "IDEAL_DRIVE",
    "IDEAL_SENSOR",
    "INSTANT_VALVE",
    "LINEAR_FLOW",
    "LOWER_LEVEL",
    "MASS_ON_BASE",
    "MASS_SPRING_DAMPER",
    "MEASURED_LOAD",
    "MOVED_SPECIMEN",
    "OPENED_BY_COMMAND",
    "OVERLAP",
    "PI",
    "PID",
    "PLACES",
    "PRESSED_SPECIMEN",
    "PROPORTIONAL",
    "RIGID_SPOOL",
    "SECOND_ORDER_VALVE",
    "SPEED_INSIDE",
    "SQUARE_ROOT_FLOW",
    "TABLE_ON_GUIDES",
    "TIGHT_CYLINDER",
    "TORQUE",
    "TWO_MASSES",
    "TWO_MASSES_AT_LOAD",
    "TWO_SIDED_FLOW",
    "UPPER_LEVEL",
    "Quantity",
    "Scale",
    "Stage",
    "transducer",
]
