"""Qian et al. 2014, sections 2.2 to 5.1: the test matrix, the search, the values, their verification."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from ident.comparison.compare import response
from ident.fit.bulk_modulus import bulk_modulus
from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.planning.plan import plan
from ident.rig.limits import RigLimits
from ident.run import Run
from ident.synthesis.matrix import Simulation, simulated
from ident.workflows import compare, identify
from tests.acceptance.matrices import NOISE, as_matrix, as_run
from tests.fit.test_paper_search import GENERATIONS, SEEDS, SHOWN, Course, course
from tests.papers import data
from tests.papers.qian_model import printed
from tests.papers.row import Measured, Row, counted
from tests.reference import qian_reference as qian


def of_cell(run: Run) -> qian.Cell:
    """What the machine moves in a run."""
    assert run.specimen is not None
    return qian.Cell(run.specimen.mass, run.specimen.stiffness, run.specimen.damping, run.Kp)


def matrix_of_tests() -> tuple[Measured, ...]:
    """The simulated matrix: its labels, its amplitudes, and each displacement by the flat reference."""
    matrix = simulated(Simulation(seconds=0.5, seed=701, noise=0.0))
    wanted = {(*t.cell, round(1e6 * t.amplitude), t.use) for t in qian.trials()}
    found = {(*of_cell(run), round(1e6 * (run.amplitude or 0)), run.use) for run in matrix.runs}
    rms = max(abs(np.std(run.command) / (run.amplitude or 1) - 1) for run in matrix.runs)
    off = 0.0
    for run in matrix.runs[::7]:
        true = qian.simulate(qian.Plant(), of_cell(run), run.command, str(run.hold))
        off = max(off, float(np.std(true - run.measured) / np.std(true)))
    return (
        counted("runs with the paper's specimen, gain, amplitude and use", len(wanted & found), 84),
        Measured("RMS of a command, furthest from its label", 100 * float(rms), "%", 2.0),
        Measured("displacement from the reference", off, "of its std", 1e-4),
    )


def fitness() -> tuple[Measured, ...]:
    fit = data.paper_fit()
    plant = qian.Plant(**{name: fit.values[name] for name in qian.PARAMETERS})
    records = [r for r in data.records_of(data.SECONDS, "linear", data.SEED) if r.trial.use == "fit"]
    truth = qian.mean_error(records, plant)
    return (
        Measured("eq. (17), mean over 63 runs", 100 * (fit.error["fit"] or np.nan), "%", 0.51),
        Measured("from that of the time domain", abs((fit.error["fit"] or np.nan) / truth - 1), "", 5e-3),
    )


def table_4() -> tuple[Measured, ...]:
    return (Measured("furthest of six from the truth", data.furthest(data.paper_fit()), "%", 0.2),)


@cache
def courses() -> tuple[Course, ...]:
    """The paper's search from the seeds 0 to 7."""
    search = Identification(data.paper_matrix(), Settings(model="qian2014", method="paper-ga"))
    return tuple(course(search, seed) for seed in SEEDS)


def operators() -> tuple[Measured, ...]:
    """Of one generation: what is kept, what crossover leaves in its column, what mutation redraws."""
    fit = Identification(data.paper_matrix(), Settings(model="qian2014", method="paper-ga", options={"keep": 0.5}))
    first = fit.search.start()
    after = fit.search.advance(first, 1)
    parents, children = np.array(first["population"]), np.array(after["population"])
    order = np.argsort(after["history"][0]["errors"], kind="stable")[:100]
    same = [np.isin(children[:, i], parents[order, i]).sum() for i in range(parents.shape[1])]
    state = after
    while not state["done"]:
        state = fit.search.advance(state, 1)
    last = state["history"][-1]
    five = np.array(last["population"])[np.argsort(last["errors"], kind="stable")[:5]]
    return (
        counted("vectors at first", len(parents), 200),
        counted("vectors after a selection of 0.5", len(children), 100),
        Measured("elements of a column that are of its best half, fewest", min(same), "", 80, 80),
        Measured(
            "result from the mean of the last five", float(np.abs(state["best"] - five.mean(axis=0)).max()), "", 1e-12
        ),
    )


def cost() -> tuple[Measured, ...]:
    ratios = [one.cost[-1] / one.cost[0] for one in courses()]
    return (
        Measured("generations", float(np.mean([len(one.cost) for one in courses()])), "", GENERATIONS, GENERATIONS),
        Measured("last mean cost over the first, mean of 8 seeds", float(np.mean(ratios)), "", 0.4, 0.2),
    )


