"""The case of a hybrid simulation: the structure, what of it is physical, the actuator's loop, and the ground motion.

    structure:  {mass: 87.5 kg, stiffness: 87.5 kN/m, damping: 3.5 kN*s/m}
    physical:   {mass: 8.75 kg, stiffness: 17.5 kN/m, damping: 0 N*s/m, storey: 1}   # a list: coupled_reading.py
    gain: 2                     # Kp of the actuator's loop, or 160 V/m where the loop's output is a voltage
    piston_area: 497 mm^2       # where the fit knew one: it is no parameter of the model; so supply_pressure
    ground:     {file: el_centro.txt, unit: g, step: 0.02 s, scale: 1}      # or the record itself: {text: ..., name}
    sample_rate: 4096 Hz        # of the outer loop
    delay: 1                    # samples from a measurement to the command that answers it
    noise:      {displacement: 1 um, force: 1 N, quantisation: {displacement: 1 um, force: 0.1 N}, seed: 0}
    payload:    {mass: 500 kg}  # of a shaking table, instead of structure and physical; band: [0.25 Hz, 30 Hz]
    rig:        {stroke: 152.4 mm, speed: 0.5 m/s}      # limits; where none are stated those of the fit's matrix

A matrix is a list of rows, `{matrix: [[...]], unit: kN/m}` or a list of lists of quantities; a plain list of quantities
is a diagonal; `damping: {ratio: 5 %}` gives every mode that ratio.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.ground_motion import GroundMotion, ground_of
from ident.readers.loop_settings import loop_gain, sample_rate
from ident.readers.rig import rig_of
from ident.readers.strict_yaml import read_yaml
from ident.readers.typed_fields import Fields
from ident.rig.limits import RigLimits
from ident.run import Specimen
from ident.units.quantity import quantity, shown, split
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
_KEYS = (
    "name", "structure", "physical", "gain", "piston_area", "supply_pressure", "ground", "sample_rate", "delay",
    "noise", "rig", "payload", "band",
)  # fmt: skip
_STRUCTURE = ("mass", "stiffness", "damping")
_LARGEST, _STOREYS = 1_000_000, 12
_RESTS = 2.0
"""Periods of the lowest frequency of a shaking table for which it stands still before and after its motion."""
_LATEST = 500
"""Samples: the longest delay of a command; each is a state of the loop whose poles are sought."""
_HUGE = 1e15
"""SI: what is larger is a slip of the pen, and would leave the range of a computer."""


@dataclass(frozen=True)
class Noise:
    """White noise of the sensors (standard deviations, m and N), the steps of their converters (m and N), its seed."""

    displacement: float = 0.0
    force: float = 0.0
    displacement_step: float = 0.0
    force_step: float = 0.0
    seed: int = 0


@dataclass(frozen=True, eq=False)
class Case:
    """One hybrid simulation, SI.

    M x'' + C x' + K x = −M ι a(t) is the whole structure: `mass`, `stiffness`, `damping` (n, n) hold its physical part
    too, x its displacements against the ground; ι says which of them the ground moves, all where `direction` is None.
    `physical` is that part: mass, spring and damper between the ground and storey `place` (0 is the lowest), which the
    actuator moves. `gain` is Kp of the actuator's loop, in V/m where its output is a voltage; `delay` the samples from
    a measurement to the command that answers it, at least 1. Where `table` has a band (Hz), nothing is left to the
    computer: the actuator is a shaking table that gives its payload the acceleration of `ground` in that band.

    Raises Unusable where the matrices do not go together.
    """

    name: str
    mass: Array
    stiffness: Array
    damping: Array
    physical: Specimen
    place: int = 0
    gain: float = 1.0
    piston_area: float | None = None
    supply_pressure: float | None = None
    ground: GroundMotion = field(default_factory=GroundMotion)
    sample_rate: float = 4096.0
    delay: int = 1
    noise: Noise = field(default_factory=Noise)
    rig: RigLimits | None = None
    direction: Array | None = None
    table: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        n = len(self.mass)
        for what in _STRUCTURE:
            given: Array = getattr(self, what)
            if given.shape != (n, n) or not 1 <= n <= _STOREYS or not np.allclose(given, given.T, rtol=1e-6):
                raise Unusable(
                    "bad-case",
                    f"{what} is not a symmetric matrix of {n} rows",
                    "structure",
                    f"give three symmetric matrices of one size, at most {_STOREYS}",
                )
        parts = (
            self.mass,
            self.stiffness,
            self.damping,
            *vars(self.physical).values(),
            self.gain,
            self.piston_area or 0.0,
        )
        if not all(np.all(np.abs(part) <= _HUGE) for part in parts):
            raise Unusable("bad-case", f"a number is larger than {_HUGE:g}", "case", "correct it")
        if self.piston_area is not None and not self.piston_area * _HUGE >= 1:
            raise Unusable("bad-case", f"a piston of {self.piston_area:g} m^2", "piston_area", "correct it")
        if not 0 <= self.place < n:
            raise Unusable("bad-case", f"storey {self.place + 1} of {n}", "physical", f"give a storey from 1 to {n}")
        if np.linalg.eigvalsh(self.stiffness).min() < -1e-9 * np.abs(self.stiffness).max():
            raise Unusable(
                "bad-case",
                "the structure is not stable without the specimen",
                "structure stiffness",
                "correct its stiffness",
            )
        if not 1 <= self.delay <= _LATEST:
            raise Unusable(
                "bad-case",
                f"a delay of {self.delay:.6g} samples",
                "delay",
                f"give 1, with which the command is computed before it acts, to {_LATEST}",
            )
        if self.sample_rate <= 0 or self.gain <= 0:
            raise Unusable("bad-case", "sample rate and gain are above 0", "case", "correct them")

    @property
    def storeys(self) -> int:
        """The number n of degrees of freedom."""
        return len(self.mass)

    @property
    def cases(self) -> tuple[Case, ...]:
        """Itself, as a case of several actuators has one of each."""
        return (self,)

    @property
    def places(self) -> tuple[int, ...]:
        """The storey that is moved, as a case of several actuators has them."""
        return (self.place,)

    @property
    def influence(self) -> Array:
        """ι: how far each degree of freedom goes with the ground, (n,)."""
        return np.ones(self.storeys) if self.direction is None else self.direction

    @property
    def numerical_mass(self) -> Array:
        """The mass that is left to the computer, (n, n)."""
        return self._less(self.mass, self.physical.mass)

    @property
    def numerical_stiffness(self) -> Array:
        """The stiffness that is left to the computer, (n, n)."""
        return self._less(self.stiffness, self.physical.stiffness)

    @property
    def numerical_damping(self) -> Array:
        """The damping that is left to the computer, (n, n)."""
        return self._less(self.damping, self.physical.damping)

    def _less(self, whole: Array, physical: float) -> Array:
        left = whole.copy()
        left[self.place, self.place] -= physical
        return left

    def with_isolator(self, isolator: Specimen) -> Case:
        """The case whose specimen has an isolator on it: in the laboratory, and in the whole structure."""
        self.not_a_table("isolator")
        own = self.physical
        both = Specimen(*(getattr(own, name) + getattr(isolator, name) for name in ("mass", "stiffness", "damping")))
        return replace(self.with_added(isolator, self.place), physical=both)

    def with_added(self, specimen: Specimen, place: int) -> Case:
        """The case whose whole structure has a specimen more at a place, which is not this actuator's."""
        whole = {name: getattr(self, name).copy() for name in _STRUCTURE}
        for name, matrix_ in whole.items():
            matrix_[place, place] += getattr(specimen, name)
        return replace(self, mass=whole["mass"], stiffness=whole["stiffness"], damping=whole["damping"])

    def not_a_table(self, what: str) -> None:
        """Raise Unusable for what belongs to a structure."""
        if self.table is not None:
            raise Unusable("bad-option", f"a shaking table has no {what}", what, "leave it out")

    def with_shares(self, mass: float, stiffness: float) -> Case:
        """The case with these shares (0 to 1) of the storey's mass and stiffness in the specimen, its damper as is."""
        m, k = (float(whole[self.place, self.place]) for whole in (self.mass, self.stiffness))
        return replace(self, physical=replace(self.physical, mass=mass * m, stiffness=stiffness * k))

    def with_ground(self, given: Path | str) -> Case:
        """The case with another motion: `blwn`, `sine`, the text file of a record, or a YAML file with `ground` keys.

        A record has the unit and step of the case's own ground (g and 0.02 s where that states none).
        """
        path = Path(given)
        if str(given) in ("blwn", "sine"):
            return replace(self, ground=replace(self.ground, kind=str(given)))
        if path.suffix.lower() in (".yaml", ".yml"):
            return replace(self, ground=ground_of(yaml_in(path), path.parent, self.ground))
        return replace(self, ground=replace(self.ground, kind="record", file=str(path)))


