"""The reduction of a run: sums in closed form, and Welch's power density, against the same written out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal

from ident.fit.reduction import Basis, reduced
from ident.noise.power_density import power_density
from ident.run import HOLDS, Run
from ident.simulation.intersample_command import at_nodes, ends
from ident.simulation.recursion import discretise, respond, responses

RATE = 1000.0


def run_of(samples: int = 4000, hold: str = "linear") -> Run:
    rng = np.random.default_rng(11)
    command = scipy.signal.lfilter([0.1], [1, -0.9], rng.standard_normal(samples))
    displacement = scipy.signal.lfilter([0.2], [1, -0.8], command) + 0.01 * rng.standard_normal(samples) + 0.3
    command[:60] = displacement[:60] = 0.0
    return Run("r", "", RATE, {"command": command, "displacement": displacement}, hold=hold)


@pytest.mark.parametrize("hold", HOLDS)
@pytest.mark.parametrize("moving", [False, True])
def test_a_reduced_run_has_the_error_that_its_filters_have_sample_by_sample(hold, moving):
    run = run_of(hold=hold)
    run = run.part(700, 3700) if moving else run
    assert run.begins == ("moving" if moving else "at rest")
    basis = Basis(2 * np.pi * 120)
    found = reduced(run, basis)
    g = np.random.default_rng(2).standard_normal(2 * len(basis.nodes))
    filters = discretise(basis.filters, run.sample_rate, run.hold)
    model = (basis.expansion @ g) @ respond(filters, at_nodes(run))
    nuisances = [np.ones(run.length)]
    if moving:
        still = np.zeros_like(filters.gamma)
        released = replace(filters, gamma=still, start=np.eye(2)[np.zeros(len(filters.D), dtype=int)])
        nuisances += list(respond(released, at_nodes(run)))
    basis_of_nuisances = scipy.linalg.orth(np.array(nuisances).T, rcond=1e-6)
    residual = run.measured - model
    residual = residual - basis_of_nuisances @ (basis_of_nuisances.T @ residual)
    expected = np.sqrt(np.sum(residual**2) / np.sum((run.measured - run.measured.mean()) ** 2))
    error = found.errors(g[None], basis)[0][0]
    assert error == pytest.approx(expected, rel=1e-6 if not moving else 1e-4)


@pytest.mark.parametrize("segment", [256, 255, 1000])
def test_the_power_density_is_that_of_scipy(segment):
    signal = 3.0 + np.random.default_rng(5).standard_normal(5000)
    frequency, density = power_density(signal, RATE, segment)
    expected = scipy.signal.welch(signal, RATE, nperseg=segment, detrend="constant")
    np.testing.assert_allclose(frequency, expected[0])
    np.testing.assert_allclose(density, expected[1], rtol=1e-10)


@pytest.mark.parametrize("count", [1, 15, 16, 17, 45])
def test_blocks_of_responses_are_the_whole_with_spare_columns_of_zeros(count):
    rng = np.random.default_rng(count)
    basis = Basis(2 * np.pi * 100)
    systems = discretise(basis.filters, RATE, "linear").part(0, count)
    command = rng.standard_normal(2500)
    blocks = [(rows.copy(), first, last) for rows, first, last in responses(systems, ends(command), spare=2)]
    assert [first for _, first, _ in blocks[1:]] == [last for *_, last in blocks[:-1]]
    assert blocks[-1][2] == len(command)
    rows = np.concatenate([rows for rows, *_ in blocks])
    assert rows.shape[1] >= count + 2
    assert not rows[:, count:].any()
    np.testing.assert_array_equal(rows[:, :count].T, respond(systems, ends(command)))
    for i in {0, count - 1}:
        state, expected = np.zeros(2), []
        for now, then in zip(command, np.append(command[1:], command[-1]), strict=True):
            expected.append(systems.C[i] @ state + systems.D[i] * now)
            state = systems.phi[i] @ state + systems.gamma[i, 0] * now + systems.gamma[i, 1] * then
        np.testing.assert_allclose(rows[:, i], expected, atol=1e-12)
