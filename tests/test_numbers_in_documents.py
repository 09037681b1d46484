"""Numbers in the documents that decide something in code are the code's.

Each row has the document, a phrase of it with {} for each number, and the numbers as the code has them. A number that
is changed in code, or a phrase that is rewritten, fails here until both agree. Line breaks of the text do not count.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.pages import next_step_view
from ident.bench import acceptance
from ident.bench.criteria import BENCH_CRITERIA
from ident.comparison import frequency_response, profile
from ident.diagnosis.criteria import CRITERIA
from ident.figures import bode, residual_curve, sensitivity, time
from ident.figures import tracking as tracking_figure
from ident.fit import genetic
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.search import Search
from ident.hybrid import (
    compensation,
    ground_motion,
    hybrid_simulation,
    innovation_test,
    inverse,
    kalman,
    loop_shaping,
    oil_column,
    parameter_samples,
    peaks,
    prefilter,
    reduction,
    robustness,
    share_map,
    tracked_run,
    tracking,
    what_if,
)
from ident.preprocessing import run_exclusion
from ident.readers import run
from ident.residuals import correlation, curves
from ident.statistics import FEWEST_SETS
from ident.statistics.control_chart import D2
from ident.statistics.outliers import FAR
from ident.units.quantity import PRINTED_Z0_FACTOR
from tests.numbers_said import PARTS, Tie, beyond, per_cent, plain, within, word
from tests.settings_of_accuracy import of_accuracy, of_accuracy_elsewhere

ROOT = Path(__file__).resolve().parents[1] / "docs"


def _paper_generations() -> int:
    """Of the paper's search as it is set."""
    alone = Search(1, "paper-ga", genetic.PAPER, 0, lambda points: points[:, 0], lambda _: None)
    state = alone.start()
    while not state["done"]:
        state = alone.advance(state, 1)
    return len(state["history"])


def of_diagnosis() -> Iterator[Tie]:
    """What decides in a diagnosis."""
    D = "diagnosis.md"
    yield D, "The first {} are told at once", (word(CRITERIA.ranking.finalists),)
    yield D, "at {} strengths over its range", (word(len(CRITERIA.screening.strengths)),)
    yield (
        D,
        "is more than {} times what these predict is no result",
        (plain(CRITERIA.estimation.simulation_excess),),
    )
    yield (
        D,
        "the {} that predicted most are started from {} points",
        (word(CRITERIA.selection.global_restarts), CRITERIA.estimation.global_points),
    )
    yield D, "The {} best points of each take three steps", (word(CRITERIA.estimation.global_starts),)
    yield (
        D,
        "started from strong effects. Then {} others of the first ranking are tried two at a time",
        (word(CRITERIA.ranking.finalists),),
    )
    yield D, "if the error is more than {} % above the noise floor", (beyond(CRITERIA.evidence.floor_margin),)
    yield D, "rises with it by more than {} of its standard errors", (word(CRITERIA.verification.deviations),)
    yield D, "Errors that differ by less than {} % are a tie", (per_cent(CRITERIA.equality.tie),)
    yield (
        D,
        "whose errors differ by less than {} %: in a flat valley",
        (beyond(CRITERIA.equality.practically_equal),),
    )
    yield D, "Terms that explain the same (cosine above {})", (plain(CRITERIA.discovery.same_class),)
    yield D, "the best {} classes and {} pairs", (word(CRITERIA.discovery.classes), word(CRITERIA.discovery.of_a_kind))
    yield (
        D,
        "the leading {}, with {} that have no shapes",
        (word(CRITERIA.estimation.leading), word(CRITERIA.discovery.of_a_kind)),
    )
    yield D, "place, form and shape that were looked at) + {} nats", (plain(CRITERIA.discovery.log_likelihood_gain),)
    yield D, "Of fewer than {} runs all do all three", (word(CRITERIA.discovery.fewest_runs),)
    yield D, "The next term is sought in addition to it, {} at most", (word(CRITERIA.discovery.most),)
    yield D, "hats at {} quantiles of the signal", (word(len(CRITERIA.discovery.knots)),)
    yield D, "the {} groups that explain most are refitted", (word(CRITERIA.discovery.of_a_kind),)
    yield (
        D,
        "of {}, {} or {} times its slowest other time constant",
        tuple(plain(t) for t in FIT_CRITERIA.windows.times),
    )
    of = CRITERIA.evidence
    yield D, "Of {} runs or more whole runs take turns", (word(CRITERIA.evidence.whole_runs),)
    yield (
        D,
        "in {} folds. Of a single run {} stretches do",
        (
            word(CRITERIA.cross_validation.folds),
            word(CRITERIA.cross_validation.stretches),
        ),
    )
    yield D, "at most {} for a band, at most {} in all", (plain(of.degrees_of_a_band), plain(of.degrees_in_all))
    yield D, "largest gain of all effects on {} residuals", (of.surrogates,)
    yield D, "Half of the largest possible gain", ({0.5: "half"}[of.reaches],)
    yield D, "explains more than a {} of the power above the noise", ({0.01: "hundredth"}[of.share],)
    yield (
        D,
        "blocks of {} correlation times; those of a short record are shorter, but never below {}",
        (
            word(of.correlation_times),
            word(of.least_correlation_times),
        ),
    )
    yield D, "it is also a {} of the unexplained power", ({0.05: "twentieth"}[of.separation],)


