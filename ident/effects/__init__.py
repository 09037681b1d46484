"""A name in, an effect out: the catalogue, in the order in which effects act within their place."""

from ident.effects.acquisition_lag import ACQUISITION_LAG
from ident.effects.backlash import BACKLASH
from ident.effects.command_delay import COMMAND_DELAY
from ident.effects.command_limit import COMMAND_LIMIT
from ident.effects.coulomb_friction import COULOMB_FRICTION
from ident.effects.cubic_stiffness import CUBIC_STIFFNESS
from ident.effects.dead_zone import DEAD_ZONE
from ident.effects.effect import Effect
from ident.effects.entrained_air import ENTRAINED_AIR
from ident.effects.flow_saturation import FLOW_SATURATION
from ident.effects.frame_compliance import FRAME_COMPLIANCE
from ident.effects.gain_asymmetry import GAIN_ASYMMETRY
from ident.effects.integral_action import INTEGRAL_ACTION
from ident.effects.lead import LEAD
from ident.effects.loop_delay import LOOP_DELAY
from ident.effects.null_bias import NULL_BIAS
from ident.effects.orifice_leakage import ORIFICE_LEAKAGE
from ident.effects.presliding_friction import PRESLIDING_FRICTION
from ident.effects.pressure_feedback import PRESSURE_FEEDBACK
from ident.effects.pressure_flow import PRESSURE_FLOW
from ident.effects.quadratic_damping import QUADRATIC_DAMPING
from ident.effects.second_lag import SECOND_LAG
from ident.effects.sensor_gain import SENSOR_GAIN
from ident.effects.sensor_lag import SENSOR_LAG
from ident.effects.specimen_free_play import SPECIMEN_FREE_PLAY
from ident.effects.specimen_hysteresis import SPECIMEN_HYSTERESIS
from ident.effects.specimen_joint import SPECIMEN_JOINT
from ident.effects.spool_stiction import SPOOL_STICTION
from ident.effects.spring_load import SPRING_LOAD
from ident.effects.static_load import STATIC_LOAD
from ident.effects.stiction import STICTION
from ident.effects.stribeck_friction import STRIBECK_FRICTION
from ident.effects.stroke_dependent_volume import STROKE_DEPENDENT_VOLUME
from ident.effects.supply_droop import SUPPLY_DROOP
from ident.effects.underlap import UNDERLAP
from ident.effects.valve_rate_limit import VALVE_RATE_LIMIT
from ident.effects.valve_second_order import VALVE_SECOND_ORDER
from ident.errors import Unusable

EFFECTS: tuple[Effect, ...] = (
    COMMAND_DELAY,
    COMMAND_LIMIT,
    INTEGRAL_ACTION,
    LEAD,
    PRESSURE_FEEDBACK,
    LOOP_DELAY,
    VALVE_SECOND_ORDER,
    VALVE_RATE_LIMIT,
    SPOOL_STICTION,
    BACKLASH,
    NULL_BIAS,
    DEAD_ZONE,
    UNDERLAP,
    GAIN_ASYMMETRY,
    FLOW_SATURATION,
    PRESSURE_FLOW,
    SUPPLY_DROOP,
    ORIFICE_LEAKAGE,
    ENTRAINED_AIR,
    STROKE_DEPENDENT_VOLUME,
    COULOMB_FRICTION,
    STRIBECK_FRICTION,
    PRESLIDING_FRICTION,
    QUADRATIC_DAMPING,
    CUBIC_STIFFNESS,
    SPECIMEN_HYSTERESIS,
    SPECIMEN_FREE_PLAY,
    SPECIMEN_JOINT,
    FRAME_COMPLIANCE,
    STATIC_LOAD,
    SENSOR_LAG,
    ACQUISITION_LAG,
    SENSOR_GAIN,
)
"""Those of hydraulic chains."""
OF_BENCH: tuple[Effect, ...] = (SECOND_LAG, SPRING_LOAD, STICTION)
"""Those of an actuator on a bench, whose signals are rated currents and pressures."""
CATALOGUE = (*EFFECTS, *OF_BENCH)
"""All of them: which a model takes its chain says."""


def effect(name: str) -> Effect:
    """The effect called `name`; raises Unusable with the names there are."""
    for known in CATALOGUE:
        if known.name == name:
            return known
    names = ", ".join(known.name for known in CATALOGUE)
    raise Unusable("unknown-effect", f"no effect {name!r}", "effects", f"choose from {names}")
