"""One entry of the list of runs."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Any

from ident.errors import Unusable
from ident.readers.channel_description import ChannelDescription, describe_channels, describe_disturbance
from ident.readers.dialect import Dialect, describe_dialect
from ident.readers.loop_settings import loop_gain, sample_rate
from ident.readers.source import inside
from ident.readers.split import Split, describe_split
from ident.readers.trend import TRENDS
from ident.readers.typed_fields import Fields
from ident.run import BENCH, HOLDS, KINDS, MOTIONS, USES, Run, Specimen
from ident.units.quantity import quantity, shown, split, unit_scale
from ident.words.nearest import did_you_mean
from ident.words.run_name import run_name

RUN = (
    "id",
    "file",
    "sample_rate",
    "time",
    "specimen",
    "gain",
    "amplitude",
    "kind",
    "hold",
    "output",
    "use",
    "skip_rows",
    "dialect",
    "rows",
    "split",
    "trend",
    "channels",
    "disturbance",
    "position_range",
    "frequency",
    "rated_current",
    "closed_loop",
)


ANSWERS = ("displacement", "velocity", "acceleration", "force", "load_pressure")
"""Channels of a machine's answer, of which one may be the output without a word; else it is the first of LESS."""
LESS = ("temperature", "current")
"""What most runs record beside the answer, and what is the answer of a heater and of a coil."""
ZERO_CELSIUS = 273.15
"""K. A temperature that answers a command is counted from 0 °C: only its rise over the surroundings is the model's."""


@dataclass(frozen=True)
class TimeColumn:
    """The column that holds the time, `factor` s a unit; `resample`, Hz, is the even clock that is asked for."""

    column: str | int
    factor: float
    resample: float | None


@dataclass(frozen=True)
class RunDescription:
    """A run before its samples are read. `labels` is the run without channels and, with a time column, without rate.

    `outputs` are the channels that a model must reproduce: each becomes a run. Where no `hold` is stated, its samples
    choose one.
    """

    labels: Run
    outputs: tuple[str, ...]
    channels: dict[str, ChannelDescription]
    time: TimeColumn | None
    dialect: Dialect
    rows: tuple[int, int] | None
    hold_stated: bool = True
    trend: str = "none"
    split: Split | None = None


def describe_run(data: Any, where: str) -> RunDescription:
    """Read one run. Raises Unusable with the run's id and the field."""
    fields = Fields(data, where, RUN)
    name = describe_id(fields)
    fields = Fields(data, run_name(name), RUN)
    kind = fields.choice("kind", KINDS, "other")
    described = fields.need("channels", "describe command and displacement")
    channels = describe_channels(described, fields.place("channels"), RUN)
    outputs = describe_outputs(fields, kind, channels)
    if "temperature" in outputs and (answer := channels["temperature"]).scale.unit == "K":
        counted = replace(answer.scale, offset=answer.scale.offset - ZERO_CELSIUS)
        channels |= {"temperature": replace(answer, scale=counted)}
    if "disturbance" in fields:
        channels |= describe_disturbance(fields.data["disturbance"], fields.place("disturbance"))
    time, rate, time_unit = describe_clock(fields)
    units = {channel: described.scale.unit for channel, described in channels.items()}
    fields.need("file", "add file: runs/NAME.csv")
    labels = Run(
        id=name,
        file=inside(fields.text("file"), fields.place("file")),
        sample_rate=rate,
        channels={},
        units=units,
        time_unit=time_unit,
        specimen=describe_specimen(fields),
        gain=describe_gain(fields),
        amplitude=fields.positive("amplitude", _driven_unit(units)),  # RMS of the command, in its kind of unit
        kind=kind,
        hold=describe_hold(fields, kind),
        output=outputs[0],
        use=fields.choice("use", USES, "fit"),
        position_range=describe_range(fields, units.get("displacement", "m")),
        frequency=fields.positive("frequency", "frequency" if time_unit == "s" else "per sample"),
        rated_current=fields.positive("rated_current", units.get("current", "A")),
        closed_loop=fields.truth("closed_loop") if "closed_loop" in fields else None,
        zeroed={name: channel.zeroed for name, channel in channels.items() if channel.zeroed is not None},
    )
    rows, hold_stated = describe_rows(fields), "hold" in fields
    trend = describe_trend(fields, kind)
    dialect = describe_dialect(fields.data.get("dialect"), fields.place("dialect"), fields.whole("skip_rows"))
    split = describe_split(fields, kind, labels.use, time_unit)
    return RunDescription(labels, outputs, channels, time, dialect, rows, hold_stated, trend, split)


def _driven_unit(units: dict[str, str]) -> str:
    """The unit of what drives the actuator: a command, or at a bench the current."""
    return units.get("command", units.get("current", "m"))


def describe_id(fields: Fields) -> str:
    """The id, which becomes a part of file names and addresses. Raises Unusable: ``bad-id``."""
    fields.need("id", "give each run its own id")
    name = fields.text("id")
    if not name or name.startswith(".") or len(name) > 100 or any(sign in name for sign in '/\\:*?"<>|'):
        raise Unusable(
            "bad-id", f"{shown(name)!r} cannot name files", fields.place("id"), "use letters, digits, - and _"
        )
    return name


