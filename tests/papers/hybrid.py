"""The hybrid-simulation paper: the fifth-order rig, its inverse, hybrid simulation, the tracking filter."""

from __future__ import annotations

import tempfile
import time
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import scipy.integrate

from ident.fit.settings import Settings
from ident.hybrid.case import qian
from ident.hybrid.compensation import Compensation
from ident.hybrid.controller_lookup import controller_called
from ident.hybrid.feedforward import command
from ident.hybrid.feedforward_tracking import followed_in
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.machine import machine
from ident.hybrid.specimen_effects import reference_of
from ident.hybrid.tracked_run import track
from ident.hybrid.tracking import Tracker
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.presets.rig_test import TESTS
from ident.readers import read_matrix
from ident.run import Run, Specimen
from ident.synthesis.rig_matrix import write_rig_matrix
from ident.workflows import compare, identify
from tests.fit import rig
from tests.hybrid import test_feedforward as inverse
from tests.hybrid import test_shaking_table as table
from tests.hybrid import test_specimen_effects as hysteretic
from tests.hybrid.cases import el_centro, fitted, of_fifth_order, of_qian
from tests.hybrid.test_hybrid_simulation import shaped
from tests.papers import data
from tests.papers.row import Measured, Row, counted
from tests.reference import first_order_reference as lag
from tests.reference import qian_reference
from tests.reference import strano_reference as strano

CRANE = Path(__file__).resolve().parents[3] / "shared" / "data" / "crane_lift"
"""A public record; without it the row says what the flat rig shows."""
FIT = fitted()
FEW = {"population": 16.0, "generations": 3.0, "elite": 3.0}


def fifth_order() -> tuple[Measured, ...]:
    _, fit = data.fifth_order()
    true = rig.truth(rig.machine(0))
    off = {name: abs(one.value / true[name] - 1) for name, one in fit.parameters.items() if name != "mu"}
    worst = max(off, key=lambda name: off[name])
    return (
        counted("parameters found", len(off), 13),
        Measured(f"furthest from the truth, {worst}", 100 * off[worst], "%", 5.0),
    )


def measured_inputs() -> tuple[Measured, ...]:
    """The vertical load tells two frictions apart; the supply is taken sample by sample."""
    truth, n = strano.Machine(), round(4.0 * strano.RATE)
    load = np.where(np.sin(np.arange(n) / strano.RATE * 4.0) > 0, 5e5, 1e5)
    matrix = rig.matrix(truth, 3, ("displacement", "load_pressure"), seconds=4.0, vertical=load)
    known = {name: value for name, value in truth._asdict().items() if name not in ("Fc", "mu", "sigma")}
    fit = identify(matrix, Settings(model="strano", fixed=known, seed=1, options=FEW))
    off = [abs(fit.values[name] / truth._asdict()[name] - 1) for name in ("Fc", "mu")]
    r = strano.motion(4.0, seed=2)
    drooping = strano.SUPPLY * (1.0 - 0.5 * np.clip(np.sin(np.arange(len(r)) / strano.RATE * 3.0), 0.0, 1.0))
    shown = strano.respond(truth, r, gain=rig.GAIN, supply=drooping)
    errors = []
    for supply in (drooping, np.full(len(r), drooping.mean())):
        channels = {"command": r, "displacement": shown.displacement, "supply_pressure": supply}
        run = Run("run", "", strano.RATE, channels, rig.UNITS, gain=rig.GAIN)
        held = Matrix(Actuator("RIG", piston_area=strano.AREA), (run,))
        errors.append(identify(held, Settings(model="strano", fixed=truth._asdict())).error["fit"] or np.nan)
    return (
        Measured("friction of the table and of the vertical load, furthest", 100 * max(off), "%", 10.0),
        Measured("error with the measured supply", 100 * errors[0], "%", 0.1),
        Measured("with its mean alone", 100 * errors[1], "%", None, 1.0),
        *(recorded_supply() if CRANE.is_dir() else ()),
    )


