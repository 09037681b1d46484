"""The test by which a preset is simulated where its paper prints no matrix of tests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ident.matrix import Actuator


@dataclass(frozen=True)
class RigTest:
    """Runs under noise from 0 to `band` Hz of the RMS `amplitudes` (SI, in `unit`), sampled at `sample_rate` (Hz).

    Each at each of the `gains` is to be fitted, one at their geometric mean and that of the amplitudes to be verified;
    without gains the loop has none. `outputs` are recorded; `actuator` is what is stated of the machine.
    """

    sample_rate: float
    band: float
    amplitudes: tuple[float, ...]
    unit: str
    gains: tuple[float, ...]
    outputs: tuple[str, ...]
    actuator: Actuator


TESTS: Mapping[str, RigTest] = {
    "strano": RigTest(
        1000.0,
        5.0,
        (10e-3, 30e-3),
        "m",
        (100.0, 200.0),
        ("displacement", "load_pressure", "spool"),
        Actuator("", piston_area=9.05e-3, supply_pressure=210e5),
    ),
    "first_order": RigTest(1000.0, 20.0, (5e-3, 20e-3), "m", (), ("displacement",), Actuator("")),
}
"""Of the presets that have values of their own: the rig of Strano, Terzo et al. (190 kN, ± 0.2 m), and a single lag."""