# Built in ---------------------------------------------------------------------------------------------------------


def qian() -> Case:
    """Qian et al. 2014, section 5.2: one storey, 10 % of its mass and 20 % of its stiffness physical, Kp = 2."""
    return Case(
        name="qian",
        mass=np.array([[87.5]]),
        stiffness=np.array([[87.5e3]]),
        damping=np.array([[3.5e3]]),
        physical=Specimen(mass=8.75, stiffness=17.5e3),
        gain=2.0,
        piston_area=4.97e-4,
    )


def benchmark2020(number: int = 1) -> Case:
    """Case `number` (1 to 4) of the benchmark problem of 2020: three storeys, a frame behind the lowest.

    C. E. Silva, D. Gomez, A. Maghareh, S. J. Dyke, B. F. Spencer: Benchmark control problem for real-time hybrid
    simulation. Mechanical Systems and Signal Processing 135 (2020) 106381.
    """
    m, ratio = ((1000.0, 0.05), (1100.0, 0.04), (1300.0, 0.03), (1000.0, 0.03))[number - 1]
    mass = m * np.eye(3)
    stiffness = 1e7 * np.array([[2.6055, -2.3134, 0.5937], [-2.3134, 3.2561, -1.4420], [0.5937, -1.4420, 0.9267]])
    frame, spring = 29.13, 1190e3
    return Case(
        name="benchmark2020" if number == 1 else f"benchmark2020-{number}",
        mass=mass,
        stiffness=stiffness,
        damping=modal_damping(mass, stiffness, ratio),
        physical=Specimen(frame, spring, 2 * 0.0097 * float(np.sqrt(spring * frame))),
        ground=GroundMotion(scale=0.4),
        noise=Noise(displacement=1e-6),
    )


