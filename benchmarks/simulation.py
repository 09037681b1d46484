"""Exact time-domain simulation of one run for many parameter vectors, against `lfilter`; one core each."""

from __future__ import annotations

import numpy as np
from scipy.signal import cont2discrete, lfilter

from benchmarks import material, plain_scipy
from benchmarks.table import Table, seconds_of
from ident.chain.conditions import conditions
from ident.presets import PRESETS
from ident.run import Run
from ident.simulation.intersample_command import at_nodes
from ident.simulation.recursion import discretise, respond
from tests.reference import qian_reference as reference

VECTORS, GOAL = 64, 1.2
LFILTER = 16.5
"""ns a sample that the table below shows for `lfilter` on the machine for which goals in seconds are set."""


def slowness() -> float:
    """How much slower this machine is than the one for which goals in seconds are set."""
    run, vectors = _asked()
    (taken,) = seconds_of(lambda: _filtered(run, vectors), repeats=5)
    return 1e9 * taken / VECTORS / run.length / LFILTER


def _asked() -> tuple[Run, np.ndarray]:
    """The run, and the parameter vectors that are sent through it."""
    vectors = reference.Plant()[:6] * np.random.default_rng(0).uniform(0.9, 1.1, (VECTORS, 6))
    return material.matrix().runs[0], vectors


def _filtered(run: Run, vectors: np.ndarray) -> np.ndarray:
    """The outputs as SciPy makes them."""
    outputs = []
    for vector in vectors:
        system = plain_scipy.transfer_function(vector, run)
        b, a, _ = cont2discrete(system, 1 / run.sample_rate, method="foh")
        outputs.append(lfilter(b.ravel(), a, run.command))
    return np.array(outputs)


def measure() -> Table:
    """Time per vector for 30 s of the chain with the command in straight lines between samples."""
    matrix = material.matrix()
    run, vectors = _asked()
    values = dict(zip(reference.PARAMETERS, vectors.T, strict=True)) | conditions(run, matrix.actuator)
    chain = PRESETS["qian2014"].chain

    def ours() -> np.ndarray:
        return respond(discretise(chain.linearise(values), run.sample_rate, run.hold), at_nodes(run))

    def theirs() -> np.ndarray:
        return _filtered(run, vectors)

    exact, plain = ours(), theirs()
    settled = slice(exact.shape[1] // 2, None)  # the two begin differently before the first sample
    agreement = np.max(
        np.std(exact - plain, axis=1, where=np.arange(exact.shape[1]) >= settled.start) / exact.std(axis=1)
    )
    quick, slow = (taken / VECTORS for taken in seconds_of(ours, theirs, repeats=5))
    return Table(
        "Simulation",
        f"30 s at 4096 Hz, {VECTORS} parameter vectors through one run, one core. The two agree within "
        f"{agreement:.0e} of the output's standard deviation once the start has decayed.",
        ("way", "per vector and sample", "times the program's"),
        [
            ("program", f"{1e9 * quick / run.length:.2f} ns", "1"),
            ("SciPy `lfilter`", f"{1e9 * slow / run.length:.2f} ns", f"{slow / quick:.2f}"),
        ],
        f"{GOAL} times as fast as `lfilter`",
        slow >= GOAL * quick,
    )
