"""A band-limited command between its samples, against sines that are known at every time."""

from __future__ import annotations

import numpy as np
import pytest

from ident.linear import LinearModel
from ident.presets import PRESETS, preset
from ident.run import Run
from ident.simulation.inputs import fine
from ident.simulation.intersample_command import at_nodes, band_limited, nodes
from ident.simulation.recursion import discretise, respond
from ident.simulation.simulate import responses
from ident.simulation.steps import steps_needed

SAMPLES, MASS, DAMPING, STIFFNESS, CUBE = 400, 1.0, 0.3, 0.5, 0.02
_RNG = np.random.default_rng(7)
OMEGA, PHASE = np.pi * _RNG.uniform(0.02, 0.85, 24), 2 * np.pi * _RNG.random(24)
"""Sines up to 0.85 of half the sample rate, which is 1 Hz."""
SETTLED = slice(150, SAMPLES - 40)  # samples in which neither the beginning nor the end is felt


def sines(t: np.ndarray, response: np.ndarray | float = 1.0) -> np.ndarray:
    """The sines at times (…), each changed by a response (24,)."""
    return np.real(np.exp(1j * (np.multiply.outer(t, OMEGA) + PHASE)) @ (response * np.ones(len(OMEGA))))


def run(**stated: object) -> Run:
    command = sines(np.arange(SAMPLES))
    channels = {"command": command, "displacement": command}
    return Run("r", "", 1.0, channels, hold="band-limited", **stated)  # type: ignore[arg-type]


def values() -> dict[str, np.ndarray]:
    known = {"m0": MASS, "c0": DAMPING, "k0": STIFFNESS, "k": 0.0, "cL": 0.0, "mL": 0.0}
    return {name: np.array([[value]]) for name, value in known.items()}


def answer() -> np.ndarray:
    """The response of mass, damper and spring to each sine."""
    return 1.0 / (STIFFNESS - MASS * OMEGA**2 + 1j * DAMPING * OMEGA)


def test_it_is_met_between_its_samples_and_is_itself_at_them():
    shares = np.array([0.0, 0.13, 0.5, 0.9, 1.0])
    found = band_limited(run(), shares, before=3)[3:]
    inner = slice(32, SAMPLES - 32)
    np.testing.assert_array_equal(found[:, 0], run().command)
    np.testing.assert_allclose(found[inner], sines(np.arange(SAMPLES)[:, None] + shares)[inner], atol=1e-4)
    still = Run(
        "r",
        "",
        1.0,
        {"command": np.full(9, 3.0), "displacement": np.arange(9.0)},
        hold="band-limited",
        assumed_beginning="moving",
    )
    np.testing.assert_allclose(band_limited(still, shares), 3.0, rtol=1e-14)


def test_what_was_commanded_before_the_record_counts():
    """A part of a record, short as it may be, has the command that the whole record has there."""
    whole = at_nodes(run())
    np.testing.assert_allclose(at_nodes(run().part(100, SAMPLES)), whole[100:], atol=1e-13)
    assert at_nodes(run().part(3, 13)).shape == (10, len(nodes("band-limited")))


def test_the_linear_response_is_that_of_every_sine():
    """With what passes at once; lines would be off by 2 %."""
    model = PRESETS["drive"].chain.linearise({name: value[0] for name, value in values().items()}, "displacement")
    direct = LinearModel.of(model.A, model.B, model.C, model.D + 0.4)
    (found,) = respond(discretise(direct, 1.0, "band-limited"), at_nodes(run()))
    expected = sines(np.arange(SAMPLES), answer() + 0.4)
    np.testing.assert_allclose(found[SETTLED], expected[SETTLED], atol=1e-4 * expected.std())


def test_the_simulation_converges_to_the_exact_response():
    """By the fourth power of the step, as its scheme does; with the steps that it asks for it is within 0.1 %."""
    chain, expected = PRESETS["drive"].chain, sines(np.arange(SAMPLES), answer())
    (asked,) = steps_needed(chain, np.array([0.7 + 0j]), "band-limited", (), float(OMEGA.max()))
    off = [np.std((responses(chain, [run()], values(), steps)[:, 0, 0] - expected)[SETTLED]) for steps in (asked, 16)]
    assert off[0] < 1e-3 * expected.std()
    assert off[1] < 2e-5 * expected.std()


def test_a_spring_that_stiffens_is_moved_as_by_the_sines_themselves():
    """Against small steps of a Runge-Kutta scheme that knows the force at every time."""
    parts, expected, x, v = 40, [], 0.0, 0.0
    h, force = 1.0 / parts, sines(np.arange(2 * SAMPLES * parts + 1) / (2 * parts)).tolist()  # at every half step

    def rate(driven: float, x: float, v: float) -> float:
        return (driven - DAMPING * v - STIFFNESS * x - CUBE * x**3) / MASS

    for k in range(SAMPLES * parts):
        expected += [x] if k % parts == 0 else []
        before, middle, after = force[2 * k : 2 * k + 3]
        a = rate(before, x, v)
        vb = v + h / 2 * a
        b = rate(middle, x + h / 2 * v, vb)
        vc = v + h / 2 * b
        c = rate(middle, x + h / 2 * vb, vc)
        vd = v + h * c
        d = rate(after, x + h * vc, vd)
        x, v = x + h / 6 * (v + 2 * vb + 2 * vc + vd), v + h / 6 * (a + 2 * b + 2 * c + d)
    model = preset("drive", ("cubic_stiffness",))
    known = {p.in_equations: np.array([[p.value]]) for p in model.parameters} | values()
    known |= {p.in_equations: np.array([[CUBE]]) for p in model.parameters if p.of == "cubic_stiffness"}
    found = responses(model.chain, [run()], known, 8)[:, 0, 0]
    off = np.std((found - np.array(expected))[SETTLED])
    assert off < 1e-3 * np.std(expected)


@pytest.mark.parametrize("steps", [1, 2, 8])
def test_the_fine_steps_are_the_command_at_the_samples(steps):
    found = fine(run(), "u", steps, 5)
    assert len(found) == 5 + SAMPLES * steps + 3
    np.testing.assert_array_equal(found[5 : 5 + SAMPLES * steps : steps], run().command)


def test_a_delay_of_any_share_of_a_sample_turns_the_phase_of_every_sine():
    late, tau, model = 2.37, 1.2, preset("first_order", ("command_delay",))
    known = {"gain": 1.0, "tau": tau, "command_delay__delay": late}
    found = responses(model.chain, [run()], {name: np.array([[value]]) for name, value in known.items()}, 8)[:, 0, 0]
    expected = sines(np.arange(SAMPLES), np.exp(-1j * OMEGA * late) / (1.0 + 1j * OMEGA * tau))
    assert np.std((found - expected)[SETTLED]) < 1e-3 * expected.std()
