"""A machine put together from stages, one a place: a description in, a model out.

The description is that of matrix.yaml's `machine:` and of a file given as `--model FILE.yaml`. A machine's name is its
description in one line, so that a result, a job and a page know it by the name of their model.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from ident.chain.chain import Chain
from ident.errors import Unusable
from ident.presets.description import CHOICES, GAINS, Description, described, description
from ident.presets.preset import Display, Preset, RequiredData, SearchPlan
from ident.presets.specimen import SPECIMEN
from ident.stages import (
    BLOCKED,
    COMPRESSIBLE,
    FIRST_ORDER_VALVE,
    FLOW_TO_SPEED,
    FOLLOWING,
    IDEAL_SENSOR,
    INSTANT_VALVE,
    LINEAR_FLOW,
    MASS_SPRING_DAMPER,
    MEASURED_LOAD,
    OPENED_BY_COMMAND,
    PI,
    PID,
    PRESSED_SPECIMEN,
    PROPORTIONAL,
    RIGID_SPOOL,
    SECOND_ORDER_VALVE,
    SPEED_INSIDE,
    SQUARE_ROOT_FLOW,
    TORQUE,
    TWO_MASSES,
    TWO_MASSES_AT_LOAD,
    Scale,
    Stage,
    transducer,
)

_CONTROLLERS = {"none": OPENED_BY_COMMAND, "p": PROPORTIONAL, "pi": PI, "pid": PID, "cascade": SPEED_INSIDE}
_VALVES = {"none": INSTANT_VALVE, "first": FIRST_ORDER_VALVE, "second": SECOND_ORDER_VALVE}
_FLOWS = {"linear": LINEAR_FLOW, "square_root": SQUARE_ROOT_FLOW, "to_speed": FLOW_TO_SPEED}
_LOADS = {
    "mass_spring_damper": MASS_SPRING_DAMPER, "measured_force": MEASURED_LOAD, "two_masses": TWO_MASSES,
    "two_masses_at_load": TWO_MASSES_AT_LOAD,
}  # fmt: skip
_COUPLED = ("two_masses", "two_masses_at_load")
"""Loads of two masses with a spring between them."""
_WORDS = {
    "p": "proportional", "pi": "PI", "pid": "PID", "cascade": "cascaded", "first": "first-order valve",
    "second": "second-order valve", "linear": "linear flow", "square_root": "turbulent flow",
    "to_speed": "flow to speed", "compressible": "compressible oil", "mass_spring_damper": "mass, spring, damper",
    "prescribed_motion": "prescribed motion", "measured_force": "measured load",
    "two_masses": "two masses, recorded at the drive", "two_masses_at_load": "two masses, recorded at the load",
}  # fmt: skip


@lru_cache(maxsize=64)
def machine(name: str) -> Preset:
    """The model of a description in one line. Raises Unusable where two of its stages do not go together."""
    return composed(described(description(name)))


def composed(of: Description, name: str = "", title: str = "") -> Preset:
    """The model of a description. Raises Unusable in one line where two of its stages do not go together."""
    if of["load"] == "prescribed_motion":
        return _moved(of, name)
    _refuse_misfits(of)
    chain = Chain(_stages(of), _outputs(of))
    try:
        _ = chain.signals
    except Unusable:
        raise _misfit("controller", of["controller"], "valve", of["valve"], f"a loop of {of['of']} needs a lag in it",
                      "add valve: first") from None  # fmt: skip
    return Preset(
        name=name or of.name,
        title=title or _title(of),
        citation="Put together from stages: H. E. Merritt, Hydraulic Control Systems. Wiley (1967), chapters 6 to 8.",
        chain=chain,
        without_area=_WITHOUT_AREA if of.hydraulic else None,
        search=SearchPlan(
            rescaled=tuple(_rescaled(of)),
            force_scale=_force_scale(of),
            relative_ways=of.sensor[0] in ("displacement", "velocity"),
            drive_scale="Kp*U" if of.closed else "U",
        ),
        data=RequiredData(
            share_force=_share_force(of),
            gains=_gains(of),
            compares=of.compares,
        ),
        display=Display(
            of_drive=("Kv", "Kt"),
        ),
    )


def _gains(of: Description) -> dict[str, float]:
    """What is known beforehand: the gains that are stated, and that a transducer in the loop reads what it should."""
    read = {"cal": 1.0} if of.compares not in ("", "displacement") else {}
    return read | {GAINS[gain]: value for gain, value in of.gains.items()}


_WITHOUT_AREA = {"Z0": ("Z0/A^2", "1/s"), "Ka": ("Ka/A^2", "m/N"), "Cl": ("Cl/A^2", "m/(N*s)")}


def _moved(of: Description, name: str) -> Preset:
    """A specimen alone, whose motion is prescribed."""
    driving = [place for place in ("controller", "valve", "flow", "pressure") if of[place] != CHOICES[place][0]]
    if driving:
        raise _misfit(driving[0], of[driving[0]], "load", of["load"], "both give the speed",
                      "leave out what drives, or let the load be moved by it")  # fmt: skip
    if of.sensor not in (("force",), ("displacement",)):
        raise _misfit("load", of["load"], "sensor", of.sensor[0], "the motion is known", "record the force")
    return replace(SPECIMEN, name=name or replace(of, sensor=("force",)).name)


def _refuse_misfits(of: Description) -> None:
    flow, pressure, load = of["flow"], of["pressure"], of["load"]
    if flow == "to_speed" and of.hydraulic:
        raise _misfit("flow", flow, "pressure", pressure, "the one gives the speed, the other needs a flow",
                      "leave out the pressure, or choose flow: linear")  # fmt: skip
    if flow == "to_speed" and load != "none":
        raise _misfit("flow", flow, "load", load, "both give the speed", "leave out the load, or choose flow: linear")
    if flow in ("linear", "square_root") and not of.hydraulic:
        raise _misfit("flow", flow, "load", load, "nothing turns the flow into a force",
                      "add pressure: compressible, or choose flow: to_speed")  # fmt: skip
    if of.hydraulic and flow == "none":
        raise _misfit("pressure", pressure, "flow", flow, "no flow feeds the pressure", "add flow: linear")
    if flow == "none" and load == "none":
        raise _misfit("flow", flow, "load", load, "nothing moves, and nothing is pressed",
                      "add load: mass_spring_damper for a motor, or flow: to_speed")  # fmt: skip
    given = _given(of)
    for shown in sorted(_known(of)):
        if shown not in given:
            raise _misfit("load", load, "sensor", shown, f"no stage gives a {shown.replace('_', ' ')}",
                          f"record {' or '.join(given)}")  # fmt: skip


def _given(of: Description) -> dict[str, str]:
    """The signal that shows each channel that the machine has."""
    given = {"load_pressure": "P"} if of.hydraulic else {}
    if of["load"] != "none" or of["flow"] == "to_speed":
        given |= {"displacement": "X", "velocity": "vy"}
    if of["load"] != "none":
        given |= {"acceleration": "ay"}
    if of["flow"] != "to_speed" and of["load"] not in ("measured_force", *_COUPLED):
        given |= {"force": "F"}
    return given


def _stages(of: Description) -> tuple[Stage, ...]:
    if of.hydraulic:
        drive: tuple[Stage, ...] = (_FLOWS[of["flow"]], COMPRESSIBLE)
    else:
        drive = (FLOW_TO_SPEED,) if of["flow"] == "to_speed" else (TORQUE,)
    return (_CONTROLLERS[of["controller"]], _VALVES[of["valve"]], RIGID_SPOOL, *drive, _load(of), *_sensor(of))


def _load(of: Description) -> Stage:
    if of["load"] == "none":
        return BLOCKED if of.hydraulic else FOLLOWING
    pressed = of["load"] == "mass_spring_damper" and "force" in _known(of)
    return PRESSED_SPECIMEN if pressed else _LOADS[of["load"]]


def _sensor(of: Description) -> tuple[Stage, ...]:
    """What the controller sees; in open loop nothing but a position needs a stage of its own."""
    compared = of.compares or "displacement"
    if compared == "displacement":
        return (IDEAL_SENSOR,) if "displacement" in _given(of) else ()
    if compared == "velocity":
        return (transducer("v", "a" if of["load"] != "none" else "0", "s"),)
    return (transducer("F", "(k + kS) * v" if of["load"] != "none" else "A * (Q - L) / Ke", "m/N"),)


def _outputs(of: Description) -> dict[str, str]:
    """What is recorded: of what the loop compares, and of the position, the transducer's reading."""
    compared = of.compares or "displacement"
    return {shown: "y" if shown == compared else _given(of)[shown] for shown in of.sensor}


