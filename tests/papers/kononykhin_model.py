"""Kononykhin 2019, sections 4 and 5: the four blocks and the three procedures, on actuators of an independent bench."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.optimize import minimize

from ident.bench.analysis import analyse
from ident.bench.frequency import frequency_response
from ident.bench.motion import groups
from ident.bench.sine_fit import as_printed, fit_sine
from ident.bench.smoothing import METHODS, bezier, on_bezier
from ident.bench.speed import curve
from tests.bench.recovery import Found
from tests.bench.sets import as_set, true_model
from tests.bench.test_procedures import ALPHA, distorted, short_set
from tests.papers import data
from tests.papers.row import Measured, Row, counted
from tests.reference import kononykhin_reference as reference

SEEDS = (0, 1, 2)


def actuators() -> list[Found]:
    """Three scattered actuators."""
    return [data.bench(seed) for seed in SEEDS]


def worst(name: str) -> float:
    """The largest relative error (%) of a quantity of the sheet."""
    return 100 * max(one.relative(name) for one in actuators())


def block_a() -> tuple[Measured, ...]:
    return (Measured("T, furthest from the truth", worst("T"), "%", 3.0),)


def block_b() -> tuple[Measured, ...]:
    static = [abs(one.analysis.static.hysteresis.value / one.truth.B - 1) for one in actuators()]
    return (
        Measured("B of the static procedure", 100 * max(static), "%", 5.0),
        Measured("B of all records together", worst("hysteresis"), "%", 5.0),
    )


def block_c() -> tuple[Measured, ...]:
    off = 0.0
    for one in actuators():
        true, found = one.truth.table.values(), one.analysis.model.table.values()
        off = max(off, *(abs(found[name] / value - 1) for name, value in true.items()))
    return (Measured("speed at the nodes, furthest", 100 * off, "%", 1.0),)


def block_d() -> tuple[Measured, ...]:
    return (Measured("kp", worst("kp"), "%", 3.0), Measured("ΔPfr", worst("friction"), "%", 3.0))


def static_procedure() -> tuple[Measured, ...]:
    shift = max(one.zero_shift for one in actuators())
    return (
        Measured("zero shift off by", 100 * shift, "% of the rated current", 0.05),
        Measured("dead space", worst("dead_space"), "%", 5.0),
        counted("ranges of positions with values of their own", len(data.bench().analysis.by_range), 3),
    )


@cache
def static_records() -> tuple[reference.Truth, list[reference.Record]]:
    """Actuator 3, without the slow sines."""
    truth = reference.scattered(3)
    return truth, reference.full_set(truth, 3, short=True)


def three_groups() -> tuple[Measured, ...]:
    truth, records = static_records()
    speed = np.gradient(records[0].true_position) * reference.RATE
    state = groups(as_set(truth, records).records[0])
    shares = []
    for sign in (-1, 0, 1):
        true = (np.sign(speed) * (np.abs(speed) > 0.05)) == sign
        shares.append(100 * float(np.mean(state[true] == sign)))
    return (Measured("samples of a group that are found in it, least of three", min(shares), "%", None, 85.0),)


def sines() -> tuple[Measured, ...]:
    """Of each sine record: least squares on the position before the converter; and the printed iteration."""
    truth, records = static_records()
    found = {one.id: one for one in frequency_response(as_set(truth, records).of_kind("frequency"))}
    level, angle = [], []
    for record in records:
        if record.kind != "frequency":
            continue
        turns = 2 * np.pi * record.frequency * np.arange(len(record.current)) / reference.RATE
        keep = turns >= 2 * np.pi - 1e-9
        columns = np.column_stack([np.cos(turns), np.sin(turns), np.ones_like(turns), turns])[keep]
        x, i = (
            np.linalg.lstsq(columns, signal[keep], rcond=None)[0] for signal in (record.true_position, record.current)
        )
        true = complex(x[0], -x[1]) / complex(i[0], -i[1]) * 1e-3 * 100
        level.append(found[record.id].gain / abs(true) - 1)
        angle.append(np.angle(np.exp(-1j * found[record.id].phase) / (true / abs(true))))
    bent = distorted(0.7)
    printed, least = as_printed(ALPHA, bent), fit_sine(ALPHA, bent)
    other = minimize(
        lambda a: np.sum((a[0] + a[1] * np.sin(ALPHA + a[2]) - bent) ** 4) / least.rms**4,
        [least.a1, least.a2, least.a3],
        tol=1e-14,
    ).x
    return (
        Measured("gain, furthest of the sines", 100 * float(np.abs(level).max()), "%", 2.0),
        Measured("phase", float(np.degrees(np.abs(angle).max())), "°", 2.0),
        Measured("the printed iteration from SciPy's minimum of Σσ²", 100 * abs(printed.a2 / other[1] - 1), "%", 0.01),
        Measured("and from least squares, at a play of 0.7", 100 * (printed.a2 / least.a2 - 1), "%", 0.75, 0.65),
    )


def gradient_descent() -> tuple[Measured, ...]:
    lags = [one.analysis.dynamics for one in actuators()]
    off = [abs(lag.gradient_T / one.truth.T - 1) for lag, one in zip(lags, actuators(), strict=True)]
    apart = [abs(lag.gradient_T / lag.T.value - 1) for lag in lags]
    return (
        Measured("T by gradient descent", 100 * max(off), "%", 3.0),
        Measured("from least squares", 100 * max(apart), "%", 1.0),
    )


def characteristics() -> tuple[Measured, ...]:
    truth = reference.Truth(nonlinearity=0.0)
    points = frequency_response(as_set(truth, reference.full_set(truth, 0)).of_kind("frequency"))[-5:]
    w = 2 * np.pi * np.array([one.frequency for one in points])
    gain = np.array([one.gain for one in points]) / (0.1 / w / np.hypot(1, w * truth.T))
    phase = np.degrees([one.phase for one in points]) - 90 - np.degrees(np.arctan(w * truth.T))
    return (
        Measured("gain at half the rated current", 100 * float(np.abs(gain - 1).max()), "%", 5.0),
        Measured("phase", float(np.abs(phase).max()), "°", 2.0),
    )


def drift() -> tuple[Measured, ...]:
    x = 2.0 + 0.3 * (ALPHA - ALPHA.mean()) + 0.5 * np.sin(ALPHA + 1.0)
    return (Measured("amplitude of a drifting sine", abs(fit_sine(ALPHA, x, drift=True).a2 / 0.5 - 1), "", 1e-9),)


def levels() -> tuple[Measured, ...]:
    off = 0.0
    for one, seed in zip(actuators(), SEEDS, strict=True):
        truth = reference.scattered(seed)
        for level in one.analysis.speed.levels:
            true = 1e-3 * truth.speed(np.array([100 * (level.current - one.truth.I0)]))[0]
            off = max(off, abs(level.free_speed - true) / (1e-3 * truth.G))
    return (Measured("speed at the levels, furthest", 100 * off, "% of full speed", 1.0),)


def continuous() -> tuple[Measured, ...]:
    truth, bench = reference.scattered(1), short_set(1)
    model = true_model(truth)
    (record,) = bench.of_kind("speed-continuous")
    found = []
    for method in METHODS:
        seen = curve(model, record, method)
        inside = slice(200, -200)
        wrong = seen.free_speed[inside] - 1e-3 * truth.speed(100 * (seen.corrected[inside] - model.I0))
        found.append(Measured(method, 100 * float(np.std(wrong)) / (1e-3 * truth.G), "% of full speed", 2.0))
    return tuple(found)


def bezier_curve() -> tuple[Measured, ...]:
    rng = np.random.default_rng(0)
    current = np.linspace(-1, 1, 400)
    speed = 3 * (current - 0.1) + 0.5 * rng.standard_normal(400) + 0.7
    at = [abs(on_bezier(*bezier(current, speed, n, 0.1), np.array([0.1]))[0]) for n in (1, 3, 7)]
    return (
        counted("smoothings", len(METHODS), 3),
        Measured("speed at I0 of degrees 1, 3, 7", float(max(at)), "m/s", 1e-12),
    )


def straightness() -> tuple[Measured, ...]:
    asymmetry, bend = [], []
    for one, seed in zip(actuators(), SEEDS, strict=True):
        truth, u = reference.scattered(seed), np.linspace(-100, 100, 201)
        speed, columns = truth.speed(u), np.column_stack([u, np.ones_like(u)])
        left = speed - columns @ np.linalg.lstsq(columns, speed, rcond=None)[0]
        side = [float(u[s] @ speed[s] / (u[s] @ u[s])) for s in (u > 0, u < 0)]
        asymmetry.append(one.quantities["asymmetry"].value - 2 * (side[0] - side[1]) / sum(side))
        bend.append(one.quantities["nonlinearity"].value - np.abs(left).max() / np.abs(speed).max())
    return (
        Measured("nonlinearity off by", 100 * float(np.abs(bend).max()), "% of full speed", 0.5),
        Measured("asymmetry off by", 100 * float(np.abs(asymmetry).max()), "%", 0.5),
    )


def twelve_bits() -> tuple[Measured, ...]:
    truth, read = reference.scattered(4), reference.Instruments(pressure_bits=12, anywhere=0.05)
    found = analyse(as_set(truth, reference.full_set(truth, 4, read, short=True))).model
    assert found is not None
    return (
        Measured("T with converters of 12 bits", 100 * abs(found.T / truth.T - 1), "%", 3.0),
        Measured("B", 100 * abs(100 * found.B / truth.B - 1), "%", 5.0),
    )


BENCH = "an independent bench (12 bit, 0.2 MPa RMS), seeds 0 to 2"
ROWS = (
    Row(
        "K1",
        "section 4, block a",
        "time constant T",
        "an aperiodic link; the printed second derivative is a misprint",
        BENCH,
        block_a,
        long=True,
        argument="The text calls block a an aperiodic link. The program takes T I' + I = Iin, and finds T of a "
        "bench that "
        "is built so.",
    ),
    Row("K2", "block b, conclusion 2", "hysteresis B", "error below 5 %", BENCH, block_b, long=True),
    Row(
        "K3",
        "block c",
        "speed characteristic, six currents to each side",
        "a table with a spline or lines",
        BENCH,
        block_c,
        long=True,
    ),
    Row("K4", "Fig. 1, block d", "slope kp and friction ΔPfr", "values without an error", BENCH, block_d, long=True),
    Row(
        "K5",
        "5.1",
        "zero shift, dead space, ranges of positions",
        "values without an error",
        BENCH,
        static_procedure,
        long=True,
    ),
    Row(
        "K6",
        "5.1, Fig. 3",
        "three groups: at rest, moving forward, moving back",
        "a figure",
        "true speed, seed 3",
        three_groups,
    ),
    Row(
        "K7",
        "5.2",
        "x = a1 + a2 sin(α + a3), with R, J and Δ",
        "an iteration",
        "NumPy on the true position; SciPy",
        sines,
    ),
    Row(
        "K8", "5.2", "T by gradient descent, errors over amplitudes", "an iteration", BENCH, gradient_descent, long=True
    ),
    Row(
        "K9",
        "Fig. 4",
        "amplitude and phase characteristics",
        "a figure",
        "an integrator behind a lag, closed form",
        characteristics,
        long=True,
    ),
    Row("K10", "5.2", "drift while a sine runs", "compensated on the bench", "a sine with a drift, closed form", drift),
    Row("K11", "5.3", "fixed levels", "mean speeds", BENCH, levels, long=True),
    Row(
        "K12",
        "5.3, Fig. 5",
        "continuous change, current corrected by the dynamics",
        "hysteresis removed",
        "true characteristic, seed 1",
        continuous,
    ),
    Row("K13", "5.3", "smoothing: IIR, FIR, Bézier through I0", "three ways", "the condition itself", bezier_curve),
    Row("K14", "5.3", "nonlinearity and asymmetry by straight lines", "values without an error", "NumPy on the true "
        "characteristic, seeds 0 to 2", straightness, long=True),
    Row("K15", "section 5", "12-bit converters of position and pressure", "named as the difficulty", "independent "
        "bench, "
        "seed 4", twelve_bits, long=True),
)  # fmt: skip