def of_others() -> Iterator[Tie]:
    """What decides elsewhere."""
    yield "which-machine.md", "unless that is below {} % of it", (per_cent(CRITERIA.structure.unusual),)
    yield "which-machine.md", "which has no parts, is {} as probable", ({0.5: "half"}[CRITERIA.structure.no_parts],)
    yield "lab.md", "within {} of it there is nothing left to find", (plain(next_step_view.NEAR),)

    P = "physics.md"
    yield (
        P,
        "it keeps the best {} % of each generation, which gives {} generations",
        (
            per_cent(genetic.PAPER["keep"]),
            _paper_generations(),
        ),
    )
    yield P, "draws the mutated {} of each column", ({0.2: "fifth"}[genetic.PAPER["mutation"]],)
    yield P, "so is the mean of the last {} vectors", (word(genetic.PAPER["survivors"]),)
    yield P, "**{}e-6 m⁴/s**", (f"{1.48e1 * PRINTED_Z0_FACTOR:.4g}",)

    B = "bench.md"
    yield (
        B,
        "a delay beyond {} of its standard deviations and {} % of T",
        (
            word(BENCH_CRITERIA.time_constants.delay_deviations),
            per_cent(BENCH_CRITERIA.time_constants.delay_of_lag),
        ),
    )
    yield B, "Quantities: `{}`", (" ".join(acceptance.QUANTITIES),)

    M = "matrix-format.md"
    yield (
        M,
        "({} % of the deviation that the output has in the others, under more than {} of their command",
        (
            per_cent(run_exclusion.STANDS.value),
            PARTS[run_exclusion.DRIVEN.value],
        ),
    )
    yield M, "of at least {} samples; command and output vary", (run.SHORTEST,)
    yield M, "so one of it is 0.0254 m × 6.894757 kPa = {:.6f} m⁴/s", (PRINTED_Z0_FACTOR,)

    yield "line.md", "(σ = mean moving range / {})", (plain(D2),)
    yield "line.md", "(modified z-score beyond {})", (plain(FAR),)
    yield "line.md", "confidence interval, from {} sets on", (FEWEST_SETS,)


