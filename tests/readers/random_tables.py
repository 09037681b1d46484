"""Text tables as many programs write them, drawn at random, with what stands in each: written without the reader."""

from __future__ import annotations

import random
from dataclasses import dataclass, field

DELIMITERS = (",", ";", "\t", "|", " ", "   ")
ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "cp1252", "utf-16-le")
ENDS = ("\n", "\r\n", "\r")
NAMES = {
    "command": ("command", "Sollwert", "x_soll", "setpoint", "consigne", "Führungsgröße", "Position command", "cmd"),
    "displacement": ("position", "Istwert", "Weg", "Kolbenweg", "déplacement", "Position feedback", "x_ist", "pos"),
    "force": ("force", "Kraft", "Load cell", "forza"),
    "": ("AI7", "channel 4", "Status", "Bremse", "x", "noise"),
}
TIMES = ("time", "Zeit", "t", "temps", "Elapsed time")
UNITS = {
    "command": ("mm", "V", "µm"),
    "displacement": ("mm", "µm", "in", "mm"),
    "force": ("kN", "N"),
    "": ("V", "bar", "°C", "%"),
}
PREAMBLES = (
    "Prüfstand 4",
    "Datum: 12.03.2026",
    "Operator;Meier;;",
    "Date,2026-03-12",
    "Comment\tfirst run",
    "# bench 7",
    "Kommentar: Öl 40 °C",
    "Channels 3",
    "Version 1.2.3",
    "Filter: 1000 Hz",
    "=====",
    "Serial no.;4711",
    '"quoted, line"',
)


@dataclass
class Written:
    """A table: its bytes, the columns that it holds with their names, units and channels, and what it says of time.

    `stated` are the units that stand somewhere in it. `rows` counts whole rows; `cut` is the number of the line that
    was cut off, 0 for none.
    """

    data: bytes = b""
    names: list[str] = field(default_factory=list)
    units: list[str] = field(default_factory=list)
    channels: list[str] = field(default_factory=list)
    values: list[list[float]] = field(default_factory=list)
    time: str = ""
    header: int = 0
    stated: str = ""
    cut: int = 0
    told: str = ""

    def of(self, channel: str) -> int:
        """The number of the column of a channel, or of the time."""
        return self.channels.index(channel)


def drawn(seed: int) -> Written:
    """The table of a seed."""
    of = random.Random(seed)
    made = Written()
    signals = ["command", "displacement", *of.sample(["force", "", ""], of.randint(0, 3))]
    made.time = of.choice(("", "s", "ms", "iso", "s", "ms"))
    made.channels = [*signals, *(["time"] if made.time else [])]
    of.shuffle(made.channels)
    if made.time and of.random() < 0.7:
        made.channels.remove("time")
        made.channels.insert(0, "time")
    made.header = of.choice((0, 1, 1, 1, 1, 2))
    made.stated = of.choice(("", "row", "row", "brackets", "suffix")) if made.header else ""
    if made.header == 2:
        made.stated = "brackets"
    taken: set[str] = set()
    for channel in made.channels:
        names = TIMES if channel == "time" else NAMES[channel]
        made.names.append(next(name for name in of.sample(names, len(names)) if name not in taken))
        taken.add(made.names[-1])
        unit = {"s": "s", "ms": "ms", "iso": "s"}[made.time] if channel == "time" else of.choice(UNITS[channel])
        made.units.append(unit)
    return _as_text(made, of)


def _as_text(made: Written, of: random.Random) -> Written:
    """The table in a form that is drawn: delimiter, decimal sign, digits, what stands above and behind, encoding."""
    delimiter, comma = of.choice(DELIMITERS), of.random() < 0.4
    if made.time == "iso" and delimiter.isspace() and delimiter != "\t":
        delimiter = ";"
    if delimiter == "," and comma and of.random() < 0.8:
        comma = False
    count = of.choice((12, 20, 45))
    texts = [_column(channel, made, of, count) for channel in made.channels]
    made.values = [
        [float(text) for text in column]
        if channel != "time" or made.time != "iso"
        else [n / 1000 for n in range(count)]
        for channel, column in zip(made.channels, texts, strict=True)
    ]
    if comma:
        texts = [[text.replace(".", ",") for text in column] for column in texts]
    quoted = of.random() < 0.1 and not delimiter.isspace()
    tail = delimiter if of.random() < 0.15 and not delimiter.isspace() else ""
    above = [of.choice(PREAMBLES) for _ in range(of.choice((0, 0, 1, 2, 5)))]
    if above and of.random() < 0.5:
        above.append("")
    lines = above + _heading(made, delimiter, quoted, tail, of)
    lines += [delimiter.join(row) + tail for row in zip(*texts, strict=True)]
    if of.random() < 0.1 and len(made.channels) > 1:
        part = of.randint(1, len(made.channels) - 1)
        lines.append(delimiter.join(column[-1] for column in texts[:part]))
        made.cut = len(lines)
    lines += [""] * of.choice((0, 1, 1, 1, 2))
    end, encoding = of.choice(ENDS), of.choice(ENCODINGS)
    made.told = f"{delimiter!r} comma {comma} header {made.header} units {made.stated!r} {encoding} time {made.time!r}"
    made.data = end.join(lines).encode(encoding, "replace")
    return made


def _column(channel: str, made: Written, of: random.Random, count: int) -> list[str]:
    """The samples of a column as text with decimal points."""
    if channel == "time":
        if made.time == "iso":
            between = of.choice("T ")
            return [
                f"2026-03-12{between}09:30:{59 + n // 1000 if n < 1000 else 0:02d}.{n % 1000:03d}" for n in range(count)
            ]
        step, digits = (0.001, of.choice((4, 6))) if made.time == "s" else (1.0, of.choice((0, 3)))
        return [f"{n * step:.{digits}f}" for n in range(count)]
    form = of.choice((".5f", ".3f", ".6g", ".4e", ".2f", "d"))
    size = of.choice((1.0, 30.0, 2000.0))
    return [
        f"{round(of.gauss(0, max(size, 30.0))):d}" if form == "d" else f"{of.gauss(0, size):{form}}"
        for _ in range(count)
    ]


def _heading(made: Written, delimiter: str, quoted: bool, tail: str, of: random.Random) -> list[str]:
    """No line of names, one, one with a row of units, or two that complete each other."""
    if not made.header:
        return []
    names = [name.replace(" ", "_") if delimiter.isspace() and delimiter != "\t" else name for name in made.names]
    if made.stated == "suffix":
        names = [f"{name}_{unit}" for name, unit in zip(names, made.units, strict=True)]
    if made.stated == "brackets" and made.header == 1:
        names = [
            f"{name}{'' if delimiter.isspace() else ' '}[{unit}]" for name, unit in zip(names, made.units, strict=True)
        ]
    made.names = list(names)
    if quoted:
        names = [f'"{name}"' for name in names]
    if made.header == 2:
        split = of.randrange(len(names))
        blank = "-" if delimiter.isspace() and delimiter != "\t" else ""
        upper = [blank if n == split else name for n, name in enumerate(names)]
        lower = [
            f"{name} [{unit}]" if n == split and not blank else name if n == split else f"[{unit}]"
            for n, (name, unit) in enumerate(zip(names, made.units, strict=True))
        ]
        return [delimiter.join(upper) + tail, delimiter.join(lower) + tail]
    rows = [delimiter.join(names) + tail]
    if made.stated == "row":
        wrap = of.choice(("{}", "[{}]", "({})"))
        rows.append(delimiter.join(wrap.format(unit) for unit in made.units) + tail)
    return rows
