"""What the name of a column says: the words of benches in five languages, the channel that each means, and units.

A name is a suggestion: what is taken from one is shown to the user, who may answer otherwise.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from functools import lru_cache

from ident.errors import Unusable
from ident.readers.channel_description import channel_scale
from ident.units.quantity import is_known_unit, si_scale, unit_scale

_OTHER_LOOPS = ("velocity", "speed", "torque", "pressure", "current", "angle")
"""What a loop may control other than a position or a force."""
LESS_USUAL_COMMANDS = tuple(
    words
    for what in _OTHER_LOOPS
    for words in (
        *(f"{what} {word}" for word in ("command", "cmd", "setpoint", "set point", "reference", "ref", "demand")),
        *(f"{word} {what}" for word in ("commanded", "command", "cmd", "target", "desired", "reference", "ref")),
    )
)
"""Commands of other loops: a controller logs them beside the command of its position, which then is the command."""
WORDS = {
    "command": (
        *LESS_USUAL_COMMANDS, "commanded", "commanded value", "commanded force", "commanded displacement",
        "command", "cmd", "reference", "ref", "setpoint", "set point", "set value", "demand", "desired",
        "drive command", "command signal", "target", "target position", "target value", "position command",
        "command position", "commanded position", "position setpoint", "position reference", "reference position",
        "position demand", "desired position", "desired displacement", "displacement command",
        "command displacement", "pos cmd", "cmd pos", "pos ref", "ref pos", "pos set", "x cmd", "x ref", "x set",
        "x des", "xref", "xcmd", "xdes", "xd", "x d",
        "force command", "force cmd", "force setpoint", "force set point", "force demand", "load command",
        "axial force command", "axial load command", "kraft soll", "soll kraft", "kraft sollwert", "kraftsollwert",
        "sollwert kraft", "soll", "sollwert", "sollweg", "sollposition", "sollkraft", "x soll", "s soll", "xsoll",
        "ssoll", "y soll",
        "pos soll", "soll pos", "position soll", "soll position", "weg soll", "soll weg", "wegsollwert",
        "lagesollwert", "positionssollwert", "sollwert position", "sollwert weg", "fuehrungsgroesse",
        "fuhrungsgrosse", "vorgabe", "consigne", "consigne position", "position consigne", "consigne de position",
        "commande", "comando", "riferimento", "posizione comandata", "riferimento posizione", "consigna",
        "base acceleration", "ground acceleration", "ground motion", "base excitation", "input acceleration",
        "excitation acceleration", "bodenbeschleunigung", "fusspunktbeschleunigung", "acceleration du sol",
        "地面加速度", "基底加速度",
        "指令", "命令", "给定", "给定值", "设定值", "目标值", "目标位移", "指令位移", "位移指令", "命令位移",
    ),
    "displacement": (
        "displacement", "disp", "displ", "position", "pos", "lvdt", "stroke", "travel", "measured displacement",
        "measured position", "actual position", "actual displacement", "position feedback", "feedback position",
        "displacement feedback", "position actual", "position measured", "act pos", "pos act", "pos meas",
        "pos fb", "piston position", "piston displacement", "rod position", "rod displacement", "cylinder position",
        "actuator position", "actuator displacement", "table displacement", "x act", "xact", "x meas", "xmeas", "x ist",
        "xist", "s ist", "sist", "pos ist", "ist pos", "position ist", "ist position", "istposition", "weg",
        "weg ist", "ist weg", "istweg", "wegistwert", "lageistwert", "positionsistwert", "istwert position",
        "istwert weg", "hub", "kolbenweg", "kolbenposition", "kolbenhub", "zylinderweg", "auslenkung",
        "verschiebung", "deplacement", "position mesuree", "deplacement mesure", "course", "position reelle",
        "posizione", "spostamento", "corsa", "posizione misurata", "posizione reale", "posicion", "desplazamiento",
        "damper displacement", "lateral displacement", "relative displacement",
        "位移", "位置", "行程", "实际位移", "测量位移", "位移反馈", "活塞位移", "作动器位移",
    ),
    "velocity": (
        "velocity", "vel", "speed", "rpm", "actual velocity", "actual speed", "measured velocity", "measured speed",
        "geschwindigkeit", "drehzahl", "kolbengeschwindigkeit", "istgeschwindigkeit", "istdrehzahl", "vitesse",
        "velocita", "velocidad",
        "速度", "转速",
    ),
    "acceleration": (
        "acceleration", "accel", "acc", "accelerometer", "measured acceleration", "actual acceleration",
        "floor acceleration", "roof acceleration", "top acceleration", "mass acceleration", "response acceleration",
        "absolute acceleration", "beschleunigung", "istbeschleunigung", "acceleration mesuree", "accelerazione",
        "aceleracion",
        "加速度", "响应加速度",
    ),
    "force": (
        "force", "load", "load cell", "measured force", "actual force", "force feedback", "torque", "axial force",
        "kraft", "istkraft", "zylinderkraft", "kolbenkraft", "kraftmessdose", "drehmoment", "effort", "couple",
        "force mesuree", "forza", "cella di carico", "coppia", "fuerza", "actuator force", "actuator load",
        "damper force", "lateral force", "lateral load", "base shear",
        "力", "力值", "载荷", "荷载", "试验力", "负荷", "作动力", "阻尼力", "扭矩", "转矩",
    ),
    "load_pressure": (
        "load pressure", "differential pressure", "delta p", "dp", "pl", "lastdruck", "differenzdruck",
        "druckdifferenz", "pression differentielle", "pressione differenziale",
    ),
    "pressure_a": ("pressure a", "pa side", "p a", "druck a", "pression a", "pressione a"),
    "pressure_b": ("pressure b", "pb side", "p b", "druck b", "pression b", "pressione b"),
    "supply_pressure": (
        "supply pressure", "ps", "versorgungsdruck", "systemdruck", "pression d alimentation",
        "pression alimentation", "pressione di alimentazione",
    ),
    "spool": (
        "spool", "spool position", "spool displacement", "schieberweg", "schieberposition", "ventilschieber",
        "position tiroir", "posizione cursore",
    ),
    "current": ("current", "valve current", "strom", "ventilstrom", "courant", "corrente"),
    "temperature": (
        "temperature", "temp", "oil temperature", "temperatur", "oltemperatur", "oeltemperatur", "temperatura",
        "温度", "油温",
    ),
}  # fmt: skip
"""Names of columns, in small letters without accents, with the channel of matrix.yaml that they are."""
MEASURED = (
    "istwert", "ist", "messwert", "actual", "actual value", "feedback", "measured", "measurement", "response",
    "output", "mesure", "valeur mesuree", "retour", "misura", "misurato", "valore misurato", "medida", "y", "yout",
    "process value",
)  # fmt: skip
"""Names that say that something was measured and not what: the unit tells, and where there is none, a position is
suggested, except for the bare letters of a model's output."""
_BARE_OUTPUT = ("y", "yout", "output", "response", "measurement")
PAIRS = (("u", "y"), ("u1", "y1"), ("input", "output"), ("inputdata", "outputdata"))
"""Names of a model's input, each a command where the output beside it is there: alone, u may be a displacement."""
TIMES = (
    "time", "t", "x value", "timestamp", "elapsed time", "elapsed", "time stamp", "running time", "run time",
    "date time", "datetime", "tout", "zeit", "messzeit", "laufzeit", "zeitstempel", "temps", "tempo", "tiempo",
    "时间",
)  # fmt: skip
"""Names of a column of times."""
UNITS_BY_NAME = {"rpm": "rpm", "tout": "s"}
"""The unit of what is called so: a name that is one, and the time of Simulink, which counts seconds."""
_BY_UNIT = ("displacement", "velocity", "acceleration", "force")
_IN_NAME = re.compile(r"^(.*\S)\s*[\[(<{\uff08]\s*([^\[\](){}<>\uff08\uff09]+?)\s*[\])>}\uff09]$")  # wide brackets, too
_LETTERS = "mstAKlLhgNVWJ"
"""Units of one letter that may as well be an index: x_m is measured, p_s a supply, p_A a side, F_N normal."""
_BETWEEN_WORDS = r"[_\s.:-]+"
_NO_LETTERS = r"[^0-9a-z\u4e00-\u9fff]+"  # nor digits; Latin, and Chinese (Unicode's unified ideographs)
_KEPT = 4096  # names whose meaning is kept: the files of a matrix have the same columns
_CONTROLLED = re.compile(r"^(?:ch|chan|channel|kanal) ?\d+ (?=\S)")
"""The number of a testing machine's channel before what it controls or measures: Ch 1 Force, Kanal 2 Weg."""
_SPEEDS = ("m/s", "rad/s", "m^3/s")


