"""The run that the lab should add: where the models in question differ most after refitting, or teach most.

With y_a, y_b the outputs of two models, J the sensitivities of b, σ the noise and H what the runs there are say of b's
parameters, the models differ after refitting b to first order, H holding it back, by

    χ² = min over δ within the bounds of |y_a − y_b − J δ|²/σ² + δᵀ H δ

and √χ² is the separation in standard deviations. With G = JᵀJ/σ² a run tells
½ ln det(I + H⁻¹G) nats of the parameters (D-optimality).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from ident.design.candidate_runs import candidate_runs
from ident.design.excitation import KINDS
from ident.design.experiment import Experiment
from ident.design.inside_rig import inside_rig, machines_of, proposed_inside
from ident.design.rival import PRIOR, Rival, deviation_of_noise
from ident.design.rivals import Rivals
from ident.errors import Unusable
from ident.fit.bounded_step import bounded_step
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.reduction import excited_band
from ident.matrix import Matrix
from ident.parallel import each
from ident.preprocessing import prepare
from ident.rig.limits import RigLimits
from ident.run import Run
from ident.words.message import message, said

Array = NDArray[np.float64]
_TRIAL = 4096  # samples on which runs are judged
_SURE = 1e4  # χ² beyond which a pair is apart and does not count more
_SEPARATE = 1.0  # standard deviations below which telling models apart is hopeless, and knowledge is sought instead
_RUNAWAY = 10.0  # times the command's size: the model does not hold there


@dataclass(frozen=True)
class Worth:
    """What a run is expected to tell: χ² of each pair of models, and the Fisher information of each model's own."""

    experiment: Experiment
    pairs: Array
    information: float
    std_errors: Mapping[str, float]

    @property
    def separation(self) -> float | None:
        """Standard deviations between the two models that are closest."""
        return float(np.sqrt(self.pairs.min())) if len(self.pairs) else None

    @property
    def rank(self) -> tuple[float, float]:
        """The larger the better: pairs told apart, each up to certainty; then by how much."""
        return float(np.minimum(self.pairs, _SURE).sum()), float(self.pairs.sum())


def propose(in_question: Rivals, matrix: Matrix, seed: int = 0) -> Experiment:
    """The best further run for the models in question. Raises Unusable where there is none, or none can be run."""
    rivals = _rivals(in_question, matrix)
    worths = _judged(rivals, _candidates(rivals, seed))
    if not worths:
        raise Unusable(
            "no-experiment",
            "the models are unstable in every run that could be proposed",
            "models",
            "fit the models again",
        )
    pairs = [worth.separation or 0.0 for worth in worths]
    so_far = _so_far(rivals)
    tells_apart = max(pairs) >= _SEPARATE
    best = max(worths, key=lambda w: w.rank) if tells_apart else max(worths, key=lambda w: w.information)
    typical = float(np.median(pairs)) if len(rivals) > 1 else None
    found = replace(
        best.experiment,
        separation=best.separation,
        so_far=so_far,
        typical=typical,
        information=best.information,
        std_errors=best.std_errors,
    )
    return _within_rig(replace(found, text=_text(found, rivals, tells_apart)), rivals, tells_apart)


def ranked(in_question: Rivals, matrix: Matrix, seed: int = 0) -> list[Worth]:
    """Every run that was weighed, the one that separates the models best first."""
    rivals = _rivals(in_question, matrix)
    worths = _judged(rivals, _candidates(rivals, seed))
    return sorted(worths, key=lambda worth: worth.rank, reverse=True)


def _candidates(rivals: Sequence[Rival], seed: int) -> list[Experiment]:
    """The runs that are weighed, inside the limits of the rig where the matrix states any."""
    found, first = list(candidate_runs(rivals[0].matrix, rivals[0].band, seed)), rivals[0].matrix.runs[0]
    limits = _rig(rivals[0].matrix)
    if limits is None or not found:
        return found
    short = min(_TRIAL / first.sample_rate, found[0].seconds)
    return inside_rig(found, machines_of(rivals), limits, lambda one: _run(one.lasting(short), "trial", first))