def recorded_supply() -> tuple[Measured, ...]:
    """The lift cylinder of a forestry crane whose pump pressure was recorded, and the same machine under its mean."""
    matrix = read_matrix(CRANE)
    fit = identify(matrix, Settings(model="strano"))
    run = matrix.runs[0]
    supply = run.channels["supply_pressure"]
    mean = replace(run, channels={**run.channels, "supply_pressure": np.full(len(supply), supply.mean())})
    other = compare(replace(matrix, runs=(mean,)), fit)
    return (
        Measured("free run on a public record with its pump pressure", 100 * (fit.error["fit"] or np.nan), "%", 2.0),
        Measured("of the same machine under the mean of it", 100 * (other.error["fit"] or np.nan), "%"),
    )


def validated() -> tuple[Measured, ...]:
    _, fit = data.fifth_order()
    other = rig.matrix(rig.machine(0), 1, rig.ALL)
    error, floor = compare(other, fit).error["fit"] or np.nan, fit.error["fit"] or np.nan
    return (Measured("error of a record that no fit saw over that of the fitted one", error / floor, "", 1.05),)


@cache
def leaking(Cl: float = 3e-11) -> Matrix:
    """The rig without dry friction, with a laminar leak, by SciPy; 1 s at 1 kHz."""
    of, r = strano.Machine(Fc=0.0, mu=0.0), strano.motion(1.0, seed=4)
    times = np.arange(len(r)) / strano.RATE

    def rates(t: float, state: np.ndarray) -> list[float]:
        ve, dve, P, v, x = state
        u = rig.GAIN * (np.interp(t, times, r) - x)
        vc = of.ve0 + (of.kep if u >= 0 else of.ken) * u
        above, below = max(ve - of.vep, 0.0) * of.kqp, min(ve - of.ven, 0.0) * of.kqn
        Q = above * np.sqrt(max(strano.SUPPLY - P, 0.0)) + below * np.sqrt(max(strano.SUPPLY + P, 0.0))
        return [
            dve,
            of.wn**2 * (vc - ve) - 2 * of.xi * of.wn * dve,
            (Q - strano.AREA * v - Cl * P) / of.C,
            (strano.AREA * P - of.sigma * v) / of.m,
            v,
        ]

    found = scipy.integrate.solve_ivp(
        rates, (0, times[-1]), [of.ve0, 0, 0, 0, 0], "LSODA", times, rtol=1e-8, atol=1e-10, max_step=1 / strano.RATE
    ).y
    rng = np.random.default_rng(741)
    noise = rng.standard_normal((2, len(r)))
    channels = {"command": r, "displacement": found[4] + 1e-5 * noise[0], "load_pressure": found[2] + 1e4 * noise[1]}
    units = {"command": "m", "displacement": "m", "load_pressure": "Pa"}
    run = Run("leak", "", strano.RATE, channels, units, gain=rig.GAIN, output="displacement")
    actuator = Actuator("RIG", piston_area=strano.AREA, supply_pressure=strano.SUPPLY)
    return Matrix(actuator, run.of_outputs(("displacement", "load_pressure")))


LEAK = {
    "name": "laminar_leak",
    "place": "pressure",
    "equation": "L = L + cl * P",
    "meaning": "leakage of the piston",
    "strength": {"symbol": "cl", "unit": "m^3/(s*Pa)", "lower": "0 m^3/(s*Pa)", "upper": "1e-9 m^3/(s*Pa)"},
}


def hypothesis_d() -> tuple[Measured, ...]:
    known = strano.Machine(Fc=1e-3, mu=1e-9)._asdict()  # a model takes no 0
    without = identify(leaking(), Settings(model="strano", fixed=known))
    with_leak = identify(leaking(), model="strano", fixed=known, custom=[LEAK], effects=["laminar_leak"])
    (found,) = (one.value for name, one in with_leak.parameters.items() if name.startswith("laminar_leak"))
    return (
        Measured("error without a leak", 100 * (without.error["fit"] or np.nan), "%"),
        Measured(
            "error with a leak as an own effect, over that without",
            (with_leak.error["fit"] or np.nan) / (without.error["fit"] or np.nan),
            "",
            0.5,
        ),
        Measured("leak found off by", 100 * abs(found / 3e-11 - 1), "%", 5.0),
    )


def feedforward() -> tuple[Measured, ...]:
    r = inverse.sine()
    ratios = [
        inverse.left(command(inverse.plant(gain), r, inverse.RATE), r, gain) / inverse.left(r, r, gain)
        for gain in (50.0, 0.5 * inverse.limit())
    ]
    return (Measured("error with the inverse over that of the feedback, on the flat rig", max(ratios), "", 0.05),)


