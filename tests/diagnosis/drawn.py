"""Diagnoses drawn by a seed, of small machines of several kinds: what a recommended fit is tried on.

python -m tests.diagnosis.drawn FOLDER KIND SEED [SEED …]    keeps them in files, which the short form of the test reads
"""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ident.diagnosis import candidate_models
from ident.diagnosis.result import Diagnosis
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.run import Specimen
from ident.workflows import diagnose, identify, simulate
from tests.bench.sets import as_matrix
from tests.blind.any_machine import Lab
from tests.blind.machines import Machine, drawn_plant, matrix_of
from tests.reference import kononykhin_reference as bench
from tests.reference import qian_reference as linear
from tests.reference.outside_reference import Outside, measure_all

KINDS = ("loop", "lab", "unlisted", "label", "simulated")
"""A position loop, a machine of any lab, a term that no list holds, a wrong label, the program's own simulation."""
BENCH = "bench"
HIDDEN = {"dead_zone": 2.5e-4, "coulomb_friction": 60.0, "backlash": 4e-5, "gain_asymmetry": 0.2}
UNLISTED = {"unequal_areas": 0.06, "pressure_gain": 0.08, "gain_drift": 0.3, "position_friction": 150.0}
RANKED = (*HIDDEN, "command_delay", "quadratic_damping")
NOISE, SECONDS = 0.005, 0.25


def matrix(kind: str, seed: int) -> Matrix:
    """The data of one of the kinds, everything else drawn by the seed."""
    rng = np.random.default_rng([41, seed])
    if kind == "lab":
        return Lab.drawn(seed, hidden=True).measured()
    if kind == BENCH:
        truth = bench.scattered(seed)._replace(delay=0.004 * seed % 2, load=0.005 * (seed // 2 % 2))
        return as_matrix(truth, bench.full_set(truth, seed))
    if kind == "unlisted":
        what = str(rng.choice(list(UNLISTED)))
        return _unlisted(Outside(**{what: UNLISTED[what] * float(rng.uniform(0.7, 1.4))}), seed)
    names = rng.choice(list(HIDDEN), size=int(rng.integers(1, 3)), replace=False)
    hidden = {str(name): HIDDEN[str(name)] * float(rng.uniform(0.5, 1.5)) for name in names}
    if kind == "simulated":
        found = simulate(seconds=SECONDS, seed=seed, effects=hidden, small=True)
        return replace(found, runs=found.runs[::3])
    machine = Machine(drawn_plant(rng), hidden, NOISE, small=True, seed=seed)
    return _mislabelled(machine.measured(SECONDS, every=3), rng) if kind == "label" else machine.measured(SECONDS, 6)


def diagnosed(of: Matrix, kind: str, most: int = 2) -> Diagnosis:
    """The diagnosis of such data, with the terms that no list holds where one is hidden."""
    method = "gradient" if kind == BENCH else "ga"
    fit = identify(of, Settings(model={"lab": "", BENCH: "kononykhin"}.get(kind, "qian2014"), method=method))
    propose = kind == "unlisted"
    return diagnose(of, fit, most=0 if propose else most, propose=propose)


def kept(found: Diagnosis) -> dict[str, Any]:
    """What a recommended fit takes of a diagnosis, as JSON."""
    return replace(found, candidates=found.candidates[:1], next_experiment=None, budget=None).to_json()


def _unlisted(hidden: Outside, seed: int) -> Matrix:
    """Twelve runs to fit and three to verify."""
    trials, plant = linear.trials(), linear.Plant()
    chosen = [trial for trial in trials if trial.use == "fit"][::6][:12] + trials[-3:]
    return matrix_of(measure_all(hidden, chosen, plant, seconds=2 * SECONDS, noise=NOISE, seed=seed), plant)


def _mislabelled(of: Matrix, rng: np.random.Generator) -> Matrix:
    """The matrix with a stiffness far from the true one on the label of a run to fit."""
    fitted = of.of_use("fit")
    wrong = fitted[int(rng.integers(len(fitted)))]
    specimen = wrong.specimen or Specimen()
    stiff = replace(wrong, specimen=replace(specimen, stiffness=specimen.stiffness + float(rng.uniform(3e4, 8e4))))
    return replace(of, runs=tuple(stiff if run is wrong else run for run in of.runs))


if __name__ == "__main__":
    candidate_models.CATALOGUE = tuple(effect for effect in candidate_models.CATALOGUE if effect.name in RANKED)
    folder, kind, *seeds = sys.argv[1:]
    for seed in map(int, seeds):
        found = diagnosed(matrix(kind, seed), kind)
        (Path(folder) / f"{kind}-{seed}.json").write_text(json.dumps(kept(found), indent=1) + "\n")
