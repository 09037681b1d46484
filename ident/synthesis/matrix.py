"""A simulated test matrix, on disk or in memory: a paper's, for demonstrations, planning and whole installations.

What it writes says that it is simulated. It is no judge of the program itself: data for that come from elsewhere.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import linear_model
from ident.comparison.compare import modelled
from ident.errors import Unusable
from ident.fit.normal_matrices import output
from ident.matrix import Actuator, Matrix
from ident.presets import PRESETS, Preset
from ident.presets import preset as preset_called
from ident.progress import Progress, Report, silent
from ident.run import Run, Specimen
from ident.synthesis.bench_matrix import write_bench

Array = NDArray[np.float64]
SAMPLE_RATE, BAND = 4096.0, 80.0  # Hz (Qian et al. 2014, section 3)
AREA = 4.97e-4  # m²
SPECIMENS = tuple(
    Specimen(mass, stiffness)
    for mass, stiffness in (
        (0, 0),
        (0.87, 0),
        (0.87, 36.3e3),
        (0.98, 67.6e3),
        (1.76, 0),
        (2.67, 0),
        (2.67, 67.6e3),
    )
)  # fmt: skip  Table 3
AMPLITUDES = (0.02, 0.05, 0.1)  # in, RMS
FIT_GAINS, VERIFY_GAIN = (5.0, 7.0, 10.0), 6.0
SMALL_SPECIMENS, SMALL_GAINS = (SPECIMENS[0], SPECIMENS[2], SPECIMENS[5]), (5.0, 10.0)
"""Of a small matrix: nothing, a mass on a spring, a mass; the lowest and the highest gain."""
SIMULATED = "simulated"
"""How the name of every simulated actuator begins."""
_INCH = 0.0254


@dataclass(frozen=True)
class Plan:
    """One run to simulate."""

    specimen: Specimen
    gain: float
    inches: float
    use: str

    @property
    def id(self) -> str:
        """m087-k36-kp7-a05 and the like."""
        s = self.specimen
        return f"m{100 * s.mass:03.0f}-k{s.stiffness / 1e3:.0f}-kp{self.gain:g}-a{100 * self.inches:02.0f}"


def plans(small: bool = False) -> tuple[Plan, ...]:
    """The paper's matrix: 63 runs to fit at Kp 5, 7, 10 and 21 to verify at Kp 6; of a `small` one 18 and 9 of them."""
    specimens = SMALL_SPECIMENS if small else SPECIMENS
    gains = [(gain, "fit") for gain in (SMALL_GAINS if small else FIT_GAINS)] + [(VERIFY_GAIN, "verify")]
    return tuple(Plan(s, gain, inches, use) for gain, use in gains for s in specimens for inches in AMPLITUDES)


def white_noise(length: int, rms: float, rng: np.random.Generator) -> Array:
    """Band-limited white noise, 0 to 80 Hz, of exactly the RMS value asked for."""
    frequency = np.fft.rfftfreq(length, 1 / SAMPLE_RATE)
    used = (frequency > 0) & (frequency <= BAND)
    lines = np.zeros(len(frequency), dtype=complex)
    lines[used] = rng.standard_normal(used.sum()) + 1j * rng.standard_normal(used.sum())
    u = np.fft.irfft(lines, length)
    return np.asarray(u * (rms / np.sqrt(np.mean(u**2))))