def gain_limit() -> tuple[Measured, ...]:
    machine_, t = inverse.MACHINE._replace(Fc=0.0, mu=0.0), np.arange(3000) / inverse.RATE
    drift = 1e-3 * np.maximum(t - 0.05, 0.0)
    swing = [
        float(np.std(strano.respond(machine_, drift, gain=share * inverse.limit(), fine=20).velocity[-500:]))
        for share in (0.7, 1.3)
    ]
    return (
        Measured("limit", inverse.limit(), "V/m"),
        Measured("speed of the flat rig at 0.7 of it, about a drift", swing[0], "m/s", 1e-5),
        Measured("at 1.3", swing[1], "m/s", None, 1e-3),
    )


def unknown_force() -> tuple[Measured, ...]:
    case, isolator, fit = of_fifth_order(2.0), Specimen(0.0, 1e6, 0.0), fitted("strano")
    known, unknown = followed_in(fit, case), followed_in(fit, case, isolator=isolator)
    r = inverse.sine()
    given, spring = command(inverse.plant(100.0), r, inverse.RATE), inverse.ISOLATOR
    flat = inverse.left(given, r, 100.0, spring) / inverse.left(r, r, 100.0, spring)
    return (
        Measured(
            "error with an isolator that the model does not know over that without",
            unknown.both_rms / known.both_rms,
            "",
            None,
            3.0,
        ),
        Measured("over that of the feedback alone", unknown.both_rms / unknown.feedback_rms, "", 0.2),
        Measured("the same on the flat rig with a spring of 1 MN/m", flat, "", 0.1),
    )


def hysteresis() -> tuple[Measured, ...]:
    """The reference with Bouc and Wen's element against a perfect rig that is written out."""
    case, rate = of_qian(3.0), hysteretic.RATE
    ground = case.ground.samples(rate)
    x = v = z = 0.0
    shown, h = np.zeros(len(ground)), 1 / rate / 8
    for j in range(len(ground) - 1):
        shown[j] = x
        for i in range(8):
            a = ground[j] + (ground[j + 1] - ground[j]) * (i + 0.5) / 8
            middle = x + 0.5 * h * v
            z += h * hysteretic.bouc_wen(z, v)
            v += h * (-87.5 * a - 3.5e3 * v - 70e3 * middle - 17.5e3 * middle - hysteretic.YIELD * z) / 87.5
            x += h * v
    shown[-1] = x
    found = reference_of(machine(FIT, case, hysteretic.ON), case, ground)
    off = float(np.sqrt(np.mean((shown - found) ** 2) / np.mean(found**2)))
    helped = simulate_hybrid(FIT, case, shaped("two-degree"), hysteretic.ON)
    assert helped.scores is not None
    return (
        Measured("a perfect rig against the reference", 100 * off, "%", 0.1),
        Measured(
            "reference_rms of an actuator with two degrees of freedom", 100 * helped.scores.reference_rms, "%", 1.0
        ),
    )


def filtered(loops: tuple[lag.Loop, ...], seconds: float) -> tuple[Tracker, np.ndarray]:
    """Estimates over a record of loops, 1 Hz, 0.05 m, with the paper's sensor."""
    t = lag.times(seconds)
    y = lag.response(t, loops) + lag.SENSOR * np.random.default_rng(7).standard_normal(len(t))
    tracker = Tracker(lag.SAMPLE_RATE, "linear", 2 * loops[0].tau, 0.5)
    return tracker, tracker.block(lag.reference(t), y)


def extended_kalman_filter() -> tuple[Measured, ...]:
    first, second = lag.Loop(21e-3, 0.97), lag.Loop(14e-3, 1.05, 5.0)
    tracker, rows = filtered((first, second), 9.0)
    at = [rows[int(t * lag.SAMPLE_RATE)][:2] / one[:2] - 1 for t, one in ((4.9, first), (8.9, second))]
    return (
        Measured("τyr and kyr before and after a step, furthest", 100 * float(np.abs(at).max()), "%", 2.0),
        Measured("mean normalised innovation squared", float(rows[4096:, 5].mean()), "", 1.05, 0.95),
        counted("the step is noticed", int(tracker.verdict.changes >= 1), 1),
    )


