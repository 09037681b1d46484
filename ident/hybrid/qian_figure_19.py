"""Fig. 19 of Qian et al. (2014), section 5.3: the case that it shows, and whether a machine is that one."""

from __future__ import annotations

import numpy as np

from ident.hybrid.changed_machine import ChangedMachine
from ident.hybrid.peak_problem import Axes, PeakTarget
from ident.hybrid.peaks import Peak

AREA, STROKE = 239e-6, 4 * 0.0254  # m², m
MASS, STIFFNESS = 2.06, 30.65e3  # kg, N/m
PRINTED = PeakTarget(45.0, 2.0, (2.0, 3.0), (Axes(2.0, 0.5, 1.0), Axes(3.0, 0.5, 2.0)), 50.0)
"""The peak near 45 Hz inside the printed axes: |G| 0.5 to 1 at Kp = 2, 0.5 to 2 at Kp = 3, 0 to 50 Hz. Linear, though
labelled dB."""
_SAME, _TABLE_4 = 0.01, 0.1  # of a size, of a fitted value


def note_on_figure_19(machine: ChangedMachine, peaks: tuple[Peak, ...]) -> str | None:
    """What is to be said where a machine is that of Fig. 19 and has no such peak; None for any other."""
    size, specimen = machine.actuator, machine.specimen
    given = (size.piston_area, size.stroke, specimen.mass, specimen.stiffness)
    same = [a is not None and np.isclose(a, b, rtol=_SAME) for a, b in zip(given, _CASE, strict=True)]
    if not all(same) or any(abs(peak.frequency - PRINTED.frequency) <= PRINTED.tolerance for peak in peaks):
        return None
    printed = all(
        entry.why != "as set" and np.isclose(entry.before, machine.preset.parameter(name).value, rtol=_TABLE_4)
        for name, entry in machine.parameters.items()
    )
    source = "Table 4" if printed else "these values"
    return (
        f"Fig. 19 of Qian et al. (2014) shows a peak near 45 Hz for this actuator and specimen. It does "
        f"not follow from {source}: as scaled there is no such peak."
    )


_CASE = (AREA, STROKE, MASS, STIFFNESS)
