"""Which effects of the catalogue are fitted to a periodic test of each machine, from where, and within which bounds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

FASTEST = (
    1.5  # of the largest speed: an excess that falls at a speed that no test reaches is dry friction by another name
)


class Shape(NamedTuple):
    """A parameter beside the strength: where it is begun, in its scale, and the bounds of it."""

    name: str
    scale: str
    starts: tuple[float, ...]
    lower: float
    upper: float
    logarithmic: bool = True


class Candidate(NamedTuple):
    """How an effect is fitted at a driven mass: its strength, in its scale and to both sides of 0, and its shapes."""

    strength: str
    scale: str
    starts: tuple[float, ...]
    shapes: tuple[Shape, ...] = ()
    upper: float = np.inf
    both: bool = False


_FRICTION = (0.01, 0.04, 0.12, 0.3, 0.6, 1.0)
CANDIDATES: dict[str, Candidate] = {
    "command_delay": Candidate("T", "period", (0.01, 0.1), upper=0.5),
    "command_limit": Candidate("a", "1/drive", (1.2, 2.0), upper=20.0),
    "integral_action": Candidate("Ki", "1/period", (0.2, 2.0)),
    "lead": Candidate("Td", "period", (0.01,), upper=1.0),
    "loop_delay": Candidate("T", "period", (0.01,), upper=0.2),
    "valve_second_order": Candidate("Tn", "period", (0.01, 0.05), (Shape("zeta", "1", (0.7,), 0.1, 3.0),), upper=0.5),
    "backlash": Candidate("b", "drive", (0.01, 0.05, 0.2), upper=0.9),
    "dead_zone": Candidate("h", "drive", (0.02, 0.08, 0.3), (Shape("a", "1", (0.0,), -1.0, 1.0, False),), upper=0.9),
    "underlap": Candidate("h", "drive", (0.02, 0.08, 0.3), upper=1.0),
    "gain_asymmetry": Candidate("a", "1", (0.05, -0.05), upper=0.95, both=True),
    "flow_saturation": Candidate("a", "1/drive", (0.3, 1.5), upper=20.0),
    "coulomb_friction": Candidate("Fc", "force", _FRICTION),
    "stribeck_friction": Candidate(
        "dF", "force", (0.05, 0.2, 0.6), (Shape("vs", "speed", (0.03, 0.15, 0.6), 3e-3, FASTEST),)
    ),
    "presliding_friction": Candidate(
        "Fd", "force", (0.04, 0.15, 0.5), (Shape("xs", "way", (3e-3, 0.03, 0.2), 3e-4, 5.0),)
    ),
    "quadratic_damping": Candidate("c2", "force/speed^2", (0.04, 0.2)),
    "cubic_stiffness": Candidate("k3", "force/way^3", (0.1, 0.02, -0.05), both=True),
    "sensor_lag": Candidate("T", "period", (0.01,), upper=0.5),
    "acquisition_lag": Candidate("T", "period", (0.01,), upper=0.5),
    "sensor_gain": Candidate("g", "1", (0.01,), upper=0.9, both=True),
    "position_friction": Candidate("Fx", "force/way^2", _FRICTION),
    "end_stop": Candidate(
        "ks",
        "force/way",
        (1.0, 10.0),
        (Shape("way", "way", (0.7, 0.85, 0.95), 0.2, 1.2), Shape("xm", "way", (0.0,), -0.3, 0.3, False)),
    ),
    "sensor_nonlinearity": Candidate("s", "1/way^2", (0.05,), both=True),
}
"""The catalogue at a driven mass; stops are begun where they would cut the motion that the base makes."""

_OF_LOAD = (
    "coulomb_friction",
    "stribeck_friction",
    "presliding_friction",
    "quadratic_damping",
    "cubic_stiffness",
    "position_friction",
    "end_stop",
)
_OF_DRIVE = (
    "command_delay",
    "command_limit",
    "valve_second_order",
    "backlash",
    "dead_zone",
    "underlap",
    "gain_asymmetry",
    "flow_saturation",
)
APPLICABLE: dict[str, tuple[str, ...]] = {
    "specimen": (*_OF_LOAD, "specimen_hysteresis", "specimen_free_play"),
    "motor": (*_OF_DRIVE, *_OF_LOAD),
    "drive": ("command_delay", *_OF_LOAD, "sensor_lag", "acquisition_lag", "sensor_nonlinearity"),
    "loop": (
        *_OF_DRIVE,
        *_OF_LOAD,
        "integral_action",
        "lead",
        "loop_delay",
        "sensor_lag",
        "acquisition_lag",
        "sensor_gain",
        "sensor_nonlinearity",
    ),
}
"""What is fitted at each machine; what the catalogue has beyond it changes nothing but gain and offset there."""
FREE = {"motor": ("Kt", "c"), "drive": ("m", "c", "k"), "loop": ("Kt", "c")}
"""The base's parameters of a driven mass; without a force in the records one of them is a scale of all."""