def figure_7() -> tuple[Measured, ...]:
    inside = []
    for seed in range(60):
        drawn = lag.trial(seed, 3.0)
        rows = Tracker(lag.SAMPLE_RATE, "linear", drawn.tau0, drawn.gain0).block(drawn.r, drawn.y)
        away = np.abs(rows[-1, :2] - drawn.loop[:2]) / np.sqrt(rows[-1, 3:5])
        inside.extend((away < 3.0).tolist())
    return (
        Measured(
            "estimates within three stated deviations, 60 drawn loops", 100 * float(np.mean(inside)), "%", None, 97.0
        ),
    )


def real_time() -> tuple[Measured, ...]:
    drawn, tracker = lag.trial(1, 4.0), Tracker(lag.SAMPLE_RATE)
    tracker.block(drawn.r[:32], drawn.y[:32])
    begun = time.process_time()
    for k in range(32, len(drawn.r), 32):
        tracker.block(drawn.r[k : k + 32], drawn.y[k : k + 32])
    taken = (time.process_time() - begun) / 4.0
    return (Measured("processor time for a second of samples at 4096 Hz", 1e3 * taken, "ms", 1000.0),)


def not_first_order() -> tuple[Measured, ...]:
    trial = qian_reference.trials()[0]
    record = qian_reference.measure(qian_reference.Plant(), trial, seconds=4.0, noise=0.005, seed=(0,))
    run = Run("blwn", "", 4096.0, {"command": record.command, "displacement": record.displacement})
    true = inverse_of_lag()
    return (
        counted("a chain of fourth order is said not to be a lag", int(not track(run).verdict.holds), 1),
        counted("a lag is said to be one", int(track(true).verdict.holds), 1),
    )


def inverse_of_lag() -> Run:
    """A run of a lag of 8 ms, 1 Hz and 4 Hz."""
    t, sines = lag.times(4.0), (lag.Sine(), lag.Sine(0.01, 4.0, 1.0))
    y = lag.response(t, (lag.Loop(8e-3, 0.9),), sines) + lag.SENSOR * np.random.default_rng(0).standard_normal(len(t))
    return Run("sine", "", lag.SAMPLE_RATE, {"command": lag.reference(t, sines), "displacement": y})


def compensated() -> tuple[Measured, ...]:
    found = []
    for gain in (5.0, 10.0):
        case = replace(el_centro(qian(), 8.0), gain=gain)
        runs = [simulate_hybrid(FIT, case, one).scores for one in (None, Compensation(4096.0))]
        assert runs[0] is not None
        assert runs[1] is not None
        found.append(
            Measured(
                f"tracking error without over with, Kp = {gain:g}",
                runs[0].tracking_rms / runs[1].tracking_rms,
                "",
                None,
                6.0,
            )
        )
    return tuple(found)


def shaking_table() -> tuple[Measured, ...]:
    case = table.shaken({"kind": "blwn", "band": "28 Hz", "amplitude": "0.05 g", "duration": "4 s"})
    record = case.ground.samples(table.RATE)
    off = []
    for name in ("feedforward", "none"):
        run = simulate_hybrid(FIT, case, controller_called(name, FIT, case))
        off.append(table.thirds(table.true_acceleration(run.command, case.gain, 8.75)) - table.thirds(record))
    return (
        Measured("acceleration in thirds of an octave, 0.5 to 30 Hz", float(np.abs(off[0]).max()), "dB", 1.0),
        Measured("with the feedback alone", float(np.abs(off[1]).max()), "dB", None, 2.0),
    )


def changing_parameters() -> tuple[Measured, ...]:
    """τyr and kyr of Qian's loop at three gains, from slow sines: p4/p5 and Z0 Kp/p5 of eq. (10)."""
    plant, off, taus = qian_reference.Plant(), [], []
    t = np.arange(round(3.0 * 4096)) / 4096
    r = 2e-3 * np.sin(2 * np.pi * t) * np.clip(t / 0.2, 0, 1)
    for gain in (5.0, 7.0, 10.0):
        cell = qian_reference.Cell(0.87, 36.3e3, 0.0, gain)
        y = qian_reference.simulate(plant, cell, r)
        y = y + 1e-6 * np.random.default_rng(15).standard_normal(len(t))
        run = Run(
            "sine", "", 4096.0, {"command": r, "displacement": y}, {"command": "m", "displacement": "m"}, hold="linear"
        )
        fit = identify(Matrix(Actuator("A"), (run,)), Settings(model="first_order", seed=1))
        drive = plant.Z0 * gain
        p5 = drive + plant.Cl * cell.stiffness
        p4 = (plant.tau * plant.Cl + plant.Ka) * cell.stiffness + plant.A**2 + plant.Cl * plant.c0
        off += [fit.values["tau"] / (p4 / p5) - 1, fit.values["gain"] / (drive / p5) - 1]
        taus.append(1e3 * fit.values["tau"])
    return (
        Measured("τyr at Kp = 5", taus[0], "ms"),
        Measured("at Kp = 10", taus[-1], "ms"),
        Measured("from p4/p5 and Z0 Kp/p5", 100 * float(np.abs(off).max()), "%", 3.0),
    )