@lru_cache(_KEPT)
def is_unit(text: str) -> bool:
    """Whether a text is a unit that is known here; the 1 of unknown units is none, which a file may not choose."""
    if not text or text[0].isdigit() or not is_known_unit(text):  # a refusal would look for the nearest unit
        return False
    try:
        si_scale(text, "unit")
    except Unusable:
        return False
    return True


def bracketed(name: str) -> tuple[str, str]:
    """A name and what stands in brackets behind it, which may be its unit; nothing where there are none."""
    behind = _IN_NAME.match(name)
    return (behind[1].strip(), behind[2]) if behind else (name, "")


def bare(name: str) -> str:
    """The name of a column without its groups and without a unit in brackets."""
    return bracketed(name)[0].rpartition("/")[2].strip()


@lru_cache(_KEPT)
def suffix(name: str) -> tuple[str, str]:
    """A name and the unit that ends it behind ``_`` or a space: ``Force_kN``, ``speed_mm_s``; no unit where none does.

    A unit of one letter counts where the words before it mean a channel that is measured in it, or a time.
    """
    plain = bare(name)
    parts = re.split(r"[_ ]+", plain)
    for taken, text in _endings(parts):
        stem = "_".join(parts[:-taken])
        if stem and is_unit(text) and _fits(stem, text):
            return stem, text
    return plain, ""


