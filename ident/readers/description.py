"""matrix.yaml as data: what each run is, in SI, before any sample is read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ident.errors import Unusable
from ident.matrix import Actuator, Controller
from ident.presets import preset
from ident.presets.description import described
from ident.readers.limits import Limits
from ident.readers.provenance_description import describe_test
from ident.readers.regulator_description import describe_regulator
from ident.readers.rig import rig_of
from ident.readers.run_description import RunDescription, describe_run
from ident.readers.source import DESCRIPTION, inside
from ident.readers.split import validation_id
from ident.readers.strict_yaml import read_yaml
from ident.readers.typed_fields import Fields
from ident.rig.provenance import UNSTATED, Provenance
from ident.rig.regulator import PositionControl
from ident.run import Run
from ident.units.quantity import shown

TOP = ("actuator", "runs", "controller", "regulator", "machine", "limits", "rig", "test")
ACTUATOR = ("serial", "name", "batch", "piston_area", "stroke", "volume", "supply_pressure", "servo_valve", "notes")


@dataclass(frozen=True)
class Description:
    """The whole of matrix.yaml; `profile` is the file that holds the limits of the rig, "" where they stand here."""

    actuator: Actuator
    runs: tuple[RunDescription, ...]
    controller: Controller | None
    limits: str | None
    machine: str
    profile: str = ""
    test: Provenance = UNSTATED
    regulator: PositionControl | None = None


def describe(text: bytes, limits: Limits) -> Description:
    """Read matrix.yaml. Raises Unusable with the file's and the field's name; docs/matrix-format.md has every code."""
    try:
        return _described(read_yaml(text, DESCRIPTION), limits)
    except Unusable as error:
        raise error.within(DESCRIPTION) from None


def _described(data: Any, limits: Limits) -> Description:
    if data is None:
        raise Unusable("empty-file", "the description is empty", DESCRIPTION, "describe the actuator and its runs")
    top = Fields(data, DESCRIPTION, TOP)
    actuator = describe_actuator(top.need("actuator", "add actuator: {serial: ...}"))
    runs = describe_runs(top.need("runs", "add a list of runs"), limits)
    controller = describe_controller(top.data["controller"]) if "controller" in top else None
    bounds = inside(top.text("limits"), top.place("limits")) if "limits" in top else None
    machine = described(top.data["machine"]).name if "machine" in top else ""
    if machine:
        preset(machine)
    profile, rig = "", top.data.get("rig")
    if isinstance(rig, str):
        profile = inside(top.text("rig"), top.place("rig"))
    elif rig is not None:
        actuator = replace(actuator, rig=rig_of(rig))
    test = describe_test(top.data["test"]) if "test" in top else UNSTATED
    regulator = describe_regulator(top.data["regulator"]) if "regulator" in top else None
    return Description(actuator, runs, controller, bounds, machine, profile, test, regulator)


def describe_actuator(data: Any) -> Actuator:
    """The machine; its serial number is needed, because results are stored under it."""
    fields = Fields(data, "actuator", ACTUATOR)
    fields.need("serial", "add serial: the actuator's serial number")
    return Actuator(
        serial=fields.text("serial"),
        name=fields.text("name"),
        batch=fields.text("batch"),
        piston_area=fields.positive("piston_area", "area"),
        stroke=fields.positive("stroke", "length"),
        supply_pressure=fields.positive("supply_pressure", "pressure"),
        servo_valve=fields.text("servo_valve"),
        notes=fields.text("notes"),
        volume=fields.positive("volume", "volume"),
    )


def describe_controller(data: Any) -> Controller:
    """A position loop around a drive."""
    fields = Fields(data, "controller", ("kp", "kv"))
    for key in ("kp", "kv"):
        fields.need(key, "give kp in 1/s and kv in V*s/m")
    kp, kv = fields.positive("kp", "1/s"), fields.positive("kv", "V*s/m")
    if kp is None or kv is None:
        raise Unusable("missing-field", "kp or kv is empty", "controller", "give kp in 1/s and kv in V*s/m")
    return Controller(kp, kv)


def describe_runs(data: Any, limits: Limits) -> tuple[RunDescription, ...]:
    """Every run, ids being unique whatever the case of their letters: figures are stored under them."""
    if not isinstance(data, list) or not data:
        raise Unusable("no-runs", f"{shown(data)!r} is not a list of runs", "runs", "describe at least one run")
    if len(data) > limits.runs:
        what = f"{len(data)} runs where {limits.runs} are allowed"
        raise Unusable("too-large", what, "runs", "split the matrix")
    runs = tuple(describe_run(each, f"run {number}") for number, each in enumerate(data, 1))
    refuse_twice([one.id for run in runs for part in _parts(run) for one in part.of_outputs(run.outputs)])
    return runs


def _parts(run: RunDescription) -> tuple[Run, ...]:
    """What a run becomes when it is read: itself, and its validation data where it is split."""
    whole = run.labels
    return (whole,) if run.split is None else (whole, replace(whole, id=validation_id(whole.id)))


def refuse_twice(ids: Sequence[str]) -> None:
    """Raises Unusable: ``duplicate-id``."""
    seen: set[str] = set()
    for each in ids:
        if each.casefold() in seen:
            raise Unusable("duplicate-id", f"two runs are called {each!r}", "runs", "give each run its own id")
        seen.add(each.casefold())