BUILT_IN: Mapping[str, Callable[[], Case]] = {
    "qian": qian,
    "benchmark2020": benchmark2020,
    **{f"benchmark2020-{number}": partial(benchmark2020, number) for number in (1, 2, 3, 4)},
}


def modal_damping(mass: Array, stiffness: Array, ratio: float) -> Array:
    """C with which every mode has the damping ratio ζ: C = M Φ diag(2 ζ ω) Φᵀ M, where Φᵀ M Φ = 1, (n, n)."""
    try:
        squares, modes = scipy.linalg.eigh(stiffness, mass)
    except (scipy.linalg.LinAlgError, ValueError):  # a mass that is none, or numbers beyond a computer's
        squares, modes = np.zeros(1), np.zeros((1, 1))
    if not squares.min() > 0:
        raise Unusable(
            "bad-case", "the structure is not stable without the specimen", "structure", "correct its stiffness"
        )
    shape = mass @ modes
    return np.asarray(shape @ np.diag(2 * ratio * np.sqrt(squares)) @ shape.T)


NAMES = "qian, benchmark2020 (or benchmark2020-1 to -4)"
"""The cases by name, in words."""

Described = TypeVar("Described")
"""What a description is read as."""

# Reading ----------------------------------------------------------------------------------------------------------


def read_case(given: str | Path) -> Case:
    """A case by its name (see :data:`BUILT_IN`) or from a YAML file. Raises Unusable with the field at fault."""
    return called_or_read(given, case_of)