@dataclass(frozen=True)
class Simulation:
    """What is simulated: a model of a test matrix, the values of its effects, SI; each run lasts `seconds`.

    `noise` is white, its standard deviation relative to each run's output. Raises Unusable where the model cannot
    follow a test matrix, or a number makes no sense.
    """

    preset: str = "qian2014"
    seconds: float = 30.0
    seed: int = 0
    noise: float = 0.005
    effects: Mapping[str, float] = field(default_factory=dict)
    small: bool = False
    serial: str = "SIM-0001"

    def __post_init__(self) -> None:
        model = self.model
        if model.search.bounds_hold_for != AREA and model.kind != "bench":
            able = [name for name, p in PRESETS.items() if p.search.bounds_hold_for == AREA or p.kind == "bench"]
            remedy = f"use {' or '.join(able)}"
            raise Unusable("cannot-simulate", f"model {model.name} has no test matrix of its own", "simulate", remedy)
        if not (1 / 16 <= self.seconds <= 600 and 0 <= self.noise < 1):
            raise Unusable(
                "bad-value",
                f"{self.seconds:g} s with noise {self.noise:g}",
                "simulate",
                "give 0.0625 to 600 seconds and noise from 0 to below 1",
            )

    @cached_property
    def model(self) -> Preset:
        """The model with its effects."""
        return preset_called(self.preset, tuple(name.partition(".")[0] for name in self.effects))

    @property
    def actuator(self) -> Actuator:
        """The machine, which says that it is simulated."""
        hidden = "".join(f", {name} = {value:g}" for name, value in self.effects.items())
        what = f"seed {self.seed}, noise {self.noise:g} of each output{hidden}"
        notes = f"simulated with the model {self.preset}, {what}; not measured"
        name = f"{SIMULATED}, with hidden effects" if self.effects else SIMULATED
        return Actuator(self.serial, name, piston_area=AREA, notes=notes)

    def runs(self, report: Report) -> Iterator[tuple[Plan, Run]]:
        """Every run with its plan."""
        model = self.model
        values = {parameter.in_equations: parameter.value for parameter in model.parameters}
        values |= {model.parameter(name).in_equations: value for name, value in self.effects.items()}
        todo = plans(self.small)
        for index, plan in enumerate(todo):
            report(Progress("simulate", index, len(todo)))
            rng = np.random.default_rng([self.seed, index])
            u = white_noise(round(self.seconds * SAMPLE_RATE), plan.inches * _INCH, rng)
            still = Run(
                plan.id,
                "",
                SAMPLE_RATE,
                {"command": u, "displacement": np.zeros_like(u)},
                {"command": "m", "displacement": "m"},
                specimen=plan.specimen,
                gain=plan.gain,
                amplitude=plan.inches * _INCH,
                kind="blwn",
                use=plan.use,
            )
            x = _displacement(model, values, still, Actuator(self.serial, piston_area=AREA))
            x = x + self.noise * np.std(x) * rng.standard_normal(len(x))
            yield plan, replace(still, channels={"command": u, "displacement": x})
        report(Progress("simulate", len(todo), len(todo)))


def simulated(simulation: Simulation, report: Report = silent) -> Matrix:
    """The matrix, in memory. Raises Unusable for the set of a bench, which is written to a folder."""
    if simulation.model.kind == "bench":
        raise Unusable(
            "cannot-simulate",
            "the set of a bench is written to a folder",
            "simulate",
            "use `servoident simulate OUT` and read it",
        )
    runs = tuple(run for _, run in simulation.runs(report))
    digest = hashlib.sha256(simulation.actuator.notes.encode())
    for run in runs:
        digest.update(run.measured.tobytes())
    return Matrix(simulation.actuator, runs, digest.hexdigest())


def simulate_matrix(
    out: Path,
    preset: str = "qian2014",
    seconds: float = 30.0,
    seed: int = 0,
    noise: float = 0.005,
    effects: Mapping[str, float] | None = None,
    report: Report = silent,
    serial: str = "SIM-0001",
    small: bool = False,
) -> None:
    """Write the matrix of a :class:`Simulation` to the folder `out`, which must not exist or be empty.

    Raises Unusable where the folder is in use, or a bench is asked for what it has not.
    """
    simulation = Simulation(preset, seconds, seed, noise, effects or {}, small, serial)
    on_bench = simulation.model.kind == "bench"
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise Unusable("folder-in-use", "the folder is not empty", str(out), "name a new one")
    if on_bench and small:
        raise Unusable("bad-option", "the set of a bench has one size", "simulate", "leave --small out")
    if on_bench and effects:
        raise Unusable("effect-does-not-fit", f"the model {preset} takes no effect", "simulate", "leave --effect out")
    (out / "runs").mkdir(parents=True, exist_ok=True)
    if on_bench:
        write_bench(out, simulation.model, seed, noise, report)
        return
    entries = []
    for plan, run in simulation.runs(report):
        np.savez(out / "runs" / f"{plan.id}.npz", command=run.command, displacement=run.measured)
        entries.append(_entry(plan))
    actuator = simulation.actuator
    machine = {"serial": serial, "name": actuator.name, "piston_area": "497 mm^2", "notes": actuator.notes}
    described = yaml.safe_dump({"actuator": machine, "runs": entries}, sort_keys=False)
    (out / "matrix.yaml").write_text(described, encoding="utf-8")


def _displacement(model: Preset, values: Mapping[str, float], run: Run, actuator: Actuator) -> Array:
    if model.effects:
        return modelled(model, values, Matrix(actuator, (run,)))[run.id]
    return output(run, linear_model(model.core, values, run, actuator))


def _entry(plan: Plan) -> dict[str, object]:
    specimen = plan.specimen
    return {
        "id": plan.id,
        "file": f"runs/{plan.id}.npz",
        "sample_rate": f"{SAMPLE_RATE:g} Hz",
        "specimen": {
            "mass": f"{specimen.mass:g} kg",
            "stiffness": f"{specimen.stiffness / 1e3:g} kN/m",
            "damping": "0 N*s/m",
        },
        "gain": plan.gain,
        "amplitude": f"{plan.inches:g} in",
        "kind": "blwn",
        "use": plan.use,
        "channels": {
            "command": {"column": "command", "unit": "m"},
            "displacement": {"column": "displacement", "unit": "m"},
        },
    }
