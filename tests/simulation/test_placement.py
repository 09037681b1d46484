"""Where buffers happen to lie in memory changes no bit: a job that was killed ends as if it had not been."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.short_form import short_form
from tests.test_imports import ROOT

CODE = """
import itertools
import numpy as np
from ident.chain.conditions import conditions
from ident.linear import LinearModel
from ident.matrix import Actuator
from ident.run import Run, Specimen
from ident.presets import PRESETS, preset
from ident.simulation.intersample_command import ends
from ident.simulation.recursion import LANES, advance, discretise
from ident.simulation.simulate import Simulation

rng = np.random.default_rng(0)
u = 1e-3 * rng.standard_normal(600)
nodes = ends(u).ravel()
model = preset("qian2014", ("dead_zone", "coulomb_friction"))
run = Run("r", "", 4096.0, {"command": u, "displacement": u}, specimen=Specimen(1.0, 3e4), gain=7.0)
known = conditions(run, Actuator("", piston_area=4.97e-4))
values = {p.in_equations: p.value * rng.uniform(0.8, 1.25, LANES) for p in model.parameters} | known
linear = PRESETS["qian2014"].chain.linearise({**values, **{n: np.full(LANES, v) for n, v in known.items()}})
recursion = discretise(linear, 4096.0, "linear")
packed, kernel = recursion.packed(), advance(recursion.C.shape[1])
found = set()
for order in itertools.permutations(("b", "u", "out")):
    for gap in (0, 1, 5, 64):
        sizes = {"b": packed.size, "u": nodes.size, "out": u.size * LANES}
        memory, at, part = np.zeros(sum(sizes.values()) + 4 * 64), 0, {}
        for name in order:
            part[name] = memory[at : at + sizes[name]]
            at += sizes[name] + gap
        part["b"][:], part["u"][:] = packed.ravel(), nodes
        kernel(part["b"], part["u"], 0, len(u), part["out"], LANES)
        found.add(part["out"].tobytes())
kept, simulated = [], set()
for turn in range(40):
    kept.append(np.empty(rng.integers(1, 4000)))
    kept = kept[-15:]
    batch = {n: np.atleast_2d(v) for n, v in values.items()}
    outputs = Simulation(model.chain, (run,), batch).outputs()
    simulated.add(np.concatenate([rows.copy() for rows, _, _ in outputs]).tobytes())
print(len(found), len(simulated))
"""


@pytest.mark.parametrize("processor", short_form(["host", "generic"], "host"))
def test_the_same_bits_come_out_wherever_buffers_lie(processor):
    """On this processor, and compiled for any: a check for overlap that fails in vain must not round otherwise."""
    environment = os.environ | ({"NUMBA_CPU_NAME": "generic"} if processor == "generic" else {})
    done = subprocess.run(
        [sys.executable, "-c", CODE], cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert done.stdout.split() == ["1", "1"], done.stderr
