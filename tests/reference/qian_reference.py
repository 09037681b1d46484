"""The whole servo-hydraulic chain in one flat file: an independent judge of the program under test.

The linear chain of Qian et al. (2014), eqs. (1)-(7) with the position loop closed, written out plainly:

    e = Kp (u - x)                                      controller
    tau q' + q = e                                      valve
    Q = (Z0 / A) q                                      flow
    Ka P' = Q - Cl P - A v                              pressure
    (m0 + mL) v' = A P - (c0 + cL) v - k x              load
    x' = v                                              load; the sensor reads x

Everything is SI. The equations are integrated by fixed-step Dormand-Prince of order 5 with sub-steps between the
samples, and the command between samples is a straight line or held. Nothing here comes from the program's library:
neither equations, nor integrator, nor file writing.

As a script it writes a test matrix:  python qian_reference.py OUT --seconds 30 --noise 0.005 --seed 1 --hold linear
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Samples = NDArray[np.float64]

SAMPLE_RATE = 4096.0  # Hz
INCH = 0.0254  # m
BAND = 80.0  # Hz, upper edge of the command's noise
PARAMETERS = ("Z0", "tau", "Cl", "c0", "m0", "Ka")


class Plant(NamedTuple):
    """The actuator: Table 4 in SI, Z0 in its true unit. An effect would add its strength here, 0 by default."""

    Z0: float = 2.592e-6  # m⁴/s
    tau: float = 3.6e-3  # s
    Cl: float = 1e-11  # m³/(s·Pa)
    c0: float = 3200.0  # N·s/m
    m0: float = 4.25  # kg
    Ka: float = 1.39e-13  # m³/Pa
    A: float = 497e-6  # m²


BOUNDS = {  # Table 2 in SI
    "Z0": (1.751e-6, 3.503e-6),
    "tau": (1e-3, 6e-3),
    "Cl": (2e-12, 2e-11),
    "c0": (800.0, 5000.0),
    "m0": (1.0, 10.0),
    "Ka": (2e-15, 2e-13),
}


class Cell(NamedTuple):
    """What the actuator moves and under which gain: mL (kg), k (N/m), cL (N·s/m), Kp."""

    mass: float
    stiffness: float
    damping: float
    gain: float


class Trial(NamedTuple):
    """One run of the test matrix: its cell, the RMS of its command (m), "fit" or "verify"."""

    cell: Cell
    amplitude: float
    use: str = "fit"

    @property
    def id(self) -> str:
        """A name that holds mass (cg), stiffness (kN/m), gain and amplitude (hundredths of an inch)."""
        mass, stiffness = round(100 * self.cell.mass), int(self.cell.stiffness / 1e3)
        return f"m{mass:03d}-k{stiffness:02d}-kp{self.cell.gain:g}-a{round(100 * self.amplitude / INCH):02d}"


SPECIMENS = ((0, 0), (0.87, 0), (0.87, 36.3e3), (0.98, 67.6e3), (1.76, 0), (2.67, 0), (2.67, 67.6e3))  # Table 3
AMPLITUDES = (0.02 * INCH, 0.05 * INCH, 0.1 * INCH)


def trials(specimens: Sequence[tuple[float, float]] = SPECIMENS, damping: float = 0.0) -> list[Trial]:
    """The paper's matrix: 63 runs at Kp 5, 7, 10 to fit and 21 at Kp 6 to verify."""
    return [
        Trial(Cell(float(mass), float(stiffness), damping, gain), amplitude, use)
        for use, gains in (("fit", (5.0, 7.0, 10.0)), ("verify", (6.0,)))
        for mass, stiffness in specimens
        for gain in gains
        for amplitude in AMPLITUDES
    ]


# ---------------------------------------------------------------------------------------------- the equations

STATES = 4
Q, P, V, X = range(STATES)


@njit(inline="always")
def controller(cell, u, x):  # e (m × dial)
    return cell.gain * (u - x)


@njit(inline="always")
def valve(plant, e, q):  # q'
    return (e - q) / plant.tau


@njit(inline="always")
def flow(plant, q):  # Q (m³/s)
    return plant.Z0 / plant.A * q


@njit(inline="always")
def pressure(plant, Q_load, p, v):  # P' (Pa/s)
    return (Q_load - plant.Cl * p - plant.A * v) / plant.Ka