def _within_rig(found: Experiment, rivals: Sequence[Rival], tells_apart: bool) -> Experiment:
    """The run that is proposed, made smaller where effects or its length ask for it; its text says what it takes."""
    limits, first = _rig(rivals[0].matrix), rivals[0].matrix.runs[0]
    if limits is None:
        return found
    kept, takes = proposed_inside(found, machines_of(rivals), limits, lambda one: _run(one, "next", first))
    said = "No limit of the rig can be judged." if takes is None else f"Inside the limits of the rig: {takes}."
    return replace(kept, text=f"{said} {_text(kept, rivals, tells_apart)}")


def _rig(matrix: Matrix) -> RigLimits | None:
    """The limits that the matrix states under `rig`; None where there are none, or the period is unknown."""
    stated = matrix.actuator.rig is not None and matrix.runs[0].time_unit == "s"
    return matrix.actuator.rig_limits if stated else None


def _rivals(in_question: Rivals, matrix: Matrix) -> list[Rival]:
    """Each model with what the trusted runs of the matrix say of it."""
    noise, trusted = in_question.noise, in_question.trusted(matrix)
    if not in_question.models:
        raise Unusable("no-model", "no model was given", "models", "give at least one fitted model")
    if not 0 < noise < np.inf:
        raise Unusable("bad-value", f"noise {noise:g}", "noise floor", "give a positive share of the output")
    found = []
    for preset, values in in_question.models:
        suited, driven = prepare(preset, trusted, switches=in_question.preprocessing)
        runs = driven.of_use("fit")
        band = excited_band(runs)
        found.append(Rival(suited, dict(values), driven, band, deviation_of_noise(runs, band, noise)))
    return found


# What a run would tell --------------------------------------------------------------------------------------------


def _judged(rivals: Sequence[Rival], experiments: Sequence[Experiment]) -> list[Worth]:
    if not experiments:
        return []
    first = rivals[0].matrix.runs[0]
    length = min(_TRIAL / first.sample_rate, experiments[0].seconds)
    runs = [_run(e.lasting(length), str(i), first) for i, e in enumerate(experiments)]
    outputs = each(lambda rival: rival.outputs(runs), rivals)
    sound = [i for i, run in enumerate(runs) if all(_sound(y[run.id], run) for y in outputs)]
    if not sound:
        return []
    kept = [runs[i] for i in sound]
    pairs = _pairs(rivals, kept, outputs, experiments[0].seconds / length)
    told = list(zip(rivals, outputs, strict=True))
    own = each(lambda one: one[0].normal_matrices(_recorded(kept, one[1])), told)
    worths = []
    for place, i in enumerate(sound):
        tells = [
            _told(c, m[place], runs[i], y, experiments[i].seconds / length)
            for c, m, y in zip(rivals, own, outputs, strict=True)
        ]
        worths.append(Worth(experiments[i], pairs[place], min(t[0] for t in tells), tells[0][1]))
    return worths


def _run(experiment: Experiment, name: str, like: Run) -> Run:
    """A run that was not recorded yet: of its output nothing is known but that it is still."""
    command = experiment.command()
    still = np.zeros(len(command))
    channels = {"command": command, like.output: still, "force": still}
    return Run(
        name,
        "",
        experiment.sample_rate,
        channels,
        like.units,
        like.time_unit,
        experiment.specimen,
        experiment.gain,
        kind=KINDS[experiment.signal],
        hold=like.hold,
        output=like.output,
        assumed_beginning="at rest",
    )


def _sound(y: Array, run: Run) -> bool:
    size = np.std(run.command) if run.output == "displacement" else np.inf
    return bool(np.all(np.isfinite(y)) and 0 < np.std(y) < _RUNAWAY * size)


def _recorded(runs: Sequence[Run], outputs: Mapping[str, Array]) -> list[Run]:
    """The runs as if a model were the machine."""
    return [
        replace(run, channels={**run.channels, run.output: outputs[run.id]}, assumed_beginning=None) for run in runs
    ]