def simulated_rig() -> tuple[Measured, ...]:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "rig"
        write_rig_matrix(out, preset("strano"), {}, TESTS["strano"], seconds=2.0, noise=0.0)
        run = next(r for r in read_matrix(out).runs if r.gain == 200.0 and np.std(r.command) > 0.02)
    values = strano.Machine(**{p.name: p.value for p in preset("strano").parameters})
    shown = strano.respond(values, run.command, gain=run.gain, fine=32)
    off = [
        np.std(run.channels[n] - getattr(shown, n)) / np.std(getattr(shown, n))
        for n in ("displacement", "load_pressure")
    ]
    return (Measured("position and pressure from the flat rig", 100 * float(max(off)), "% of its std", 2.0),)


FLAT = "the flat fifth-order rig"
CLOSED = "a lag in closed form"
ROWS = (
    Row(
        "H1",
        "eqs. (1) to (6)",
        "fifth-order rig from position, load pressure and spool",
        "a model; values not printed",
        FLAT + ", machine 0",
        fifth_order,
        long=True,
    ),
    Row(
        "H2",
        "eq. (2), instruments",
        "vertical load and supply pressure as measured inputs",
        "measured",
        FLAT,
        measured_inputs,
        long=True,
    ),
    Row("H3", "section III", "validation on another record", "validated", FLAT + ", seed 1", validated, long=True),
    Row(
        "H4",
        "hypothesis d",
        "no leakage; a leak of 3e-11 m³/(s Pa) is hidden",
        "assumed",
        "SciPy's LSODA, seed 741",
        hypothesis_d,
        long=True,
    ),
    Row(
        "H5",
        "section IV, Fig. 4",
        "feedforward by the inverse",
        "y follows r when ΔG = 0",
        FLAT,
        feedforward,
        long=True,
    ),
    Row("H6", "section IV", "limit of the gain", "practical limits", FLAT, gain_limit, long=True),
    Row(
        "H7",
        "section IV",
        "ΔG: the reaction of a specimen that the model does not know",
        "paid for by the gain",
        FLAT,
        unknown_force,
        long=True,
    ),
    Row(
        "H8",
        "section V, Figs. 5, 6",
        "an isolator with hysteresis",
        "hysteretic device",
        "a perfect rig, written out",
        hysteresis,
        long=True,
    ),
    Row(
        "H9",
        "eqs. (12) to (25)",
        "τyr 21 → 14 ms, kyr 0.97 → 1.05 in one step",
        "constant values",
        CLOSED,
        extended_kalman_filter,
    ),
    Row("H10", "Fig. 7", "the band around both estimates", "curves without a band", CLOSED, figure_7),
    Row("H11", "section VII", "real time", "in real time", "clock of the processor", real_time, long=True),
    Row(
        "H12",
        "section VII",
        "where the loop is no lag",
        "valid below the oil column",
        "the flat chain of fourth order",
        not_first_order,
        long=True,
    ),
    Row(
        "H13",
        "section I",
        "delay compensation under El Centro",
        "needed",
        "the loop without it",
        compensated,
        long=True,
    ),
    Row(
        "H14",
        "section II",
        "the rig as a shaking table, noise to 28 Hz",
        "possible",
        "flat loop of matrix exponentials",
        shaking_table,
        long=True,
    ),
    Row(
        "H15",
        "section VII",
        "parameters change with controller and specimen",
        "vary",
        "eq. (10), slow",
        changing_parameters,
        long=True,
    ),
    Row("H16", "section III", "simulation of the rig", "a model", FLAT, simulated_rig, long=True),
)
