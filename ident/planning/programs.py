"""The programs of runs: the matrix of Qian et al. (2014), and a list of one's own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

from ident.design.excitation import KINDS, RAMP
from ident.errors import Unusable
from ident.planning.signal import AskedRun, Program, Signal
from ident.readers.loop_settings import loop_gain, sample_rate
from ident.readers.strict_yaml import read_yaml
from ident.readers.typed_fields import Fields
from ident.run import USES, Specimen
from ident.synthesis.matrix import BAND, SAMPLE_RATE, plans
from ident.units.quantity import quantity, shown, si_scale, split
from ident.words.nearest import did_you_mean

QIAN = "qian"
SECONDS = 30.0
"""Length of a run where nothing is stated."""
INCH = 0.0254  # m
_MOST_RUNS, _MOST_SECONDS = 1000, 600.0
_LARGEST = 1_000_000  # bytes of a file
_KEYS = (
    "name", "gains", "amplitudes", "specimens", "kinds", "verify", "sample_rate", "seconds", "band", "ramp",
)  # fmt: skip


@dataclass(frozen=True)
class Settings:
    """What is the same for the whole plan: the length of a run (s), its ramps (s, None for 2 % of it), the seed.

    `seconds` of None is what the program states, else 30 s. Raises Unusable for numbers that make no sense.
    """

    seconds: float | None = None
    ramp: float | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        if self.seconds is not None and not 1 / 16 <= self.seconds <= _MOST_SECONDS:
            raise Unusable("bad-value", f"runs of {self.seconds:g} s", "seconds", f"give 0.0625 to {_MOST_SECONDS:g}")
        if self.ramp is not None and not self.ramp > 0:
            raise Unusable("bad-value", f"a ramp of {self.ramp:g} s", "ramp", "give a time above 0")

    def share(self, seconds: float, own: float | None = None) -> float:
        """The share of a record of this length that a ramp takes. Raises Unusable where both take all of it."""
        ramp = self.ramp if self.ramp is not None else own
        if ramp is None:
            return RAMP
        if not 0 < ramp <= seconds / 2:
            raise Unusable(
                "bad-value", f"a ramp of {ramp:g} s in a run of {seconds:g} s", "ramp", "give at most half of the run"
            )
        return ramp / seconds


def qian_program(settings: Settings) -> Program:
    """Table 3 of Qian et al. (2014): 63 runs to fit at Kp 5, 7 and 10, and 21 to verify at Kp 6; noise of 0 to 80 Hz.

    They are the runs that `simulate` makes, :func:`ident.synthesis.matrix.plans`.
    """
    seconds = settings.seconds or SECONDS
    ramp = settings.share(seconds)
    runs = tuple(
        AskedRun(
            plan.id,
            Signal("blwn", plan.inches * INCH, "m", BAND, seconds, SAMPLE_RATE, 1000 * settings.seed + number, ramp),
            "blwn",
            plan.specimen,
            plan.gain,
            plan.use,
        )
        for number, plan in enumerate(plans())
    )
    return Program(QIAN, runs)


def read_program(path: Path | str, settings: Settings) -> Program:
    """The program in a YAML file, see :func:`program_of`. Raises Unusable."""
    path = Path(path)
    if not path.is_file():
        remedy = did_you_mean(str(path), (QIAN, "kononykhin"), "give qian, kononykhin or the path of a YAML file")
        raise Unusable("no-such-program", f"no program {shown(path)!r}", "program", remedy)
    if path.stat().st_size > _LARGEST:
        raise Unusable("too-large", "too long to be a program", str(path), "give a YAML file")
    return program_of(read_yaml(path.read_bytes(), str(path)), settings, path.stem)


def program_of(data: Any, settings: Settings, name: str = "own") -> Program:
    """Every combination of the lists of a description.

        gains: [5, 7, 10]                         # optional, as specimens
        amplitudes: [0.5 mm, 1 mm]                # RMS; volts and per cent for a valve
        specimens: [{mass: 0 kg}, {mass: 0.87 kg, stiffness: 36.3 kN/m}]
        kinds: [blwn, {kind: sine, frequency: 5 Hz}]
        verify: {gains: [6]}                      # further gains, whose runs only verify
        sample_rate: 4096 Hz
        seconds: 30 s
        band: 80 Hz                               # upper edge where a kind states no frequency
        ramp: 0.5 s

    Raises Unusable with the field at fault.
    """
    top = Fields(data, "program", _KEYS)
    rate = sample_rate(top) or SAMPLE_RATE
    band = top.positive("band", "frequency") or min(BAND, 0.4 * rate)
    stated = top.positive("seconds", "time")
    seconds = settings.seconds or stated or SECONDS
    Settings(seconds)
    ramp = settings.share(seconds, top.positive("ramp", "time"))
    gains: list[tuple[float | None, str]] = [(gain, USES[0]) for gain in _gains(top)]
    if "verify" in top:
        gains += [(gain, USES[1]) for gain in _gains(Fields(top.data["verify"], top.place("verify"), ("gains",)))]
    amplitudes = [_amplitude(one, top.place("amplitudes")) for one in _list(top, "amplitudes")]
    specimens = [_specimen(one, top.place("specimens")) for one in _list(top, "specimens", [None])]
    kinds = [_kind(one, top.place("kinds"), band, rate) for one in _list(top, "kinds", ["blwn"])]
    combined = list(product(gains or [(None, USES[0])], specimens, kinds, amplitudes))
    if len(combined) > _MOST_RUNS:
        raise Unusable("too-large", f"{len(combined)} runs", "program", f"ask for at most {_MOST_RUNS}")
    runs = []
    for number, ((gain, use), specimen, (kind, frequency), (size, unit)) in enumerate(combined):
        signal = Signal(kind, size, unit, frequency, seconds, rate, 1000 * settings.seed + number, ramp)
        runs.append(AskedRun(f"{number + 1:03d}-{kind}", signal, KINDS[kind], specimen, gain, use))
    return Program(top.text("name", name), tuple(runs))


def _list(fields: Fields, key: str, otherwise: list[Any] | None = None) -> list[Any]:
    if key not in fields and otherwise is not None:
        return otherwise
    given = fields.need(key, f"list the {key}")
    if not isinstance(given, list) or not given:
        raise Unusable("not-a-list", f"{shown(given)!r} is not a list", fields.place(key), "write [one, another]")
    return given


def _gains(fields: Fields) -> Iterator[float]:
    for one in _list(fields, "gains", []):
        gain = loop_gain(Fields({"gain": one}, fields.place("gains"), ("gain",)))
        if gain is None or gain <= 0:
            raise Unusable("bad-gain", f"{shown(one)!r} is not a gain above 0", fields.place("gains"), "correct it")
        yield gain


def _amplitude(given: Any, where: str) -> tuple[float, str]:
    unit = split(given, where)[1]
    if not unit:
        raise Unusable("missing-unit", f"{shown(given)} has no unit", where, "write 1 mm, or 0.5 V for a valve")
    of = si_scale(unit, where).unit
    size = quantity(given, of, where)
    if size <= 0:
        raise Unusable("not-positive", f"{shown(given)} is not above 0", where, "correct it")
    return size, of


def _specimen(given: Any, where: str) -> Specimen | None:
    if given is None:
        return None
    fields = Fields(given, where, ("mass", "stiffness", "damping"))
    return Specimen(**{key: fields.not_negative(key, key) or 0.0 for key in ("mass", "stiffness", "damping")})


def _kind(given: Any, where: str, band: float, rate: float) -> tuple[str, float]:
    """The signal and its frequency."""
    fields = Fields({"kind": given} if isinstance(given, str) else given, where, ("kind", "frequency"))
    kind = fields.text("kind")
    if kind not in KINDS:
        raise Unusable("unknown-kind", f"{shown(kind)!r} is not a kind of command", where, did_you_mean(kind, KINDS))
    frequency = fields.positive("frequency", "frequency") or band
    if frequency > 0.45 * rate:
        raise Unusable(
            "out-of-range", f"{frequency:g} Hz at {rate:g} samples a second", where, f"give at most {0.45 * rate:g} Hz"
        )
    return kind, frequency