def called_or_read(given: str | Path, of: Callable[[Any, Path, str], Described]) -> Case | Described:
    """The built-in case of that name, or what a function makes `of` the description in a file. Raises Unusable."""
    if str(given) in BUILT_IN:
        return BUILT_IN[str(given)]()
    path = Path(given)
    if not path.is_file():
        remedy = did_you_mean(str(given), BUILT_IN, f"give {NAMES} or a YAML file")
        raise Unusable("no-such-case", f"no case {shown(given)!r}", "case", remedy)
    return of(yaml_in(path), path.parent, path.stem)


def yaml_in(path: Path) -> Any:
    """The description in a file. Raises Unusable."""
    if not path.is_file():
        raise Unusable("no-such-file", "the file does not exist", str(path), "give its path")
    text = path.read_bytes()
    if len(text) > _LARGEST:
        raise Unusable("too-large", "too long to be a description", str(path), "give a YAML file")
    return read_yaml(text, str(path))


def case_of(data: Any, base: Path | None = Path(), name: str = "case") -> Case:
    """The case of a description (see the module); `base` is the folder of its files, without one it may name none.

    Raises Unusable with the field at fault.
    """
    found = _case_of(data, base, name)
    if found.table is not None:
        return found
    # A substructure without mass has no motion of its own to integrate.
    if np.linalg.eigvalsh(found.numerical_mass).min() <= 0:
        raise Unusable("bad-case", "no mass is left in the numerical part", "physical mass", "give less of it")
    return found


def _case_of(data: Any, base: Path | None, name: str) -> Case:
    if isinstance(data, Mapping) and isinstance(data.get("physical"), list):
        raise Unusable("several-parts", "the case has several parts", "physical", "name the one that is meant")
    top = Fields(data, "case", _KEYS)
    if "payload" in top:
        return _table_of(top, base, name)
    structure = Fields(top.need("structure", "give mass, stiffness, damping"), "structure", (*_STRUCTURE, "direction"))
    mass = matrix(structure, "mass", "mass")
    stiffness = matrix(structure, "stiffness", "stiffness")
    physical, place = _physical(top, mass, stiffness)
    return Case(
        mass=mass,
        stiffness=stiffness,
        damping=_damping(structure, mass, stiffness),
        physical=physical,
        place=place,
        direction=_direction(structure, len(mass)),
        **_loop(top, base, name, GroundMotion()),
    )


def _loop(top: Fields, base: Path | None, name: str, motion: GroundMotion) -> dict[str, Any]:
    """What a case states of its loop, whatever is moved."""
    rate, gain = sample_rate(top), loop_gain(top)
    return {
        "name": top.text("name", name),
        "gain": 1.0 if gain is None else gain,
        "piston_area": top.positive("piston_area", "area"),
        "supply_pressure": top.positive("supply_pressure", "pressure"),
        "ground": ground_of(top.data["ground"], base, motion) if "ground" in top else motion,
        "sample_rate": 4096.0 if rate is None else rate,
        "delay": top.whole("delay", 1),
        "noise": _noise(top.data["noise"]) if "noise" in top else Noise(),
        "rig": rig_of(top.data["rig"]) if "rig" in top else None,
    }


def _table_of(top: Fields, base: Path | None, name: str) -> Case:
    """A shaking table with its payload, in a band of 0.25 to 30 Hz where none is stated."""
    if strange := [key for key in ("structure", "physical", "specimen") if key in top]:
        raise Unusable("bad-case", f"a shaking table has no {strange[0]}", "payload", f"leave {strange[0]} out")
    fields = Fields(top.data["payload"], "payload", _STRUCTURE)
    payload = Specimen(**{key: fields.not_negative(key, key) or 0.0 for key in _STRUCTURE})
    ends = top.pair("band") or ("0.25 Hz", "30 Hz")
    both = Fields({"from": ends[0], "to": ends[1]}, "band", ("from", "to"))
    lowest, highest = both.positive("from", "frequency") or 0.0, both.positive("to", "frequency") or 0.0
    found = _loop(top, base, name, GroundMotion(rest=_RESTS / lowest))
    if not 4 * lowest <= highest <= found["sample_rate"] / 5:
        raise Unusable(
            "bad-case",
            f"a band of {lowest:g} to {highest:g} Hz",
            "band",
            f"give two octaves at least, up to {found['sample_rate'] / 5:g} Hz",
        )
    one = np.ones((1, 1))
    return Case(mass=one, stiffness=0 * one, damping=0 * one, physical=payload, table=(lowest, highest), **found)