def of_hybrid() -> Iterator[Tie]:
    """What decides in tracking, controllers, hybrid simulation and what-if."""
    H = "hybrid.md"
    yield H, "(at most {} rows", (tracked_run.ROWS,)
    yield (
        H,
        "the mean over {} samples is off by {} the parameters have changed",
        (
            plain(kalman.MEMORY),
            plain(kalman.CHANGE),
        ),
    )
    yield H, "at most once in {} samples", (plain(kalman.RESTED),)
    yield H, "is within {} of the sensor's noise there is no motion", (PARTS[kalman.MOTION],)
    yield H, "nor does it from a standard deviation of {} % on", (per_cent(kalman.CAP),)
    yield (
        H,
        "`measurement` is the standard deviation of the sensor's noise, m: {}e-4 m",
        (plain(1e4 * tracking.SENSOR),),
    )
    yield H, "Windows of {} samples are judged", (kalman.WINDOW,)
    yield (
        H,
        "where the mean is above {}, or where neighbours are correlated by more than {}",
        (
            plain(kalman.MOST_NIS),
            plain(kalman.MOST_COLOUR),
        ),
    )
    yield H, "where more than {} of the windows fail", (PARTS[innovation_test._FEW_WINDOWS],)
    yield H, "where more than {} % of the samples were outliers", (per_cent(innovation_test._FEW_SAMPLES),)
    yield H, "smoothed over {} s; until then", (plain(compensation.SMOOTHED_OVER),)
    yield H, "of width {}/ωn unless another is given", (plain(inverse.WIDTH),)
    yield H, "known ahead by {} widths", (word(inverse._REACH),)
    yield H, "that needs more than {} % of the supply pressure is refused", (per_cent(inverse._HIGHEST),)
    yield H, "K∞ with γ = {} γmin", (plain(loop_shaping.FACTOR),)
    yield H, "differ by at most {} dB and {}° to {} Hz", (*map(plain, reduction.CLOSE), plain(reduction.BAND))
    yield (
        H,
        "of at most {} rad/s, with which no frequency is amplified by more than {} dB",
        (
            plain(prefilter.FASTEST),
            plain(prefilter.PEAK),
        ),
    )
    yield H, "{} actuators are drawn from the covariance of the fit", (parameter_samples.DRAWS,)
    yield H, "`within` ± {} dB and ± {}° to {} Hz", (*map(plain, robustness.WITHIN), plain(robustness.HIGHEST))
    yield H, "{shares} × {shares} of them", (share_map.SHARES,)
    yield H, "({} times the largest displacement of the reference)", (plain(hybrid_simulation.RUNAWAY),)
    yield H, "Kp runs from {} to {}.", tuple(map(plain, what_if.USUAL_GAINS))
    yield H, "there is no peak below {} Hz", (plain(what_if.HIGHEST),)
    yield H, "from which the curve falls by {} % on either side", (beyond(peaks.PROMINENCE),)
    yield H, "over all changes up to {} times as large", (plain(oil_column.AS_GOOD),)
    yield (
        H,
        "`{{kind: blwn, band: {} Hz, amplitude: {} g, duration: 30 s, seed: {}}}` (the default)",
        (
            plain(ground_motion.GroundMotion().band[1]),
            plain(ground_motion.GroundMotion().amplitude / ground_motion.GRAVITY),
            ground_motion.GroundMotion().seed,
        ),
    )
    yield H, "else g and {} s), a YAML file", (plain(ground_motion.GroundMotion().step),)


def of_figures() -> Iterator[Tie]:
    """What a figure shows where nothing else is asked for."""
    F = "figures.md"
    yield (
        F,
        "with its {} % band: the {} curves that explain most",
        (
            per_cent(within(curves._BAND)),
            word(residual_curve.SHOWN),
        ),
    )
    yield F, "each with its {} % band (`resid`", (per_cent(correlation.SURE),)
    yield F, "its {} % interval as a band", (per_cent(within(math.sqrt(profile.BOUND))),)
    yield F, "go from {:g} to {:g} times the run's own value", (sensitivity.MULTIPLES[0], sensitivity.MULTIPLES[-1])
    yield F, "of a first-order loop over time in their {} % bands", (per_cent(within(tracking_figure.BAND)),)
    yield F, "shows the validation runs, at most {} of them", (word(bode._ALONE),)
    yield F, "with several gains at most {} columns of {} runs", (word(bode.FACETS), word(bode._EACH))
    yield F, "H1 estimate with windows of {:g} s", (frequency_response._WINDOW,)
    yield F, "smallest and largest sample of each of {} parts", (time.BINS,)


TIED = [*of_diagnosis(), *of_others(), *of_hybrid(), *of_accuracy(), *of_accuracy_elsewhere(), *of_figures()]


@pytest.mark.parametrize(("document", "phrase", "numbers"), TIED, ids=[f"{d}: {p[:40]}" for d, p, _ in TIED])
def test_a_number_in_a_document_is_the_code_s(document: str, phrase: str, numbers: tuple[object, ...]) -> None:
    """The phrase with the code's numbers stands in the document."""
    text = " ".join((ROOT / document).read_text(encoding="utf-8").split())
    assert phrase.replace("{shares}", "{0}").format(*numbers) in text, f"docs/{document} says otherwise"


def test_a_diagnosis_is_told_in_short_sentences() -> None:
    """At most twenty words in the mean."""
    text = (ROOT / "diagnosis.md").read_text(encoding="utf-8")
    sentences = [one for one in re.split(r"(?<=[.!?])\s+|\n\s*\n", text) if one.strip()]
    assert sum(len(one.split()) for one in sentences) <= 20 * len(sentences)