def _pairs(
    rivals: Sequence[Rival], runs: Sequence[Run], outputs: Sequence[Mapping[str, Array]], longer: float
) -> Array:
    """χ² of each run and each pair of models, (runs, pairs), the mean of both being the machine."""
    found: dict[frozenset[int], Array] = {}
    two = list(permutations(range(len(rivals)), 2))
    beside = each(lambda ab: rivals[ab[1]].normal_matrices(_recorded(runs, outputs[ab[0]])), two)
    for (a, b), moments in zip(two, beside, strict=True):
        sigma = [rivals[b].deviation(float(np.std(outputs[a][run.id]))) for run in runs]
        known, point = rivals[b].information, rivals[b].point
        chi = [_chi_squared(longer * m.gram / s**2, known, point) for m, s in zip(moments, sigma, strict=True)]
        key = frozenset((a, b))
        found[key] = found.get(key, 0.0) + 0.5 * np.array(chi)
    return np.array(list(found.values())).T.reshape(len(runs), -1)


def _chi_squared(gram: Array, known: Array, point: Array) -> float:
    """What is left of the products of [J, r], in units of the noise, after the refit within the bounds."""
    if not np.all(np.isfinite(gram)):
        return 0.0
    H, g = gram[:-1, :-1] + known, gram[:-1, -1]
    step = bounded_step(point, H, -g)
    return max(0.0, float(gram[-1, -1] - 2 * g @ step + step @ H @ step))


def _told(
    rival: Rival, m: NormalMatrices, run: Run, outputs: Mapping[str, Array], longer: float
) -> tuple[float, dict[str, float]]:
    """Nats that a run tells of a model's parameters, and the share of each standard error that is left."""
    p, sigma = len(rival.point), rival.deviation(float(np.std(outputs[run.id])))
    gram = longer * m.gram[:p, :p] / sigma**2
    if not np.all(np.isfinite(gram)):
        return 0.0, {}
    before, after = rival.information, rival.information + gram
    nats = 0.5 * (np.linalg.slogdet(after)[1] - np.linalg.slogdet(before)[1])
    left = np.sqrt(np.diag(np.linalg.inv(after)) / np.diag(np.linalg.inv(before)))
    return float(nats), {name: float(share) for name, share in zip(rival.names, left, strict=True)}


def _so_far(rivals: Sequence[Rival]) -> float | None:
    """The separation of the closest models by the runs there are, the mean of both being the machine."""
    if len(rivals) < 2:
        return None
    found: dict[frozenset[int], float] = {}
    for (i, a), (j, b) in permutations(enumerate(rivals), 2):
        runs = [run for run in b.runs if run.begins == "at rest"]
        outputs = a.outputs(runs) if runs else {}
        if not runs or not all(_sound(outputs[run.id], run) for run in runs):
            return None
        moments = b.normal_matrices(_recorded(runs, outputs))
        sigma = [b.deviation(float(np.std(outputs[run.id]))) for run in runs]
        gram = np.sum([m.gram / s**2 for m, s in zip(moments, sigma, strict=True)], axis=0)
        longer = sum(run.length for run in b.matrix.of_use("fit")) / sum(run.length for run in runs)
        chi = _chi_squared(longer * gram, PRIOR * np.eye(len(b.point)), b.point)
        found[frozenset((i, j))] = found.get(frozenset((i, j)), 0.0) + 0.5 * chi
    return float(np.sqrt(min(found.values())))


def _text(found: Experiment, rivals: Sequence[Rival], tells_apart: bool) -> str:
    run = message("run.next", conditions=found.conditions)
    if tells_apart and found.separation is not None:
        names = [" + ".join(e.name for e in c.preset.effects) or "no effect" for c in rivals]
        apart = message("run.separates", models=names, separation=found.separation)
        usual = message("run.typical", typical=found.typical or 0.0)
        so_far = [] if found.so_far is None else [message("run.so_far", so_far=found.so_far)]
        return said([run, apart, usual, *so_far])
    best = sorted(found.std_errors.items(), key=lambda item: item[1])[:2]
    errors = [message("run.std_error", share=share, name=name) for name, share in best]
    inseparable = [message("run.inseparable")] if len(rivals) > 1 else []
    gain = message("run.information", information=found.information)
    return said([run, *inseparable, gain, message("run.std_errors", errors=errors)])