def _direction(structure: Fields, count: int) -> Array | None:
    """How far each degree of freedom goes with the ground, (n,); None where nothing is stated: all alike."""
    if "direction" not in structure:
        return None
    given = structure.data["direction"]
    numbers = [one for one in given if isinstance(one, int | float)] if isinstance(given, list) else []
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise Unusable(
            "bad-case", "not one number for each degree of freedom", "structure direction", f"give {count} numbers"
        )
    return np.array(numbers, dtype=float)


def matrix(fields: Fields, key: str, dimension: str) -> Array:
    """A number, a diagonal or a matrix with units, (n, n)."""
    value, where = fields.need(key, f"give the structure's {key}"), fields.place(key)
    unit = ""
    if isinstance(value, Mapping):
        inside = Fields(value, where, ("matrix", "unit"))
        value, unit = inside.need("matrix", "give its rows"), inside.text("unit")
    rows = value if isinstance(value, list) else [[value]]
    if not all(isinstance(row, list) for row in rows):
        rows = [
            [entry if i == j else f"0 {unit or _unit(entry)}" for j in range(len(rows))] for i, entry in enumerate(rows)
        ]
    if not rows or len(rows) > _STOREYS or any(len(row) != len(rows) for row in rows):
        raise Unusable("bad-case", "no square matrix", where, f"give as many rows as columns, at most {_STOREYS}")
    return np.array([[quantity(_with(entry, unit), dimension, where) for entry in row] for row in rows])


def _unit(entry: object) -> str:
    return split(entry, "structure")[1] or "1"


def _with(entry: object, unit: str) -> object:
    """A bare number with the matrix's unit."""
    return f"{entry} {unit}" if unit and not split(entry, "structure")[1] else entry


def _damping(structure: Fields, mass: Array, stiffness: Array) -> Array:
    value = structure.need("damping", "give the structure's damping, or {ratio: 5 %}")
    if isinstance(value, Mapping) and "ratio" in value:
        ratio = Fields(value, "structure damping", ("ratio",)).number("ratio") or 0.0
        return modal_damping(mass, stiffness, ratio)
    return matrix(structure, "damping", "damping")


def _physical(top: Fields, mass: Array, stiffness: Array) -> tuple[Specimen, int]:
    fields = Fields(
        top.need("physical", "give the part that stands in the laboratory"),
        "physical",
        ("mass", "stiffness", "damping", "storey"),
    )
    place = fields.whole("storey", 1) - 1
    if not 0 <= place < len(mass):
        raise Unusable("bad-case", f"storey {place + 1} of {len(mass)}", "physical storey", "count from 1, the lowest")
    whole = {"mass": mass[place, place], "stiffness": stiffness[place, place]}
    parts = {key: _part(fields, key, whole.get(key)) for key in ("mass", "stiffness", "damping")}
    return Specimen(**parts), place


def _part(fields: Fields, key: str, whole: float | None) -> float:
    """A quantity, or a share of the storey's own in per cent."""
    value = fields.data.get(key)
    if value is not None and whole is not None and split(value, fields.place(key))[1] in ("%", "percent"):
        return float(whole) * quantity(value, "1", fields.place(key))
    found = fields.not_negative(key, key)
    return 0.0 if found is None else found


def _noise(data: Any) -> Noise:
    fields = Fields(data, "noise", ("displacement", "force", "quantisation", "seed"))
    step = Fields(fields.data.get("quantisation") or {}, "noise quantisation", ("displacement", "force"))
    return Noise(
        displacement=fields.not_negative("displacement", "length") or 0.0,
        force=fields.not_negative("force", "force") or 0.0,
        displacement_step=step.not_negative("displacement", "length") or 0.0,
        force_step=step.not_negative("force", "force") or 0.0,
        seed=fields.whole("seed"),
    )
