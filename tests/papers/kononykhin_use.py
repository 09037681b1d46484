"""Kononykhin 2019, sections 6 and 7: the sheet, accuracy and time, what is missing, the control loop, conditions."""

from __future__ import annotations

import tempfile
import time
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from ident.bench.acceptance import sheet
from ident.bench.analysis import analyse
from ident.bench.describing_function import first_harmonic
from ident.bench.position_loop import Regulator, margins
from ident.bench.records import bench_set
from ident.export import as_fmu, as_header, exported
from ident.fit.settings import Settings
from ident.planning.plan import plan
from ident.rig.limits import RigLimits
from ident.statistics import condition_laws, summary
from ident.workflows import diagnose, figure, identify
from tests.acceptance.test_rounding import SHORT
from tests.bench.sets import as_matrix, as_set
from tests.bench.test_diagnosis import CALLED, HIDDEN, SI, fitted, matrix_with, plain
from tests.bench.test_position_loop import SMOOTH, Actuator, model_of, sine
from tests.export.machines import compiled, largest_error, unit_of_control
from tests.export.test_bench import RATE, current, of_bench
from tests.export.test_bench import reference as exported_truth
from tests.export.test_identification import SEED, off_the_sheet
from tests.papers import data
from tests.papers.row import Measured, Row, counted
from tests.reference import kononykhin_reference as reference
from tests.reference.viscosity_reference import COLD, HOT, drawn_law, drawn_sets

SEEDS = (0, 1, 2)


@cache
def short_fit() -> tuple[object, object]:
    """Actuator 4, without the slow sines, with the fit by his procedures."""
    truth = reference.scattered(4)
    matrix = as_matrix(truth, reference.full_set(truth, 4, short=True))
    return matrix, identify(matrix, Settings(model="kononykhin", method="gradient"))


def sheet_of_an_actuator() -> tuple[Measured, ...]:
    matrix, fit = short_fit()
    names = ("pressure-loop", "frequency-characteristics", "speed-characteristic", "acceptance-sheet")
    drawn = [figure(fit, name, matrix).to_dict() for name in names]
    lines = sheet(analyse(bench_set(matrix)), {"hysteresis": (None, 1e-6), "T": (None, 1.0)})
    verdicts = {line.quantity: line.verdict for line in lines}
    return (
        counted("figures of the window drawn", len(drawn), 4),
        Measured("quantities of the sheet", len(lines), "", None, 12),
        counted(
            "limits judged right: one kept, one broken",
            (verdicts["T"] == "pass") + (verdicts["hysteresis"] == "FAIL"),
            2,
        ),
    )


def without_an_operator() -> tuple[Measured, ...]:
    truth = reference.scattered(4)
    matrix = as_matrix(truth, reference.full_set(truth, 4, short=True))
    fit = identify(matrix, model="kononykhin", options={"population": 16.0, "generations": 3.0, "elite": 3.0})
    free = [one for one in fit.parameters.values() if not one.fixed and one.std_error]
    return (
        counted("values found in one call, each with a standard error", len(free), 17),
        Measured("T", 100 * abs(fit.values["T"] / truth.T - 1), "%", 3.0),
    )


def alternative_fitters() -> tuple[Measured, ...]:
    truth = reference.scattered(9)
    matrix = as_matrix(truth, reference.full_set(truth, 9, short=True))
    fits = [
        identify(matrix, SHORT),
        identify(matrix, replace(SHORT, method="paper-ga", options={"population": 16.0})),
        identify(matrix, Settings("kononykhin", method="gradient")),
    ]
    errors = [fit.error["fit"] or np.nan for fit in fits]
    off = max(abs(fit.values["T"] / truth.T - 1) for fit in fits)
    return (
        Measured("errors of three methods over the least", max(errors) / min(errors), "", 1.05),
        Measured("T, furthest from the truth", 100 * off, "%", 3.0),
    )


def accuracy() -> tuple[Measured, ...]:
    found = [data.bench(seed) for seed in SEEDS]
    worst = {
        size: 100 * max(one.position_error(size, f) for one in found for f in reference.FREQUENCIES)
        for size in (2.0, 50.0)
    }
    return (
        Measured("position error at 2 % of the rated current, worst of 15", worst[2.0], "%", 10.0),
        Measured("at 50 %", worst[50.0], "%", 3.0),
    )


def time_of_analysis() -> tuple[Measured, ...]:
    truth = reference.scattered(5)
    bench = as_set(truth, reference.full_set(truth, 5))
    analyse(as_set(truth, reference.full_set(truth, 5, short=True)))
    begun = time.process_time()
    analyse(bench)
    return (Measured("processor time of a whole set", time.process_time() - begun, "s", 8.0),)


