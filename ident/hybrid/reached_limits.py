"""The command from which on a changed machine leaves the limits of its rig: noise over the band of the usual tests."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ident.design.excitation import excitation
from ident.design.predicted_peaks import UncertainMachine
from ident.hybrid.changed_machine import ChangedMachine
from ident.rig.limits import RigLimits
from ident.run import Run
from ident.words.engineering import quantity
from ident.words.number import trimmed

BAND, SAMPLES, RATE = 80.0, 8192, 4096.0
"""Hz, samples, Hz: noise of the band of Qian et al. (2014), two seconds of it."""


def reached(machine: ChangedMachine, gains: tuple[float | None, ...], rig: RigLimits | None) -> Iterator[str]:
    """A sentence for each gain at which the machine is stable; nothing where no limit is stated."""
    if not rig:
        return
    values = {name: value for name, value in machine.values.items() if name != "Kp"}
    of = UncertainMachine(machine.preset, values, {}, machine.actuator)
    command = excitation("blwn", 1.0, SAMPLES, RATE, BAND)
    for gain in gains:
        run = Run(
            "what if",
            "",
            RATE,
            {"command": command, "displacement": np.zeros(SAMPLES)},
            {"command": "m", "displacement": "m"},
            specimen=machine.specimen,
            gain=gain,
        )
        found = of.linear_peaks(run)
        worst = rig.utilisation(found.sizes)
        if found.stable and worst:
            at = "" if gain is None else f" at Kp = {trimmed(gain)}"
            size = quantity(1.0 / worst[0].share, "m")
            yield f"The {worst[0].limit} of the rig is reached{at} by noise of 0 to {BAND:g} Hz from {size} RMS on."
