"""Values that the stated machine cannot reach."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ident.checks.finding import Finding
from ident.matrix import Actuator
from ident.run import Run
from ident.words.message import message

PRESSURES = ("load_pressure", "pressure_a", "pressure_b")
MARGIN = 1.1  # pressure peaks above the supply; a stroke is printed with its cushions


def ranges(run: Run, actuator: Actuator) -> Iterator[Finding]:
    """Travel beyond the stroke, pressure beyond the supply."""
    travel = run.channels.get("displacement")
    if actuator.stroke is not None and travel is not None and run.units.get("displacement") == "m":
        extent = float(np.ptp(travel))
        if extent > MARGIN * actuator.stroke:
            text = message("check.beyond_stroke", run=run.id, extent=extent, stroke=actuator.stroke)
            yield Finding.of(run.id, "fault", "beyond-stroke", text)
    for name in PRESSURES:
        pressure = run.channels.get(name)
        if actuator.supply_pressure is None or pressure is None or run.units.get(name) != "Pa":
            continue
        highest = float(np.abs(pressure).max())
        if highest > MARGIN * actuator.supply_pressure:
            supply = actuator.supply_pressure
            text = message("check.beyond_supply", channel=name, run=run.id, highest=highest, supply=supply)
            yield Finding.of(run.id, "doubt", "beyond-supply", text)