def cloud() -> tuple[Measured, ...]:
    shown = np.array([one.cloud[[g - 1 for g in SHOWN]] for one in courses()])
    return (
        counted(
            "searches whose cloud shrinks from each shown generation to the next",
            int(np.sum(np.all(np.diff(shown) < 0, axis=1))),
            len(SEEDS),
        ),
        Measured("width at generation 12 over that at 1", float((shown[:, -1] / shown[:, 0]).mean()), "", 0.75),
    )


def searches() -> tuple[Measured, ...]:
    usual = data.paper_fit()
    others = [data.paper_fit(method) for method in ("differential-evolution", "cma-es")]
    apart = [abs(fit.values[name] / value - 1) for fit in others for name, value in usual.values.items()]
    return (Measured("furthest of two other searches from the default", 100 * max(apart), "%", 0.01),)


def acquisition() -> tuple[Measured, ...]:
    made = plan("qian", rig=RigLimits(stroke=0.1524), seconds=4.0)
    commands = [run.signal.command() for run in made.runs[::12]]
    frequency = np.fft.rfftfreq(len(commands[0]), 1 / qian.SAMPLE_RATE)
    beyond = []
    for command in commands:
        power = np.abs(np.fft.rfft(command * np.hanning(len(command)))) ** 2
        beyond.append(power[frequency > 82].sum() / power.sum())
    return (
        counted("command files", len(made.runs), 84),
        Measured("sample rate", made.runs[0].signal.sample_rate, "Hz", 4096.0, 4096.0),
        Measured("power above 82 Hz", float(max(beyond)), "of the whole", 1e-3),
    )


def spectra() -> tuple[Measured, ...]:
    """Measured responses at Kp 6 against eq. (10) at Table 4, to 30 Hz."""
    level, phase = [], []
    for entry in data.paper_comparison().runs:
        if entry.run.use != "verify":
            continue
        inside = (entry.frequency >= 1) & (entry.frequency <= 30)
        ratio = entry.measured[inside] / printed(of_cell(entry.run), entry.frequency[inside])
        level.append(20 * np.log10(np.abs(ratio)))
        phase.append(np.degrees(np.angle(ratio)))
    return (
        Measured("measured against eq. (10), RMS to 30 Hz", float(np.sqrt(np.mean(np.square(level)))), "dB", 0.3),
        Measured("phase", float(np.sqrt(np.mean(np.square(phase)))), "°", 2.0),
    )


@cache
def verification() -> Matrix:
    """Six seconds at Kp = 6 and 0.02 in of the bare actuator, seed 15."""
    trial = next(t for t in qian.trials() if t.use == "verify" and t.cell.mass == 0)
    record = qian.measure(qian.Plant(), trial, seconds=6.0, noise=NOISE, seed=(15,))
    return Matrix(as_matrix([record], "linear").actuator, (as_run(record, "linear"),), "0" * 64)


def in_time() -> tuple[Measured, ...]:
    (entry,) = compare(verification(), data.paper_fit()).runs
    shown = slice(round(5.0 * 4096), round(5.5 * 4096))
    left = np.std(entry.run.measured[shown] - entry.modelled[shown])
    noise = NOISE * np.std(entry.run.measured)
    return (
        Measured("residual from 5.0 to 5.5 s", 1e6 * float(left), "µm RMS"),
        Measured("over the noise of the record", float(left / noise), "", 1.1, 0.9),
    )


def at_40_hertz() -> tuple[Measured, ...]:
    (run,), f = verification().runs, np.linspace(1.0, 40.0, 40)
    found = response(data.paper_fit(), run, verification().actuator, f)
    ratio = found / printed(qian.Cell(0.0, 0.0, 0.0, 6.0), f)
    return (
        Measured("magnitude at 40 Hz", float(20 * np.log10(np.abs(found[-1]))), "dB", -10.0, -20.0),
        Measured("phase at 40 Hz", float(np.degrees(np.unwrap(np.angle(found)))[-1]), "°", 0.0, -200.0),
        Measured("furthest from eq. (10) to 40 Hz", float(np.abs(20 * np.log10(np.abs(ratio))).max()), "dB", 0.05),
    )


def held_back() -> tuple[Measured, ...]:
    error, floor = (100 * (of["verify"] or np.nan) for of in (data.paper_fit().error, data.paper_fit().noise_floor))
    return (
        Measured("error of 21 runs at Kp = 6", error, "%", 0.51),
        Measured("over its floor", error / floor, "", 1.01),
    )


