"""The settings with which docs/accuracy.md was measured, as the tests that measure it have them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from inspect import signature

from ident.effects import EFFECTS
from ident.fit.criteria import FIT_CRITERIA
from ident.hybrid import oil_column, parameter_samples, robustness
from tests import rounding
from tests.acceptance import matrices, test_equations, test_fitness, test_identification, test_rounding
from tests.effects import test_contract
from tests.fit import recovery, test_fifth_order
from tests.fit import rig as rig_of_fit
from tests.hybrid import test_benchmark2020, test_feedforward, test_tracking
from tests.numbers_said import PARTS, Tie, beyond, per_cent, plain, power, word
from tests.reference import (
    controlled_loop_reference,
    first_order_reference,
    nonlinear_reference,
    plain_machine,
    qian_reference,
    strano_reference,
    test_qian_reference,
)

EFFECTS_BY_NAME = {effect.name: effect for effect in EFFECTS}


def of_accuracy() -> Iterator[Tie]:
    """What was measured, and how: the settings of the tests that measure it."""
    A = "accuracy.md"
    runs = Counter(trial.use for trial in qian_reference.trials())
    (verified,) = {trial.cell.gain for trial in qian_reference.trials() if trial.use == "verify"}
    yield (
        A,
        "{} estimation runs and {} validation runs at Kp = {}, with white noise of {} %",
        (
            runs["fit"],
            runs["verify"],
            plain(verified),
            per_cent(matrices.NOISE),
        ),
    )
    yield (
        A,
        "DOP853 at a relative tolerance of {} it is within {} of the output's standard deviation",
        (
            power(test_qian_reference.TIGHT),
            power(test_qian_reference.CLOSE),
        ),
    )
    yield A, "--seconds {} --noise {} --seed", (plain(matrices.LONG), plain(matrices.NOISE))
    yield (
        A,
        "short forms ({} s a run) every time, and the full forms ({} s a run, {} seeds, {} vectors)",
        (
            plain(matrices.SHORT),
            plain(matrices.LONG),
            test_identification.SEEDS,
            test_fitness.VECTORS,
        ),
    )
    of_equations = test_equations.MACHINES, power(test_equations.EXACT)
    yield A, "exact arithmetic, {} random machines | within {} |", of_equations
    yield (
        A,
        "response against eq. (10), {:g} to {:g} Hz, {} random machines | within {} |",
        (
            *test_equations.BAND,
            *of_equations,
        ),
    )
    yield (
        A,
        "1 % wrong ({} cases) | at least 1e-4: a tolerance of {} finds each",
        (
            len(test_equations.MUTATIONS),
            power(test_equations.TOLERANCE),
        ),
    )
    yield (
        A,
        "at the truth | {} vectors within {} % of it | {} vectors in the bounds of Table 2",
        (
            test_fitness.VECTORS,
            per_cent(test_fitness.APART),
            test_fitness.VECTORS,
        ),
    )
    yield A, "off by more than {} %, the worst", (per_cent(test_fitness.TOLERANCE),)
    yield A, "more than one vector in {} of a generation", ({20: "twenty"}[FIT_CRITERIA.reduced.leading],)
    for seconds in (matrices.SHORT, matrices.LONG):
        yield A, "| {} s | straight lines | 0.00", (plain(seconds),)
    yield A, "Default method, {} s records, {} % noise.", (plain(matrices.LONG), per_cent(matrices.NOISE))
    true = qian_reference.Plant()
    for symbol, value in (
        ("Z0", f"{true.Z0:g} m⁴/s".replace("e-0", "e-")),
        ("τ", f"{1e3 * true.tau:g} ms"),
        ("m0", f"{true.m0:g} kg"),
        ("c0", f"{true.c0:g} N·s/m"),
        ("Ka", f"{true.Ka:g} m³/Pa"),
        ("Cl", f"{true.Cl:g} m³/(s·Pa)"),
    ):
        yield A, "| {} | {} |", (symbol, value)
    yield A, "{} seeds end within", ({30: "Thirty"}[test_identification.SEEDS],)
    yield A, "is 0.49986 %, the noise {} %", (per_cent(matrices.NOISE),)
    yield A, "end within {} of the same cost", (power(test_identification.SAME),)
    yield (
        A,
        "on {} copies of the data, each sample moved by {} of itself",
        (
            word(test_rounding.COPIES),
            power(rounding.SIZE),
        ),
    )
    yield A, "find every value within {} of its standard error", (PARTS[test_rounding.CLOSE],)


def of_accuracy_elsewhere() -> Iterator[Tie]:
    """The same of other machines than the paper's, of effects, of tracking and hybrid simulation."""
    A = "accuracy.md"
    yield (
        A,
        "{} machines, each parameter drawn within {} % of the assumed one; one record each of {} s at {} kHz",
        (
            {20: "Twenty"}[test_fifth_order.LONG],
            per_cent(strano_reference.APART),
            plain(rig_of_fit.SECONDS),
            plain(1e-3 * strano_reference.RATE),
        ),
    )
    yield (
        A,
        "a sine of {} Hz and {} m with noise of {} mm RMS to {} Hz at {} V/m",
        (
            plain(strano_reference.FREQUENCY),
            plain(strano_reference.AMPLITUDE),
            plain(1e3 * strano_reference.ROUGH),
            plain(strano_reference.EDGE),
            plain(rig_of_fit.GAIN),
        ),
    )
    yield (
        A,
        "noise of {} mm, {} bar in each chamber and the supply, {} mV of the spool",
        (
            plain(1e3 * rig_of_fit.NOISE["displacement"]),
            plain(1e-5 * rig_of_fit.NOISE["pressure"]),
            plain(1e3 * rig_of_fit.NOISE["spool"]),
        ),
    )
    yield (
        A,
        "τyr {:g} to {:g} ms, kyr {:g} to {:g}, starts up to {} times off | {:,} trials each",
        (
            *(1e3 * tau for tau in first_order_reference.TAUS),
            *first_order_reference.GAINS,
            word(first_order_reference.OFF),
            test_tracking.FULL,
        ),
    )
    yield A, "within {} % after 1 s in all", (per_cent(test_tracking.CLOSE),)
    yield A, "innovation squared of {:,} samples in its 95 % band", (test_tracking.SAMPLES,)
    yield (
        A,
        "{} % of samples {} σ off; {} s of standstill",
        (
            per_cent(test_tracking.SPOILT),
            plain(test_tracking.FAR),
            plain(test_tracking.REST),
        ),
    )
    yield (
        A,
        "a fit of {} runs | {} | 100 stable and within {:g} dB and {:g}° to {:g} Hz",
        (
            Counter(trial.use for trial in qian_reference.trials())["fit"],
            parameter_samples.DRAWS,
            *robustness.WITHIN,
            robustness.HIGHEST,
        ),
    )
    band = signature(controlled_loop_reference.benchmark_record).parameters["band"].default
    yield (
        A,
        "from {} s of noise, 0 to {} Hz, {} % of noise",
        (
            plain(test_benchmark2020.SECONDS),
            plain(band),
            per_cent(test_benchmark2020.NOISE),
        ),
    )
    yield A, "{} drawn plants each", (test_benchmark2020.PLANTS,)
    yield A, "| {} draws, {} % on every parameter", (test_feedforward.DRAWN, per_cent(test_feedforward.APART))
    yield A, "the smallest change with a peak at 45 Hz | {} starts |", (oil_column.STARTS,)
    yield A, "friction with located events), {} machines, both kinds of command", (word(len(test_contract.CELLS)),)
    yield (
        A,
        "agree within {} of the output's standard deviation, friction that sticks within {}",
        (
            power(plain_machine.CLOSE),
            power(plain_machine.STICKING),
        ),
    )
    yield (
        A,
        "A strength {} % off makes the comparison of every effect fail that changes these runs by {} % or more",
        (
            beyond(test_contract.OFF),
            per_cent(test_contract.FEW),
        ),
    )
    bits = signature(nonlinear_reference.measure_all).parameters["bits"].default
    yield (
        A,
        "63 runs of {} s, {} % noise, position in {} bits",
        (
            plain(recovery.SECONDS),
            per_cent(recovery.NOISE),
            bits,
        ),
    )
    yield A, "leaves the linear model {} times the noise", (word(round(recovery.WANTED / recovery.NOISE)),)
    for name, strength in recovery.STRENGTHS.items():
        yield A, "| {} | {:.3g} {} |", (name, strength, EFFECTS_BY_NAME[name].strength.unit)