@njit(inline="always")
def load(plant, cell, p, v, x):  # v' (m/s²)
    force = plant.A * p - (plant.c0 + cell.damping) * v - cell.stiffness * x
    return force / (plant.m0 + cell.mass)


@njit(inline="always")
def derivative(plant, cell, u, state, out):
    e = controller(cell, u, state[X])
    out[Q] = valve(plant, e, state[Q])
    out[P] = pressure(plant, flow(plant, state[Q]), state[P], state[V])
    out[V] = load(plant, cell, state[P], state[V], state[X])
    out[X] = state[V]


@njit(inline="always")
def sensor(state):  # the recorded displacement (m)
    return state[X]


# ---------------------------------------------------------------------------------------------- the integrator

NODES = np.array([0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1])
STAGES = np.array(
    [
        [0, 0, 0, 0, 0],
        [1 / 5, 0, 0, 0, 0],
        [3 / 40, 9 / 40, 0, 0, 0],
        [44 / 45, -56 / 15, 32 / 9, 0, 0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
    ]
)
WEIGHTS = np.array([35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84])


@njit(nogil=True)
def integrate(plant, cell, command, substeps, linear):
    """The sensor's samples, from rest, of a command (n,) in m that is a straight line between samples, or held."""
    state, trial, k = np.zeros(STATES), np.empty(STATES), np.empty((len(NODES), STATES))
    output = np.empty(len(command))
    output[0] = sensor(state)
    h = 1 / (SAMPLE_RATE * substeps)
    for sample in range(len(command) - 1):
        start = command[sample]
        rise = command[sample + 1] - start if linear else 0.0
        for step in range(substeps):
            for stage in range(len(NODES)):
                for i in range(STATES):
                    total = 0.0
                    for earlier in range(stage):
                        total += STAGES[stage, earlier] * k[earlier, i]
                    trial[i] = state[i] + h * total
                derivative(plant, cell, start + rise * (step + NODES[stage]) / substeps, trial, k[stage])
            for i in range(STATES):
                total = 0.0
                for stage in range(len(NODES)):
                    total += WEIGHTS[stage] * k[stage, i]
                state[i] += h * total
        output[sample + 1] = sensor(state)
    return output


def fastest_rate(plant: Plant, cell: Cell) -> float:
    """The largest of the chain's own rates (1/s): valve, leakage, damping, oil column, specimen."""
    mass = plant.m0 + cell.mass
    return max(
        1 / plant.tau,
        plant.Cl / plant.Ka,
        (plant.c0 + cell.damping) / mass,
        np.sqrt((plant.A**2 / plant.Ka + cell.stiffness) / mass),
    )


def simulate(plant: Plant, cell: Cell, command: Samples, hold: str = "linear", step: float = 0.1) -> Samples:
    """Displacement (m) of one run, shape (n,), without noise.

    `step` is the longest sub-step in units of the fastest time constant; 0.1 leaves an error below 1e-9 of the
    output's standard deviation.
    """
    substeps = max(1, int(np.ceil(fastest_rate(plant, cell) / SAMPLE_RATE / step)))
    return integrate(plant, cell, command, substeps, {"linear": True, "zoh": False}[hold])


# ------------------------------------------------------------------------------------------------ the experiment


class Record(NamedTuple):
    """One simulated measurement: command and displacement in m, shape (n,)."""

    trial: Trial
    command: Samples
    displacement: Samples


def band_limited_noise(samples: int, rms: float, rng: np.random.Generator) -> Samples:
    """Gaussian noise of 0-80 Hz with the given RMS, shape (samples,).

    It is cut out of a longer periodic signal: neither the record nor its response is periodic.
    """
    longer = samples + samples // 3 + 64
    spectrum = rng.standard_normal((longer // 2 + 1, 2)) @ np.array([1, 1j])
    frequency = np.fft.rfftfreq(longer, 1 / SAMPLE_RATE)
    spectrum[(frequency > BAND) | (frequency == 0)] = 0
    signal = np.fft.irfft(spectrum, longer)[:samples]
    return signal * (rms / np.sqrt(np.mean(signal**2)))


def measure(
    plant: Plant, trial: Trial, *, seconds: float, noise: float, seed: Sequence[int], hold: str = "linear"
) -> Record:
    """One run with white noise of `noise` times the standard deviation of its own output."""
    rng = np.random.default_rng(list(seed))
    command = band_limited_noise(round(seconds * SAMPLE_RATE), trial.amplitude, rng)
    clean = simulate(plant, trial.cell, command, hold)
    return Record(trial, command, clean + noise * clean.std() * rng.standard_normal(len(clean)))


def measure_all(
    plant: Plant, runs: Sequence[Trial], *, seconds: float, noise: float, seed: int, hold: str = "linear"
) -> list[Record]:
    """Every run of a matrix, each with its own command and noise, on all cores."""

    def one(numbered: tuple[int, Trial]) -> Record:
        number, trial = numbered
        return measure(plant, trial, seconds=seconds, noise=noise, seed=(seed, number), hold=hold)

    with ThreadPoolExecutor() as pool:
        return list(pool.map(one, enumerate(runs)))


def error(record: Record, plant: Plant, hold: str = "linear", step: float = 0.1) -> float:
    """Eq. (17) of one run, in the time domain: std(measured - model) / std(measured)."""
    difference = record.displacement - simulate(plant, record.trial.cell, record.command, hold, step)
    return float(difference.std() / record.displacement.std())


def mean_error(records: Sequence[Record], plant: Plant, hold: str = "linear", step: float = 0.1) -> float:
    """Eq. (17) averaged over runs."""
    with ThreadPoolExecutor() as pool:
        return float(np.mean(list(pool.map(lambda record: error(record, plant, hold, step), records))))


def cramer_rao(
    records: Sequence[Record], plant: Plant, noise: float, hold: str = "linear", names: Sequence[str] = PARAMETERS
) -> dict[str, float]:
    """The smallest standard errors that any unbiased estimate of the named parameters can have, in their SI units.

    White noise of `noise` times each run's output; sensitivities are central differences of the reference itself.
    """

    def information(record: Record) -> NDArray[np.float64]:
        def output(plant: Plant) -> Samples:
            return simulate(plant, record.trial.cell, record.command, hold)

        def slope(name: str) -> Samples:  # per relative change
            value = getattr(plant, name)
            up, down = (output(plant._replace(**{name: value * factor})) for factor in (1 + 1e-4, 1 - 1e-4))
            return (up - down) / 2e-4

        scaled = np.array([slope(name) for name in names]) / (noise * output(plant).std())
        return scaled @ scaled.T

    with ThreadPoolExecutor() as pool:
        total = np.sum(list(pool.map(information, records)), axis=0)
    relative = np.sqrt(np.diag(np.linalg.inv(total)))
    return {name: float(relative[i] * getattr(plant, name)) for i, name in enumerate(names)}


# ------------------------------------------------------------------------------------------------ the matrix folder


def write(out: Path, records: Sequence[Record], hold: str, plant: Plant) -> Path:
    """A matrix folder: matrix.yaml and runs/*.npz with command and displacement in mm."""
    (out / "runs").mkdir(parents=True, exist_ok=True)
    lines = [f"actuator: {{serial: REFERENCE-1, piston_area: {plant.A * 1e6:.10g} mm^2}}", "runs:"]
    for record in records:
        trial, cell = record.trial, record.trial.cell
        np.savez(out / "runs" / f"{trial.id}.npz", command=1e3 * record.command, displacement=1e3 * record.displacement)
        lines += [
            f"  - id: {trial.id}",
            f"    file: runs/{trial.id}.npz",
            f"    sample_rate: {SAMPLE_RATE:g} Hz",
            f"    specimen: {{mass: {cell.mass:g} kg, stiffness: {cell.stiffness / 1e3:g} kN/m, "
            f"damping: {cell.damping:g} N*s/m}}",
            f"    gain: {cell.gain:g}",
            f"    amplitude: {trial.amplitude / INCH:g} in",
            "    kind: blwn",
            f"    hold: {hold}",
            f"    use: {trial.use}",
            "    channels:",
            "      command: {column: command, unit: mm}",
            "      displacement: {column: displacement, unit: mm}",
        ]
    (out / "matrix.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return out


def main() -> None:
    """Write a test matrix from the command line."""
    parser = argparse.ArgumentParser(description="Write a test matrix simulated by the independent reference.")
    parser.add_argument("out", type=Path)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--noise", type=float, default=0.005, help="std of white noise over std of each run's output")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hold", choices=("linear", "zoh"), default="linear")
    options = parser.parse_args()
    plant = Plant()
    records = measure_all(
        plant, trials(), seconds=options.seconds, noise=options.noise, seed=options.seed, hold=options.hold
    )
    write(options.out, records, options.hold, plant)


if __name__ == "__main__":
    main()