def time_of_reading() -> tuple[Measured, ...]:
    made = plan("kononykhin", rig=RigLimits(stroke=0.1, speed=0.2))
    kinds = {run.kind for run in made.runs}
    whole = sum(run.law.seconds for run in made.runs if run.law is not None)
    without = sum(run.law.seconds for run in made.runs if run.law is not None and run.law.seconds < 10)
    return (
        counted("records written as laws of the control unit", sum(run.law is not None for run in made.runs), 26),
        counted("kinds of test", len(kinds), 4),
        Measured("records of less than 10 s together", without / 60, "min", 1.5),
        Measured("all together", whole / 60, "min", 8.0),
    )


def detailed_friction() -> tuple[Measured, ...]:
    matrix = matrix_with(short=True)
    fit = identify(matrix, Settings(model="kononykhin", method="gradient", effects=("stiction",)))
    return (Measured("stiction of an actuator without any", 1e-3 * abs(fit.values["stiction.pressure"]), "kPa", 20.0),)


def pure_delay() -> tuple[Measured, ...]:
    truth = reference.scattered(7)._replace(delay=0.004)
    found = analyse(as_set(truth, reference.full_set(truth, 7, short=True))).delay
    assert found is not None
    return (
        Measured("correlation of T and a delay", found.correlation["T"]["delay"], "", -0.9),
        Measured("a delay of 4 ms found as", 1e3 * found.delay.value, "ms", 4.4, 3.6),
        Measured("T beside it", 100 * abs(found.T / truth.T - 1), "%", 5.0),
    )


def what_is_missing() -> tuple[Measured, ...]:
    named, off = 0, []
    for name in ("delay", "load"):
        called = CALLED[name]
        hidden = matrix_with(name, short=True)
        named += diagnose(hidden, plain(name, short=True), most=1).verdict.effects == (called,)
        mended = fitted(hidden, called)
        (strength,) = (p for n, p in mended.parameters.items() if "." in n and not p.fixed)
        off.append(abs(strength.value / HIDDEN[name] / SI[name] - 1))
    sound = diagnose(matrix_with(short=True), plain(short=True), most=1)
    return (
        counted("named, a delay and a spring", named, 2),
        Measured("strength once added, furthest", 100 * max(off), "%", 5.0),
        counted("effects named where nothing is hidden", len(sound.verdict.effects) + 1, 1),
    )


def margin_of_each_actuator() -> tuple[Measured, ...]:
    """The reference swings at the gain of the margin: it dies out with 1 dB less and grows with 1 dB more."""
    right, off = 0, []
    for delay in (0.0, 2e-3, 5e-3):
        truth = SMOOTH._replace(delay=delay)
        model = model_of(truth)
        found = margins(model, Regulator(30.0), 3.0 * model.B)
        assert found.oscillation_gain is not None
        assert found.oscillation_frequency is not None
        grown = [free_motion(truth, model, found, step) for step in (-1.0, 0.0, 1.0)]
        right += grown[0][0] < 1.0 < grown[2][0]
        off.append(abs(grown[1][1] / 1500 - 1))
    none = margins(model_of(SMOOTH._replace(B=1e-9, dPfr=1e-9)), Regulator(30.0), 0.1)
    return (
        counted("delays of 0, 2, 5 ms with the gain of self-oscillation within 1 dB", right, 3),
        Measured("its frequency", 100 * max(off), "%", 5.0),
        counted("no delay, no play: the gain margin is none", int(none.gain_margin is None), 1),
    )


def free_motion(truth: reference.Truth, model: object, found: object, decibel: float) -> tuple[float, float]:
    """Growth over two periods and the period (samples) of the closed loop, begun with the predicted oscillation."""
    of, gain = found, found.oscillation_gain * 10 ** (decibel / 20)
    given, _ = sine(model, of.amplitude, of.oscillation_frequency)
    actuator = Actuator(truth, 1 / (of.oscillation_frequency * 1500), 100 * given[0])
    forced = np.array([actuator.move(one) for _ in range(6) for one in given])
    middle, bias = float(np.mean(forced[-1500:])), first_harmonic(model, of.amplitude).bias
    free, position = [], forced[-1]
    for _ in range(5 * 1500):
        position = actuator.move(bias + gain * (middle - position))
        free.append(position - middle)
    rises = np.flatnonzero((np.array(free)[:-1] < 0) & (np.array(free)[1:] >= 0))
    return float(np.ptp(free[-1500:]) / np.ptp(free[3000:4500])), float(rises[1] - rises[0])


def embedded() -> tuple[Measured, ...]:
    machine, u = exported(of_bench(), sample_rate=RATE), current()
    with tempfile.TemporaryDirectory() as folder:
        found = compiled(machine, u, Path(folder))
        (Path(folder) / "machine.h").write_text(as_header(machine))
        call = "void step(double u, double *y) { servoident_step(&m, u, y); }\n"
        source = f'#include "machine.h"\nstatic servoident_machine m;\n{call}'
        size, _ = unit_of_control(source, Path(folder))
    position, _ = exported_truth(u)
    off = largest_error(found[:, machine.outputs.index("displacement")], position)
    return (
        Measured("identification in C, from values 10 % off, against the sheet", identified_off(), "of a value", 1e-6),
        Measured("C against the flat actuator", float(off), "of its std", 1e-5),
        Measured("code and state by gcc -Os", size / 1024, "kB", 64.0),
        Measured("FMU", len(as_fmu(machine)) / 1024, "kB", None, 1.0),
    )


