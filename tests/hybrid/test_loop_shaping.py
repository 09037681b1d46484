"""Loop shaping, judged by a reference that steps plant and controller by themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.errors import Unusable
from ident.hybrid.glover_mcfarlane import robust_stabilisation
from ident.hybrid.loop_shaping import design
from ident.hybrid.margins import margins
from ident.hybrid.rational import Rational
from ident.hybrid.reduction import deviation
from ident.hybrid.sampled_loop import SampledLoop, channels
from ident.hybrid.state_space import sampled_plant
from ident.hybrid.target_loop import QIAN2014_TARGET
from ident.linear import LinearModel
from tests.hybrid.designs import IMPLIED, RATE, STATED, as_model, decibel, degrees, designed, matrices, measured, qian
from tests.reference import controlled_loop_reference as reference

BOTH = pytest.mark.parametrize("specimen", [IMPLIED, STATED], ids=["implied", "stated"])


def rolled(pole):
    """Eq. (19) behind a roll-off."""
    return QIAN2014_TARGET.rational.times(Rational(np.zeros(0, complex), np.array([-pole], complex), pole))


def test_the_largest_margin_of_the_papers_target():
    """γmin of eq. (19) is 2.737, and 2.80 to 2.92 behind a roll-off of 6000 to 2000 rad/s."""
    assert robust_stabilisation(QIAN2014_TARGET.rational.realised(), 1.03).gamma_min == pytest.approx(2.737, abs=0.005)
    for pole, expected in ((6000.0, 2.80), (2000.0, 2.92)):
        assert robust_stabilisation(rolled(pole).realised(), 1.03).gamma_min == pytest.approx(expected, abs=0.006)


def test_the_target_alone_closes_unstable():
    """Its closed poles at 10.2 ± 244i rad/s, so that a robust controller is needed at all."""
    closed = np.roots(np.polyadd(QIAN2014_TARGET.denominator, QIAN2014_TARGET.numerator))
    worst = closed[np.argmax(closed.real)]
    assert (worst.real, abs(worst.imag)) == pytest.approx((10.2, 244), abs=0.5)


def test_the_central_controller_has_the_margin_that_it_promises():
    """sup √((1 + |G|²)(1 + |K|²))/|1 + GK| over frequency is below γ, and above γmin as that of any controller."""
    shaped = rolled(2000.0)
    found = robust_stabilisation(shaped.realised(), 1.03)
    s = 2j * np.pi * np.geomspace(1e-3, 1e5, 20000)
    G, K = shaped.response(s), found.controller.response(s)[:, 0, 0]
    largest = np.sqrt((1 + np.abs(G) ** 2) * (1 + np.abs(K) ** 2)) / np.abs(1 + G * K)
    assert found.gamma_min * 0.999 < largest.max() < found.gamma * 1.001


@BOTH
def test_feedback_follows_as_the_target_allows(specimen):
    """± 0.5 dB to 5 Hz, ± 5° to 10 Hz, sensitivity peak ≤ 2.0, in the sampled loop with one sample of delay."""
    f, T, S, _ = measured(specimen, "feedback")
    assert np.abs(decibel(T))[f <= 5].max() <= 0.5
    assert np.abs(degrees(T))[f <= 10].max() <= 5.0
    assert np.abs(S).max() <= 2.0


@BOTH
def test_feedback_alone_does_not_reach_thirty_hertz(specimen):
    """With eq. (19) the paper's Fig. 18 cannot be had: several dB and some 50° are off at 30 Hz."""
    f, T, _, _ = measured(specimen, "feedback")
    at = np.argmin(np.abs(f - 30))
    assert decibel(T)[at] == pytest.approx(4.4, abs=0.5)
    assert degrees(T)[at] == pytest.approx(-51, abs=3)


@BOTH
def test_a_path_forward_follows_to_twenty_five_hertz(specimen):
    """± 0.5 dB and ± 5° to 25 Hz, and no gain above + 12 dB at any frequency."""
    f, T, S, _ = measured(specimen, "two-degree")
    assert np.abs(decibel(T))[f <= 25].max() <= 0.5
    assert np.abs(degrees(T))[f <= 25].max() <= 5.0
    assert decibel(T).max() <= 12.0
    assert np.abs(S).max() <= 2.0


