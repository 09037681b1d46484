"""A name in, an effect out: the catalogue, in the order in which effects act within their place."""

from collections.abc import Iterable
from importlib import import_module

from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.words.nearest import did_you_mean


def _of_files(*names: str) -> tuple[Effect, ...]:
    """The effect of each file, which has its name."""
    return tuple(getattr(import_module(f"ident.effects.{name}"), name.upper()) for name in names)


EFFECTS = _of_files(
    "command_delay",
    "command_limit",
    "integral_action",
    "lead",
    "pressure_feedback",
    "loop_delay",
    "valve_second_order",
    "valve_rate_limit",
    "spool_stiction",
    "backlash",
    "null_bias",
    "dead_zone",
    "underlap",
    "gain_asymmetry",
    "flow_saturation",
    "pressure_flow",
    "supply_droop",
    "orifice_leakage",
    "entrained_air",
    "stroke_dependent_volume",
    "coulomb_friction",
    "stribeck_friction",
    "presliding_friction",
    "quadratic_damping",
    "cubic_stiffness",
    "specimen_hysteresis",
    "specimen_free_play",
    "specimen_joint",
    "frame_compliance",
    "static_load",
    "sensor_lag",
    "acquisition_lag",
    "sensor_gain",
    "flow_force",
    "pressure_dependent_gain",
    "supply_ripple",
    "one_way_leakage",
    "unequal_areas",
    "position_friction",
    "end_stop",
    "sensor_nonlinearity",
)
"""Those of hydraulic chains."""
OF_BENCH = _of_files(
    "second_lag",
    "spring_load",
    "stiction",
)
"""Those of an actuator on a bench, whose signals are rated currents and pressures."""
OF_RECORDS = _of_files(
    "speed_asymmetry",
    "progressive_drive",
    "speed_limit",
    "root_outflow",
    "progressive_loss",
    "drive_hysteresis",
    "second_capacity",
    "upper_overflow",
    "overflow",
    "normal_force_friction",
    "pressure_friction",
    "current_friction",
    "pressure_force",
    "arm_gravity",
    "spring_preload",
    "load_friction",
    "damping_asymmetry",
    "friction_behind_play",
    "degrading_hysteresis",
    "relaxation",
    "bilinear_stiffness",
    "asymmetric_stiffness",
    "elastic_coupling",
    "elastic_load",
    "sensor_curve",
    "rectified_sensor",
    "speed_sensor_lag",
)
"""Those that only some records can show: what they read is measured, or what they need is there."""
CATALOGUE = (*EFFECTS, *OF_RECORDS, *OF_BENCH)
"""All of them: which a model takes its chain says."""


def effect(name: str, own: Iterable[str] = ()) -> Effect:
    """The effect called `name`; raises Unusable with the nearest name, those of `own` effects among them."""
    for known in CATALOGUE:
        if known.name == name:
            return known
    raise unknown(name, own)


def unknown(name: str, own: Iterable[str] = ()) -> Unusable:
    """The refusal of a name that neither the catalogue nor the `own` effects have."""
    known = (*(known.name for known in CATALOGUE), *own)
    return Unusable("unknown-effect", f"no effect {name!r}", "effects", did_you_mean(name, known))