def identified_off() -> float:
    """How far the compiled identification ends from the sheet, of the quantity that is farthest."""
    truth = reference.scattered(SEED)
    bench = as_set(truth, reference.full_set(truth, SEED, short=True))
    with tempfile.TemporaryDirectory() as folder:
        return max(map(abs, off_the_sheet(bench, analyse(bench), Path(folder)).values()))


def over_conditions() -> tuple[Measured, ...]:
    rng, covered, wrong, told = np.random.default_rng(576), [], 0, 0
    grid = np.linspace(COLD, HOT, 11)
    for draw in range(200):
        truth = drawn_law(rng, ("Arrhenius", "Walther")[draw % 2])
        law = condition_laws(*drawn_sets(rng, truth, 30, 0.05), temperature=True)[0]
        covered.append([law.at(k).lower <= truth(k) <= law.at(k).upper for k in grid])
        level = law.at(333.15)
        for limit in truth(333.15) * rng.uniform(0.9, 1.1, 10):
            away = (level.value - limit) / level.std_error
            told += 1
            wrong += abs(away) >= law.sure and (away > 0) != (truth(333.15) > limit)
    return (
        Measured("band of 95 % holds the truth, all temperatures", 100 * float(np.mean(covered)), "%", 97.0, 93.0),
        Measured("wrong verdicts at 60 °C", 100 * wrong / told, "%", 1.0),
    )


def spread_of_actuators() -> tuple[Measured, ...]:
    """Statistics of 20 drawn actuators by NumPy; and the spread of their margins for one regulator."""
    truths = [reference.scattered(seed) for seed in range(20)]
    T = np.array([truth.T for truth in truths])
    found = summary(T.tolist())
    own, by_numpy = np.array([found.mean, found.deviation]), np.array([T.mean(), T.std(ddof=1)])
    worst = [margins(model_of(truth), Regulator(30.0, sample_time=2e-3), 0.1).gain_margin for truth in truths]
    return (
        Measured("mean and standard deviation from NumPy", float(np.abs(own / by_numpy - 1).max()), "", 1e-12),
        Measured("gain margins of 20 actuators, least", min(one or np.inf for one in worst), "dB"),
        Measured("largest", max(one or np.inf for one in worst), "dB"),
    )


BENCH = "an independent bench (12 bit, 0.2 MPa RMS), seeds 0 to 2"
ROWS = (
    Row(
        "K16",
        "Fig. 2",
        "window for reading and analysing; the sheet",
        "a window",
        "limits set by the row",
        sheet_of_an_actuator,
        long=True,
    ),
    Row(
        "K17",
        "section 6",
        "identification without an operator",
        "automatic",
        "independent bench, seed 4",
        without_an_operator,
        long=True,
    ),
    Row(
        "K18",
        "5.2, section 6",
        "other fitters on the same records",
        "gradient descent",
        "independent bench, seed 9",
        alternative_fitters,
        long=True,
    ),
    Row("K19", "conclusion 2", "position error for sines of 2 % and 50 %", "10 % and 3 %", BENCH, accuracy, long=True),
    Row(
        "K20",
        "conclusion 1",
        "time of the analysis",
        "60 min → 8 s",
        "clock of the processor",
        time_of_analysis,
        long=True,
    ),
    Row(
        "K21",
        "conclusion 1",
        "reading the characteristics",
        "30 min → 1 min",
        "sum of the records",
        time_of_reading,
        argument="The control unit plays the laws, with no operator. The records that take less than ten seconds "
        "last about a minute "
        "together. The static records and the slow sines take the rest: a saw-tooth of 0.25 mm/s holds the pressure "
        "groups apart."),
    Row("K22", "section 6", "a detailed friction model (Stribeck)", "inexpedient", "independent bench without "
        "stiction, "
        "seed 66", detailed_friction, long=True),
    Row("K23", "section 6", "no pure delay in the model", "T and a delay are alike", "independent bench with 4 ms, "
        "seed 7",
        pure_delay, long=True),
    Row("K24", "section 6", "what the simple model lacks", "simplifications are stated", "independent bench, seed 66",
        what_is_missing, long=True),
    Row("K26", "section 7", "spread between actuators", "T 15 to 70 %, B to 200 %", "NumPy, seeds 0 to 19",
        spread_of_actuators),
    Row("K27", "conclusion 2", "stability margin of each produced actuator", "by calculation", "the flat actuator in a "
        "closed loop", margin_of_each_actuator, long=True),
    Row("K28", "section 3", "the model in the control unit", "procedures work as a part of the unit", "flat "
        "actuator; gcc",
        embedded, long=True),
    Row("K29", "section 6", "parameters over conditions: −20 to 80 °C, 30 sets, 200 draws (seed 576)", "named as a use",
        "oils of Arrhenius' and Walther's law", over_conditions, long=True),
)  # fmt: skip