def reused() -> tuple[Measured, ...]:
    """Six runs at Kp = 5, with 0 and 0.87 kg, predict the other 78."""
    of, runs = data.paper_matrix(), []
    for run in of.runs:
        few = run.Kp == 5 and run.specimen is not None and run.specimen.mass < 0.9 and not run.specimen.stiffness
        runs.append(replace(run, use="fit" if few else "verify"))
    fit = identify(replace(of, runs=tuple(runs)), Settings(seed=1))
    return (
        counted("runs fitted", sum(run.use == "fit" for run in runs), 6),
        Measured(
            "error of the other 78 over its floor",
            (fit.error["verify"] or 9) / (fit.noise_floor["verify"] or 1),
            "",
            1.01,
        ),
    )


def modulus() -> tuple[Measured, ...]:
    actuator = replace(data.paper_matrix().actuator, volume=6e-4)
    found = bulk_modulus(data.paper_fit().parameters, actuator)
    assert found is not None
    return (
        Measured("bulk modulus", found.value / 1e9, "GPa", 1.1, 1.06),
        Measured("from V/(4 Ka) of the truth", 100 * abs(found.value / (6e-4 / 4 / qian.Plant().Ka) - 1), "%", 0.2),
    )


FLAT = "flat integration of eqs. (1) to (7), seed 1"
ROWS = (
    Row(
        "Q6",
        "Table 3",
        "7 specimens × Kp 5, 7, 10 × three amplitudes, and Kp 6",
        "63 runs",
        "flat integration of the same commands",
        matrix_of_tests,
        long=True,
    ),
    Row("Q7", "eq. (17)", "fitness of the fitted vector", "std(xm − xi)/std(xm), summed", FLAT, fitness, long=True),
    Row("Q8", "Table 4", "six parameters from 63 runs with 0.5 % noise", "Table 4", FLAT, table_4, long=True),
    Row(
        "Q9",
        "2.2.1 to 2.2.3, Figs. 8 to 10",
        "the operators of the paper's search at its selection ratio",
        "200 vectors, 0.5 kept, columns permuted, 0.2 redrawn, 5 averaged",
        "counted in its first generation",
        operators,
        long=True,
    ),
    Row(
        "Q10",
        "Fig. 14",
        "the cost over the generations",
        "20 generations, from 23 to 7: 0.30",
        FLAT,
        cost,
        long=True,
        argument="The selection ratio of the text, 0.5, leaves five vectors after six generations, and mutation "
        "over the "
        "whole of Table 2 does not converge. The program keeps 0.85 and redraws between the survivors: Fig. 14 "
        "comes out.",
    ),
    Row("Q11", "Fig. 13", "the cloud of Z0 and c at generations 1, 4, 8, 12", "it contracts", FLAT, cloud, long=True),
    Row("Q12", "2.2", "other global searches", "one optimum", "the default search", searches, long=True),
    Row(
        "Q15",
        "Fig. 11, section 3",
        "commands for a rig: white noise of 0 to 80 Hz",
        "63 records at 4096 Hz",
        "spectra by NumPy",
        acquisition,
        argument="The program writes the command files and reads the records, or a stream while the test runs. It "
        "contains no driver of a digital-to-analogue converter: the rig's own controller plays the files.",
    ),
    Row(
        "Q16",
        "section 3, FFT",
        "measured transfer functions at Kp = 6",
        "H1, averaged",
        "eq. (10) as a polynomial",
        spectra,
        long=True,
    ),
    Row(
        "Q17",
        "Fig. 15",
        "5.0 to 5.5 s at Kp = 6, 0.02 in",
        "model and record lie on each other",
        "flat integration, seed 15",
        in_time,
        long=True,
    ),
    Row(
        "Q18",
        "Fig. 16 a",
        "response to 40 Hz without a specimen, Kp = 6",
        "axes of −20 to 0 dB and −200 to 0°",
        "eq. (10) as a polynomial",
        at_40_hertz,
        long=True,
    ),
    Row("Q19", "5.1", "Kp = 6, which no fit saw", "perfect tracking to 30 Hz", FLAT, held_back, long=True),
    Row("Q20", "sections 1 and 6", "re-use: other payloads and gains", "one set for all", FLAT, reused, long=True),
    Row("Q21", "eq. (18)", "bulk modulus with the printed volume", "1.1 GPa", FLAT, modulus, long=True),
)