def _endings(parts: list[str]) -> list[tuple[int, str]]:
    """The units that a name of these parts may end with, the longest first: how many parts, and the unit."""
    found = []
    if len(parts) > 3 and parts[-2] == "per":
        found.append((3, f"{parts[-3]}/{parts[-1]}"))
    if len(parts) > 2:
        found.append((2, f"{parts[-2]}/{parts[-1]}"))
    if len(parts) > 1:
        found.append((1, parts[-1]))
    return found


def _fits(stem: str, unit: str) -> bool:
    """Whether what a name says may be measured in the unit that seems to end it."""
    if _is_time(stem):
        return measures_time(unit)
    if any(said(stem) in pair for pair in PAIRS):
        return True
    if channel := _channel_of(stem):
        return channel in MEASURED or may_measure(channel, unit)
    if "/" in unit:
        return si_scale(unit, "unit").unit in _SPEEDS
    return unit not in _LETTERS and not unit[-1].isdigit()  # Sensor A-1 is not measured in 1/A


def measures_time(unit: str) -> bool:
    """Whether a unit is one of time."""
    try:
        unit_scale(unit, "time", "unit")
    except Unusable:
        return False
    return True


def may_measure(channel: str, unit: str) -> bool:
    """Whether a column that seems to be a channel may be measured in a unit.

    A stress is a force only where someone says so: a cylinder's pressure has the same unit.
    """
    try:
        scale = channel_scale(unit, channel, "unit")
    except Unusable:
        return False
    return channel != "force" or scale.unit != "Pa"