@pytest.mark.parametrize("structure", ["feedback", "two-degree"])
def test_the_loop_settles(structure):
    """A second after an impulse nothing of it is left: the sampled loop is stable, as its poles say."""
    made = designed(STATED, structure)
    impulse = np.zeros(8192)
    impulse[0] = 1e-3
    x, _ = reference.run(reference.servo_loop(*STATED, 2.0), matrices(made.controller), 1, impulse, np.zeros(8192))
    assert np.abs(x[4096:]).max() < 1e-6 * np.abs(x).max()
    assert made.loop.stable


@pytest.mark.parametrize("structure", ["feedback", "two-degree"])
def test_the_loop_is_what_the_reference_steps(structure):
    """Response, sensitivity and the command's share of the sensor's noise, as the design states them."""
    made, (f, T, S, N) = designed(STATED, structure), measured(STATED, structure)
    used = slice(4, len(f) - 1, 50)
    assert made.loop.response(f[used]) == pytest.approx(T[used], rel=1e-6, abs=1e-9)
    assert made.loop.sensitivity(f[used]) == pytest.approx(S[used], rel=1e-6, abs=1e-9)
    assert made.loop.noise_gain() == pytest.approx(np.sqrt(np.mean(np.abs(N) ** 2)), rel=1e-3)


@BOTH
@pytest.mark.parametrize("structure", ["feedback", "two-degree"])
def test_the_reduced_controller_is_as_good_as_the_whole_one(specimen, structure):
    """Fewer states, and ≤ 0.1 dB, ≤ 1° to 30 Hz between the two: the controllers, and the closed loops."""
    made = designed(specimen, structure)
    f = np.linspace(0.05, 30, 500)
    z = made.loop.points(f)
    whole = SampledLoop(made.plant, made.full, made.delay)
    assert made.controller.order < made.full.order
    for found, wanted in (
        (channels(made.controller, z), channels(made.full, z)),
        (made.loop.response(f), whole.response(f)),
    ):
        in_decibel, in_degrees = deviation(found, wanted)
        assert in_decibel <= 0.1
        assert in_degrees <= 1.0


def test_the_margins_are_where_stability_ends():
    """Just inside a margin the loop is stable, just outside it is not: of gain, and of dead time."""
    made = designed(STATED, "two-degree")
    found = margins(made.loop)
    for share, stable in ((0.98, True), (1.02, False)):
        more = 10 ** (share * found.gain / 20)
        system = made.plant.system.copy()
        system[-1] *= more  # the plant's output
        assert SampledLoop(LinearModel(system), made.controller, 1).stable is stable
        later = 1 + share * found.delay * RATE
        assert SampledLoop(made.plant, made.controller, later).stable is stable
    assert found.phase == pytest.approx(np.degrees(found.delay * 2 * np.pi * 36), rel=0.1)


def test_a_plant_with_a_delay_of_part_of_a_sample_is_sampled_exactly():
    """1.4 samples late at 1 kHz is 7 samples late at 5 kHz under a command that is held for five of them."""
    model = qian(STATED)
    fine, coarse = sampled_plant(model, 5000.0, 7), sampled_plant(model, 1000.0, 1.4)
    command = np.random.default_rng(5).standard_normal(60)

    def outputs(plant, commands):
        state, found = np.zeros(plant.order), []
        for u in commands:
            found.append(float((plant.C @ state)[0]))
            state = plant.A @ state + plant.B[:, 0] * u
        return np.array(found)

    assert outputs(coarse, command) == pytest.approx(outputs(fine, np.repeat(command, 5))[::5], rel=1e-9, abs=1e-15)


def test_zeros_poles_and_gain_are_those_of_the_model():
    """Of a model with four poles and two zeros, at frequencies of its band, and of what is sampled of it."""
    rng = np.random.default_rng(2)
    A = np.diag([-3.0, -20.0, -90.0, -400.0]) @ (np.eye(4) + 0.1 * rng.standard_normal((4, 4)))
    B = np.array([1.0, -2.0, 0.5, 0.0])
    C = rng.standard_normal(4)
    C -= B * (C @ B) / (B @ B)  # C B = 0: the relative degree is 2
    model = LinearModel.of(A, B, C, np.array(0.0))
    found, f = Rational.of_model(model), np.geomspace(0.1, 1e3, 30)
    assert found.relative_degree == 2
    assert found.response(2j * np.pi * f) == pytest.approx(model.frequency_response(f), rel=1e-8)
    sampled, z = found.bilinear(RATE), np.exp(2j * np.pi * f / RATE)
    assert sampled.realised().response(z)[:, 0, 0] == pytest.approx(sampled.response(z), rel=1e-8)


