"""Motions, forces and pressures that left what the rig allows."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ident.checks.finding import Finding
from ident.matrix import Actuator
from ident.rig.limits import PEAKS, UNITS
from ident.rig.motion import edge_of_band, motion_peaks
from ident.run import BENCH, Run
from ident.words.message import message

BEYOND = "beyond-rig"
"""The code of such a finding: it is said first."""
_PRESSURES = ("load_pressure", "pressure_a", "pressure_b")


def beyond_rig(run: Run, actuator: Actuator) -> Iterator[Finding]:
    """A doubt for each limit of the rig that a record leaves; nothing where the matrix states none under `rig`."""
    if actuator.rig is None or run.time_unit != "s":
        return
    for each in actuator.rig_limits.utilisation(_peaks(run, actuator)):
        if each.exceeded:
            unit = UNITS[each.limit]
            sizes = {"peak": (each.peak, unit), "allowed": (each.allowed, unit), "share": each.share}
            values = {"run": run.id, "limit": each.limit, "what": PEAKS[each.limit], "kept": 1 / each.share, **sizes}
            yield Finding.of(run.id, "doubt", BEYOND, message("check.beyond_rig", **values))


def _peaks(run: Run, actuator: Actuator) -> dict[str, float]:
    """The largest sizes that a record shows, SI, by the name of the limit."""
    channels = {name: samples for name, samples in run.channels.items() if run.units.get(name) not in (None, "1")}
    found: dict[str, float] = {}
    if "displacement" in channels and run.units["displacement"] == "m":
        drive = channels.get("command", channels["displacement"])
        found = motion_peaks(channels["displacement"], run.sample_rate, edge_of_band(drive, run.sample_rate))
        if run.kind in BENCH:  # a converter's steps have no acceleration
            del found["acceleration"]
    if "velocity" in channels and run.units["velocity"] == "m/s":
        found["speed"] = float(np.abs(channels["velocity"]).max())
    forces = [np.abs(channels[name]).max() for name in ("force", "drive_force") if run.units.get(name) == "N"]
    pressures = [np.abs(channels[name]).max() for name in _PRESSURES if run.units.get(name) == "Pa"]
    if actuator.piston_area is not None:
        if "speed" in found:
            found["flow"] = actuator.piston_area * found["speed"]
        if run.units.get("load_pressure") == "Pa":
            forces.append(actuator.piston_area * np.abs(channels["load_pressure"]).max())
    if forces:
        found["force"] = float(max(forces))
    if pressures:
        found["supply_pressure"] = float(max(pressures))
    return found