def _rescaled(of: Description) -> list[Scale]:
    """How what a machine of unknown size is searched for hangs on what its command is and what is recorded."""
    # X is the size of the displacement, where it is recorded beside something else.
    shown = of.compares or ("displacement" if "displacement" in of.sensor else of.sensor[0])
    found: list[Scale] = []
    if of["load"] != "none":
        found = [Scale("m0", "mL", 1e-2, 1e3)]
        if _force_known(of):
            commanded = of["of"] == "force" and _motion_known(of)
            found = [Scale("m0", "U / (W**2 * L)", 1e-4, 1e4) if commanded else Scale("m0", "1", 1e-2, 1e6)]
        found += [Scale("c0", "m0 * W", 1e-4, 1e2)]
    if of.hydraulic:
        found += [Scale("Ka", "A**2 / (m0 * W**2)" if of["load"] != "none" else "1", 1e-4, 1e3)]
        gain, text = "Z0", {
            ("displacement", True): "A**2 * W / Kp", ("velocity", True): "A**2 / Kp", ("force", True): "Ka * W / Kp",
            ("displacement", False): "A**2 * X * W / U", ("velocity", False): "A**2 * X / U",
            ("acceleration", False): "A**2 * X / (W * U)",
            ("force", False): "Ka * X * W / U", ("load_pressure", False): "A * Ka * X * W / U",
        }[shown, of.closed]  # fmt: skip
    elif of["flow"] == "to_speed":
        gain, text = "Kv", {
            ("displacement", True): "W / Kp", ("velocity", True): "1 / Kp",
            ("displacement", False): "X * W / U", ("velocity", False): "X / U",
        }[shown, of.closed]  # fmt: skip
    else:
        gain, text = "Kt", {
            ("displacement", True): "m0 * W**2 / Kp", ("velocity", True): "m0 * W / Kp", ("force", True): "1 / Kp",
            ("displacement", False): "c0 * X * W / U", ("velocity", False): "c0 * X / U", ("force", False): "X / U",
            ("acceleration", False): "m0 * X / U",
        }[shown, of.closed]  # fmt: skip
    # In open loop a turned sign cannot be told from a negative gain.
    found += [Scale(gain, text, 1e-3, 1e3) if of.closed else Scale(gain, text, -3e1, 3e1, logarithmic=False)]
    return found