def said(name: str) -> str:
    """A column's name as it would be said: small letters without accents, spaces, no unit in brackets, no group."""
    plain = unicodedata.normalize("NFKD", bare(name).replace("ß", "ss"))
    return " ".join(re.sub(_NO_LETTERS, " ", "".join(s for s in plain if not unicodedata.combining(s)).lower()).split())


def _ways(name: str) -> tuple[str, ...]:
    """A name as said, and as said where a capital letter begins a word: ActualPosition."""
    return said(name), said(re.sub(r"(?<=[a-z])(?=[A-Z])", " ", bare(name)))


def _channel_of(name: str) -> str:
    for way in _ways(name):
        for channel, words in WORDS.items():
            if way in words:
                return channel
        if way in MEASURED:
            return way
    controlled = _CONTROLLED.sub("", said(name))
    return next((channel for channel, words in WORDS.items() if controlled in words), "")


@lru_cache(_KEPT)
def channel_of(name: str, unit: str = "") -> str:
    """The channel that a name means, with its unit where that is known; nothing where it could be another thing."""
    stem, ending = suffix(name)
    found = _channel_of(name) or (_channel_of(stem) if ending else "")
    unit = next((one for one in (unit, bracketed(name)[1], ending) if is_unit(one)), "")
    if found not in MEASURED:
        return found
    if unit:
        return next((channel for channel in _BY_UNIT if may_measure(channel, unit)), "")
    return "" if found in _BARE_OUTPUT else "displacement"


def _is_time(name: str) -> bool:
    return any(way in TIMES for way in _ways(name))


@lru_cache(_KEPT)
def is_time(name: str) -> bool:
    """Whether a column of this name holds the time."""
    stem, ending = suffix(name)
    return _is_time(name) or bool(ending and _is_time(stem))


def stem_of(name: str) -> str:
    """A name as it would be said, without the unit that ends it."""
    return said(suffix(name)[0])


def without_common_words(names: Sequence[str]) -> tuple[str, ...]:
    """Names without the words that all of them share at an end: of EXP_Time and EXP_Pos, Time and Pos.

    A time need not share them: of Time, Axial Force and Axial Displacement. They stay as they are where one that is
    known would mean another thing, no more of them are known without the words, one would be left without a word, or
    the words are a unit.
    """
    others = [name for name in names if not is_time(name)]
    shorter = dict(zip(others, _shortened(others), strict=True))
    known = [name for name in others if is_known(name) and not _CONTROLLED.match(said(name))]
    if known or len(others) < len(names):
        kept = all(channel_of(name) == channel_of(shorter[name]) for name in known)
        if not kept or sum(map(is_known, shorter.values())) <= len(known):
            return tuple(names)
    return tuple(shorter.get(name, name) for name in names)


def _shortened(names: Sequence[str]) -> tuple[str, ...]:
    """Names without the words that all of them share at an end, where each has others."""
    if len(names) < 2:
        return tuple(names)
    parts = [re.split(_BETWEEN_WORDS, bare(name)) for name in names]
    first = _shared(parts)
    last = 0 if any(suffix(name)[1] for name in names) else _shared([part[::-1] for part in parts])
    if min(map(len, parts)) <= first + last:
        return tuple(names)
    return tuple(" ".join(part[first : len(part) - last]) for part in parts)


def _shared(parts: Sequence[Sequence[str]]) -> int:
    """How many words all names begin with."""
    alike = (len({word.lower() for word in words}) == 1 for words in zip(*parts, strict=False))
    return next((count for count, same in enumerate(alike) if not same), min(map(len, parts), default=0))


def is_known(name: str) -> bool:
    """Whether a name is one of a time or of a channel."""
    return bool(name.strip()) and (is_time(name) or bool(_channel_of(name)) or bool(channel_of(name)))