def describe_hold(fields: Fields, kind: str) -> str:
    """What the command does between its samples. Raises Unusable: ``unknown-hold``; ``bench-hold`` for a bench."""
    hold = fields.choice("hold", HOLDS, "linear")
    if hold == "band-limited" and kind in BENCH:
        what = "the current of a bench is drawn or held between its samples"
        raise Unusable("bench-hold", what, fields.place("hold"), "use linear or zoh")
    return hold


def describe_trend(fields: Fields, kind: str) -> str:
    """What is taken out of every signal. Raises Unusable: ``unknown-trend``; ``bench-trend`` for a bench."""
    trend = fields.choice("trend", TRENDS, "none")
    if trend != "none" and kind in BENCH:
        what = "the procedures of a bench measure the means of its signals"
        raise Unusable("bench-trend", what, fields.place("trend"), "write trend: none")
    return trend


def describe_outputs(fields: Fields, kind: str, channels: dict[str, ChannelDescription]) -> tuple[str, ...]:
    """The channels that a model must reproduce; they and a command, or what else drives, must be described."""
    given = fields.data.get("output")
    outputs = fields.names("output") if isinstance(given, list) else (fields.text("output", _usual(channels)),)
    for output in outputs:
        if output not in channels:
            what, remedy = f"{shown(output)!r} is not a channel of this run", did_you_mean(output, channels)
            raise Unusable("unknown-output", what, fields.place("output"), remedy)
    moved = outputs == ("force",) and channels.keys() & set(MOTIONS)
    if "command" not in channels and not moved and not (kind in BENCH and "current" in channels):
        raise Unusable("missing-command", "there is no command", fields.place("channels"), "describe the command")
    if "command" in outputs:
        raise Unusable("unknown-output", "the command cannot be the output", fields.place("output"), "name a response")
    if outputs != ("force",):
        _refuse_stress(fields, channels)
    return outputs


def _refuse_stress(fields: Fields, channels: dict[str, ChannelDescription]) -> None:
    """Raises Unusable: ``stress`` where a force that is not the output has the unit of a pressure."""
    if "force" in channels and channels["force"].scale.unit == "Pa":
        raise Unusable(
            "stress",
            "the force is a stress, the force for each area of a specimen, and it is not the output",
            fields.place("channels.force"),
            "name it as the output (output: force), give a unit of force, or say that it is a load_pressure",
        )


def _usual(channels: Collection[str]) -> str:
    """The displacement, or what alone was recorded of the answer to a command."""
    answers = [name for name in ANSWERS if name in channels] or [name for name in LESS if name in channels][:1]
    return answers[0] if len(answers) == 1 and "command" in channels else "displacement"


def describe_clock(fields: Fields) -> tuple[TimeColumn | None, float, str]:
    """Time column or sample rate; and whether time is in s or in samples."""
    if ("time" in fields) == ("sample_rate" in fields):
        what = "both time and sample_rate are given" if "time" in fields else "neither sample_rate nor time is given"
        raise Unusable("clock", what, fields.where, "give sample_rate: 4096 Hz, or time: {column: t, unit: s}")
    if "time" in fields:
        clock = Fields(fields.data["time"], fields.place("time"), ("column", "unit", "resample"))
        column = clock.need("column", "name the column that holds the time")
        clock.need("unit", "add unit: s")
        factor = unit_scale(clock.text("unit"), "time", clock.place("unit")).factor
        return TimeColumn(column, factor, clock.positive("resample", "frequency")), 0.0, "s"
    unit = split(fields.data["sample_rate"], fields.place("sample_rate"))[1].replace(" ", "")
    if unit in ("1/sample", "sample^-1"):
        return None, fields.positive("sample_rate", "per sample") or 0.0, "sample"
    return None, sample_rate(fields) or 0.0, "s"


def describe_specimen(fields: Fields) -> Specimen | None:
    """What the actuator moves; mass, stiffness and damping that are not stated are 0."""
    if "specimen" not in fields:
        return None
    given = Fields(fields.data["specimen"], fields.place("specimen"), ("mass", "stiffness", "damping"), RUN)
    values = {key: given.not_negative(key, key) for key in ("mass", "stiffness", "damping")}
    return Specimen(**{key: value for key, value in values.items() if value is not None})


def describe_gain(fields: Fields) -> float | None:
    """Kp, a dial, or V/m. Raises Unusable: ``zero-gain``, ``negative-gain``."""
    gain = loop_gain(fields)
    if gain is not None and gain <= 0:
        raise Unusable(
            "zero-gain" if gain == 0 else "negative-gain",
            f"Kp is {gain:g}, and the loop is open",
            fields.place("gain"),
            "give the gain that was set",
        )
    return gain


def describe_range(fields: Fields, unit: str) -> tuple[float, float] | None:
    """The positions between which a bench record ran."""
    pair = fields.pair("position_range")
    if pair is None:
        return None
    place = fields.place("position_range")
    low, high = (quantity(value, unit, place) for value in pair)
    if not low < high:
        raise Unusable("empty-range", "the first position is not below the second", place, "write [low, high]")
    return low, high


def describe_rows(fields: Fields) -> tuple[int, int] | None:
    """The part [first, end) of the file."""
    pair = fields.pair("rows")
    if pair is None:
        return None
    first, end = pair
    if not isinstance(first, int) or not isinstance(end, int) or not 0 <= first < end:
        remedy = "write [first, end]: 0 is the first sample, and end is not included"
        raise Unusable("bad-rows", f"{shown(pair)} is not a part of a file", fields.place("rows"), remedy)
    return first, end
