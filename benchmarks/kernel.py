"""The compiled simulation of chains with effects: against a C loop written by hand, and against python-control."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path

import control
import numpy as np

from benchmarks.table import Table, seconds_of
from ident.chain.conditions import conditions
from ident.effects import EFFECTS
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import search_space
from ident.matrix import Actuator, Matrix
from ident.presets import Preset, preset
from ident.run import Run, Specimen
from ident.simulation.simulate import Simulation
from tests.reference import nonlinear_reference, qian_reference

THREE = ("dead_zone", "pressure_flow", "quadratic_damping")
STRENGTHS = {"dead_zone.half_width": 2e-4, "pressure_flow.inverse_supply": 2e-7, "quadratic_damping.coefficient": 2e3}
CELL = qian_reference.Cell(0.98, 67.6e3, 0.0, 7.0)
PLANT = qian_reference.Plant()
SAMPLES = 65_536
LANES = 16


def run(samples: int = SAMPLES) -> Run:
    """One run of the paper's matrix, without output."""
    u = qian_reference.band_limited_noise(samples, 1.27e-3, np.random.default_rng(3))
    specimen = Specimen(CELL.mass, CELL.stiffness, CELL.damping)
    channels = {"command": u, "displacement": np.zeros_like(u)}
    return Run("run", "", qian_reference.SAMPLE_RATE, channels, specimen=specimen, gain=CELL.gain)


def simulation(model: Preset, lanes: int, one: Run) -> Simulation:
    """`lanes` equal vectors with the strengths above, one step a sample."""
    known = {p.in_equations: p.value for p in model.parameters} | conditions(one, Actuator("", piston_area=PLANT.A))
    known |= {
        model.parameter(name).in_equations: value for name, value in STRENGTHS.items() if name.split(".")[0] in THREE
    }
    return Simulation(model.chain, (one,), {name: np.full((1, lanes), value) for name, value in known.items()})