@pytest.mark.parametrize("structure", ["feedback", "two-degree"])
def test_a_plant_with_a_zero_on_the_right_is_not_cancelled_there(structure):
    """A loop delay as a Padé approximant in the plant: the controller is stable, and so is the loop."""
    plant = qian(STATED)
    T = 5e-4
    late = Rational(np.array([2 / T], complex), np.array([-2 / T], complex), -1.0).realised()
    A, B, C = plant.A, plant.B[:, None], plant.C[None, :]
    system = np.block([[A, B @ late.C], [np.zeros((1, 4)), late.A]])
    model = LinearModel.of(system, np.vstack([B @ late.D, late.B])[:, 0], np.hstack([C, [[0.0]]])[0], np.array(0.0))
    made = design(model, RATE, 1, QIAN2014_TARGET, structure)
    f = np.linspace(0.1, 25, 100)
    assert np.abs(np.linalg.eigvals(made.controller.A)).max() < 1
    assert made.loop.stable
    if structure == "two-degree":
        assert np.abs(decibel(made.loop.response(f))).max() <= 0.5
        assert np.abs(degrees(made.loop.response(f))).max() <= 5.0


def test_the_benchmark_of_2020_is_followed_with_the_same_target():
    """An independent plant of fifth order: ± 0.5 dB, ± 5° to 25 Hz, no gain above 12 dB, and on drawn plants stable."""
    nominal = reference.benchmark_2020()
    made = design(as_model(nominal), RATE, 1, QIAN2014_TARGET, "two-degree")
    f, T, _, _ = reference.responses(nominal, matrices(made.controller), 1)
    assert np.abs(decibel(T))[f <= 25].max() <= 0.5
    assert np.abs(degrees(T))[f <= 25].max() <= 5.0
    assert decibel(T).max() <= 12.0
    rng = np.random.default_rng(1)
    for _ in range(20):
        b1, b2, a3, k = (
            425 + 3.3 * rng.standard_normal(),
            9.9976e4 + 3300 * rng.standard_normal(),
            3.3 + 1.3 * rng.standard_normal(),
            1190e3 + 5e4 * rng.standard_normal(),
        )
        other = as_model(reference.benchmark_2020(b1=b1, b2=b2, a3=a3, k=k))
        assert SampledLoop(other, made.controller, 1).stable


@pytest.mark.parametrize("delay", [0, 1.5, 3])
def test_another_delay_is_made_up_for(delay):
    """The path forward knows when its command acts: ± 0.5 dB and ± 5° to 25 Hz, and no gain above 12 dB."""
    made = design(qian(STATED), RATE, delay, QIAN2014_TARGET, "two-degree")
    f = np.geomspace(0.1, 2040, 2000)
    T = made.loop.response(f)
    assert made.loop.stable
    assert decibel(T).max() <= 12.0
    assert np.abs(decibel(T))[f <= 25].max() <= 0.5
    assert np.abs(degrees(T))[f <= 25].max() <= 5.0


@pytest.mark.parametrize("structure", ["feedback", "two-degree"])
def test_a_delay_that_is_too_long_is_refused(structure):
    """10 ms against a loop of 39 Hz: no controller rather than one that is not stable."""
    with pytest.raises(Unusable) as refused:
        design(qian(STATED), RATE, 40, QIAN2014_TARGET, structure)
    assert refused.value.code == "no-controller"


def test_what_no_controller_can_be_designed_for_is_refused():
    """An unstable servo loop, a structure that there is not, a target that no sampled loop can stand."""
    with pytest.raises(Unusable, match="not stable with this specimen"):
        design(qian(STATED, gain=200.0), RATE)
    with pytest.raises(Unusable, match="no structure"):
        design(qian(STATED), RATE, structure="three-degree")
    fast = replace(QIAN2014_TARGET, numerator=(1.2e9,))
    with pytest.raises(Unusable, match="not stable with it"):
        design(qian(STATED), RATE, target=fast)