def _known(of: Description) -> set[str]:
    """What is recorded, or commanded of a controller."""
    return {*of.sensor, of.compares} - {""}


def _force_known(of: Description) -> bool:
    return bool({"force", "load_pressure"} & _known(of)) or of["load"] == "measured_force"


def _motion_known(of: Description) -> bool:
    return bool({"displacement", "velocity", "acceleration"} & _known(of))


def _force_scale(of: Description) -> str:
    if of["flow"] == "to_speed":
        return ""
    if of["load"] == "none":
        return "A*Ka*U"
    if of.hydraulic or of["load"] == "measured_force":
        return "(c0 + m0*W)*W*L"
    return "Kt*Kp*U" if of.closed else "abs(Kt)*M"  # what drives it: what holds more stands still


def _share_force(of: Description) -> tuple[str, ...]:
    """What one factor leaves as it is: forces where none is known, motions where none is."""
    if of["load"] == "none":
        return ("Ka", "Cl", "Z0") if of.hydraulic else ()
    if _force_known(of) and _motion_known(of):
        return ()
    oil = ("Ka", "Cl", "Z0") if _force_known(of) else ("Ka", "Cl")
    joint = ("m1", "kj", "cj") if of["load"] in _COUPLED else ()
    return ("m0", "c0", *joint, *(oil if of.hydraulic else ("Kt",)))


def _title(of: Description) -> str:
    loop = f"{_WORDS[of['controller']]} loop of {of['of']}" if of.closed else "open loop"
    parts = [_WORDS[of[place]] for place in ("valve", "flow", "pressure", "load") if of[place] != "none"]
    return f"{loop[0].upper()}{loop[1:]}: {', '.join(parts)}"


def _misfit(one: str, kind: str, other: str, other_kind: str, why: str, remedy: str) -> Unusable:
    """The refusal of two stages that do not go together."""
    return Unusable(
        "bad-machine", f"{one}: {kind} and {other}: {other_kind} do not go together, {why}", "machine", remedy
    )