def by_hand() -> Callable[[], np.ndarray] | None:
    """The C loop for the same run and vectors, or None without gcc."""
    gcc = shutil.which("gcc")
    if gcc is None:
        return None
    built = Path(tempfile.mkdtemp()) / "chain.so"
    source = Path(__file__).with_name("chain.c")
    options = ("-O3", "-march=native", "-ffast-math", "-shared", "-fPIC")
    subprocess.run([gcc, *options, str(source), "-o", str(built), "-lm"], check=True)
    advance = ctypes.CDLL(str(built)).advance
    u = run().command
    mass = PLANT.m0 + CELL.mass
    values = (
        CELL.gain,
        1 / PLANT.tau,
        PLANT.Z0 / PLANT.A,
        PLANT.Cl,
        PLANT.A,
        1 / PLANT.Ka,
        PLANT.c0,
        CELL.stiffness,
        1 / mass,
        *STRENGTHS.values(),
    )
    pointer = ctypes.POINTER(ctypes.c_double)

    def aligned(count: int) -> np.ndarray:
        raw = np.zeros(count + 8)
        return raw[(-raw.ctypes.data // 8) % 4 :][:count]

    table, states, out = aligned(12 * LANES), aligned(4 * LANES), aligned(len(u) * LANES)
    table[:] = np.repeat(values, LANES)
    ends = np.append(u, u[-1])

    def work() -> np.ndarray:
        states[:] = 0.0
        given = [a.ctypes.data_as(pointer) for a in (table, states, ends)]
        count, step = ctypes.c_long(len(u)), ctypes.c_double(1 / qian_reference.SAMPLE_RATE)
        advance(*given, count, step, out.ctypes.data_as(pointer))
        return out.reshape(-1, LANES)

    return work


def with_control(samples: int) -> Callable[[], np.ndarray]:
    """`control.input_output_response` for one vector and a short run, at the tolerance that the steps reach."""
    h, r, c2 = STRENGTHS.values()
    mass = PLANT.m0 + CELL.mass

    def rates(_t, s, u, _params):
        q, P, v, x = s
        w = q - np.clip(q, -h, h)
        Q = PLANT.Z0 / PLANT.A * w * np.sqrt(max(0.0, 1 - np.sign(w) * P * r))
        force = PLANT.A * P - PLANT.c0 * v - c2 * v * abs(v) - CELL.stiffness * x
        return [(CELL.gain * (u[0] - x) - q) / PLANT.tau, (Q - PLANT.Cl * P - PLANT.A * v) / PLANT.Ka, force / mass, v]

    system = control.NonlinearIOSystem(rates, lambda _t, s, _u, _params: s[3], inputs=1, outputs=1, states=4)
    u = run().command[:samples]
    t = np.arange(samples) / qian_reference.SAMPLE_RATE
    options = {"rtol": 1e-6, "atol": 1e-12, "max_step": 1 / qian_reference.SAMPLE_RATE}
    return lambda: control.input_output_response(system, t, u, 0, solve_ivp_kwargs=options).outputs


def gauss_newton() -> tuple[float, int]:
    """Seconds and evaluations of a polish of eight parameters on 63 runs of 2 s from 3 % beside the truth."""
    hidden = nonlinear_reference.named({"dead_zone.h": 2e-4, "quadratic_damping.c2": 2e3})
    records = nonlinear_reference.measure_all(hidden, qian_reference.trials()[:63], seconds=2.0, noise=0.005, seed=1)
    runs = tuple(
        Run(
            r.trial.id,
            "",
            qian_reference.SAMPLE_RATE,
            {"command": r.command, "displacement": r.displacement},
            specimen=Specimen(r.trial.cell.mass, r.trial.cell.stiffness, r.trial.cell.damping),
            gain=r.trial.cell.gain,
        )
        for r in records
    )
    matrix = Matrix(Actuator("", piston_area=PLANT.A), runs)
    model = preset("qian2014", ("dead_zone", "quadratic_damping"))
    space = search_space(model, matrix, Settings(effects=("dead_zone", "quadratic_damping")), 500.0)
    fitness = SimulatedFitness(model, matrix, runs, 500.0, space)
    truth = PLANT._asdict() | {"dead_zone__half_width": 2e-4, "quadratic_damping__coefficient": 2e3}
    start = space.point({name: value * 1.03 for name, value in truth.items()} | dict(space.fixed))
    fitness.exact(start)  # compiles
    fitness.evaluations, begun = 0, time.perf_counter()
    fitness.optimum(start)
    return time.perf_counter() - begun, fitness.evaluations


def measure() -> Table:
    """Nanoseconds a step and vector on one core, and what they are compared with."""
    one, three, whole = run(), preset("qian2014", THREE), preset("qian2014", tuple(e.name for e in EFFECTS))
    ways = {
        "three effects, program": simulation(three, LANES, one),
        "every effect, program": simulation(whole, LANES, one),
    }
    works: dict[str, Callable[[], object]] = {name: (lambda s=s: deque(s.outputs(), 0)) for name, s in ways.items()}
    c = by_hand()
    if c is not None:
        works["three effects, C by hand"] = c
        agreement = np.std(
            c()[:, 0] - np.concatenate([y for y, _, _ in ways["three effects, program"].outputs()])[:, 0, 0]
        )
        if agreement > 1e-9:
            raise AssertionError(f"the C loop and the kernel differ by {agreement:.1e} m")
    for work in works.values():
        work()
    taken = dict(zip(works, (1e9 * t / SAMPLES / LANES for t in seconds_of(*works.values(), repeats=9)), strict=True))
    short = 512
    slow = with_control(short)
    control_time = 1e9 * seconds_of(slow, repeats=1)[0] / short
    three_time, c_time = taken["three effects, program"], taken.get("three effects, C by hand", np.nan)
    polish_time, evaluations = gauss_newton()
    rows = [(name, f"{value:.1f} ns", f"{value / three_time:.2f}") for name, value in taken.items()]
    rows.append(("three effects, python-control", f"{control_time / 1e3:.0f} µs", f"{control_time / three_time:.0f}"))
    rows.append((f"polish of 8 parameters, 63 runs of 2 s, {evaluations} vectors", f"{polish_time:.2f} s", "–"))
    met = bool(control_time / three_time >= 3000 and polish_time <= 1.5) and not three_time > 1.3 * c_time
    return Table(
        "Simulation with effects",
        f"Runge-Kutta steps, {LANES} vectors side by side on one core, packing included; {SAMPLES} steps. "
        f"Three effects: {', '.join(THREE)}. The C loop has the same equations (gcc -O3 -march=native -ffast-math).",
        ("way", "per step and vector", "times the program's"),
        rows,
        "three effects within 1.3 times the C loop and 3000 times python-control, the polish in 1.5 s",
        met,
    )
