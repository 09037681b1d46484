"""What is said of unstable hybrid simulations and of servo loops that no controller is designed for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.errors import Unusable
from ident.hybrid.case import Case, qian
from ident.hybrid.controller import no_controller
from ident.hybrid.controller_design import design_controller
from ident.hybrid.hybrid_loop import EarlierCase, judge_hybrid
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.machine import machine
from ident.run import Specimen
from ident.words.engineering import quantity
from tests.hybrid.cases import fitted, noise
from tests.reference import hybrid_reference as reference

RATE, DRIFT = 512.0, 0.01
CHANGED = {"gain": (1.0, 30.0), "delay": (1.0, 20.0), "stiffness": (1.0, 4.0), "c0": (1.0, 1e-3), "Ka": (1.0, 1e3)}
"""What is changed, and the range of factors in which stability is sought to be lost."""
NAMES = {"gain": "gain", "delay": "delay", "stiffness": "specimen stiffness", "c0": "c0", "Ka": "Ka"}
FIXED = ("A",)
Loop = dict[str, float]


def drawn(rng) -> Loop:
    """A loop of a lightly damped structure whose values are within 30 % of Qian's."""
    of = {"gain": 16.0, "delay": 1.0, "M": 87.5, "C": 500.0, "K": 87.5e3, "mass": 4.0, "stiffness": 3e4}
    of |= {**reference.Actuator()._asdict(), "c0": 900.0}
    return {name: value * (1 if name in ("delay", *FIXED) else rng.uniform(0.7, 1.3)) for name, value in of.items()}


def growing(of: Loop) -> complex:
    """The pole (1/s) that is furthest right."""
    actuator = reference.Actuator(*(of[name] for name in reference.Actuator._fields))
    structure, specimen = (
        reference.Structure(of["M"], of["C"], of["K"]),
        reference.Specimen(of["mass"], of["stiffness"]),
    )
    found = reference.poles(RATE, of["gain"], int(of["delay"]), actuator, structure, specimen)
    return complex(found[np.argmax(found.real)])


def unstable(rng) -> tuple[str, Loop, Loop]:
    """A stable loop and the same after one large change, all else within 1 % of what it was."""
    while True:
        name, before = str(rng.choice(list(CHANGED))), drawn(rng)
        factors = np.geomspace(*CHANGED[name], 12)
        lost = [f for f in factors if growing({**before, name: before[name] * f}).real > 0.05]
        if growing(before).real > -0.05 or not lost:
            continue
        moved = {n: v * (1 if n in ("delay", *FIXED) else 1 + DRIFT * rng.uniform(-1, 1)) for n, v in before.items()}
        after = {**moved, name: before[name] * lost[0] ** 1.15}
        if name == "delay":
            after[name] = np.ceil(after[name])
        if growing(after).real > 0.05 and growing({**moved, name: before[name]}).real < -0.02:
            return name, before, after


def as_program(of: Loop) -> EarlierCase:
    """A loop as the program is given it."""
    fit = fitted("qian2014", **{name: of[name] for name in reference.Actuator._fields if name != "A"})
    case = Case(
        "drawn",
        *(np.array([[of[name]]]) for name in ("M", "K", "C")),
        Specimen(of["mass"], of["stiffness"]),
        gain=of["gain"],
        piston_area=of["A"],
        sample_rate=RATE,
        delay=int(of["delay"]),
    )
    return EarlierCase(fit, case)


@pytest.mark.full
def test_frequency_growth_and_cause_of_an_unstable_hybrid_simulation():
    """Seed 561: mode within 2 %; the cause right in 95 %."""
    rng, right, trials = np.random.default_rng(561), 0, 200
    for _ in range(trials):
        name, before, after = unstable(rng)
        (earlier, now), root = map(as_program, (before, after)), growing(after)
        found = judge_hybrid(machine(now.fit, now.case), now.case, no_controller(RATE), earlier)
        assert found.state == "unstable"
        assert found.mode.frequency == pytest.approx(root.imag / (2 * np.pi), rel=0.02)
        assert found.mode.growth == pytest.approx(root.real, rel=0.05, abs=0.05)
        right += NAMES[name] in {cause.name for cause in found.causes}
    assert right >= 0.95 * trials


@pytest.mark.full
def test_a_simulation_names_the_cause_where_the_loop_before_is_known():
    """Qian's structure with little damping, whose servo loop was turned up."""
    case = replace(qian(), damping=np.array([[500.0]]), gain=10.0, ground=noise(0.2))
    fit, fast = fitted(), replace(case, gain=80.0)
    found = simulate_hybrid(fit, fast, before=EarlierCase(fit, case)).stability
    assert [cause.name for cause in found.causes] == ["gain"]
    assert f"The cause is the gain: {found.causes[0]}." in found.text
    assert simulate_hybrid(fit, fast).stability.causes == ()


def test_a_servo_loop_that_no_controller_is_designed_for_names_mode_cause_and_remedy():
    """Qian's loop is lost at Kp = 56.9 without a specimen: frequency by the poles of the reference's rod."""
    fit, specimen = fitted(), Specimen(8.75, 17.5e3)
    given = {"sample_rate": 4096.0, "gain": 200.0, "piston_area": 4.97e-4}
    earlier = EarlierCase(fit, replace(qian(), gain=2.0))
    with pytest.raises(Unusable) as refused:
        design_controller(fit, specimen, **given, before=earlier)
    poles = np.linalg.eigvals(reference.rods(reference.Actuator(), reference.Specimen(), 200.0)[0])
    frequency = abs(poles[np.argmax(poles.real)].imag) / (2 * np.pi)
    assert refused.value.code == "unstable-plant"
    assert f"oscillation at {quantity(frequency, 'Hz')}" in refused.value.what
    assert "the cause is the gain: " in refused.value.what
    assert refused.value.remedy.startswith("for a gain margin of 3 dB, the smallest change first: ")
    with pytest.raises(Unusable) as alone:
        design_controller(fit, specimen, **given)
    assert "cause" not in alone.value.what
