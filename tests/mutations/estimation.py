"""Defects of the estimation: eq. (17), reduction, covariance, noise floor, diagnosis, the bench's procedures."""

from tests.mutations.mutation import Mutation

_FITNESS = ("tests/acceptance/test_fitness.py",)
_HELD_OUT = ("tests/diagnosis/test_cross_validation.py",)
_NOISE = ("tests/noise/test_noise.py",)
_PROCEDURES = ("tests/bench/test_procedures.py",)

ESTIMATION = (
    Mutation("what-no-model-explains", "ident/fit/reduction.py", "np.sqrt(distance * unit + rest)",
             "np.sqrt(distance * unit)", "the rest dropped from the fast eq. (17)", _FITNESS),
    Mutation("hold-of-the-reduction", "ident/fit/reduction.py", "_recursion(basis, run.sample_rate, run.hold)",
             '_recursion(basis, run.sample_rate, "linear")', "a held command reduced as lines", _FITNESS),
    Mutation("power-of-the-record", "ident/fit/reduction.py", "mean_free = gram[columns, columns]",
             "mean_free = 1.02 * gram[columns, columns]",
             "a factor of 1.02 in what eq. (17) divides by, 1.01 in the error", _FITNESS),
    Mutation("mean-over-runs", "ident/fit/linear_fitness.py", "over_runs(by_run, self.runs)",
             "np.median(by_run, axis=0)", "eq. (17) averaged by the median", _FITNESS),
    Mutation("exact-error", "ident/run.py", "np.sum(self.centred**2)",
             "np.sum((self.measured - 0.99 * self.mean) ** 2)", "the record's mean left in its power",
             ("tests/acceptance/test_fitness.py", "tests/acceptance/test_identification.py")),
    Mutation("scatter-of-the-score", "ident/fit/fitness.py", "-w * term.scores for",
             "-np.sqrt(w) * term.scores for", "runs weighed once where twice is due",
             ("tests/acceptance/test_identification.py",)),
    Mutation("upper-bound-of-the-polish", "ident/fit/levenberg_marquardt.py",
             "led(point, free_step, *way.within, spans)",
             "led(point, free_step, 0.0, 0.5, spans)", "a bound of the search space",
             ("tests/acceptance/test_identification.py",)),
    Mutation("noise-of-a-difference", "ident/noise/floor.py", "0.5 * np.var(difference) for", "np.var(difference) for",
             "a difference of two records has twice the noise", _NOISE),
    Mutation("noise-of-the-spectrum", "ident/noise/floor.py", "np.sqrt(density * nyquist)",
             "np.sqrt(0.5 * density * nyquist)", "one side of the spectrum for two", _NOISE),
    Mutation("repeats-of-one-gain", "ident/noise/repeats.py", "run.specimen, run.gain, run.amplitude",
             "run.specimen, run.amplitude", "runs of two gains taken for repeats", _NOISE),
    Mutation("mean-of-two-commands", "ident/noise/repeats.py", "np.mean((u - v) ** 2)", "np.var(u - v)",
             "commands that differ by a constant taken for one", ("tests/noise/test_repeats.py",)),
    Mutation("folds", "ident/diagnosis/cross_validation.py", "_projected(run, of != fold)",
             "_projected(run, of == fold)", "judged on what was fitted", _HELD_OUT),
    Mutation("step-of-a-fold", "ident/diagnosis/cross_validation.py", "point + steps[fold] for fold in of",
             "point - steps[fold] for fold in of", "the sign of the step to the fit without a fold", _HELD_OUT),
    Mutation("one-run-alone", "ident/diagnosis/evidence/rule.py", "gain = min(evidence.gain, evidence.without)",
             "gain = evidence.gain", "what one run asks for alone", ("tests/diagnosis/test_evidence.py",)),
    Mutation("two-lags", "ident/bench/effect_ranking.py", "if second > model.T else model",
             "if second < model.T else model", "of two lags the shorter is called T",
             ("tests/bench/test_diagnosis.py",)),
    Mutation("phase-of-a-sine", "ident/bench/sine_fit.py", "np.arctan2(found[2], found[1])",
             "np.arctan2(found[1], found[2])", "sine and cosine exchanged", _PROCEDURES),
    Mutation("error-budget", "ident/residuals/budget.py", "whole**2 - part**2", "whole**2 + part**2",
             "the sign in what is left of a part", ("tests/residuals/test_breakdown.py",)),
    Mutation("weights-of-runs", "ident/fit/inverse_dynamics.py", "weights = 1 / np.maximum(deviation",
             "weights = 1 * np.maximum(deviation", "noisy runs weigh most", ("tests/fit/test_inverse_dynamics.py",)),
)  # fmt: skip
"""Defects of the estimation."""
