"""What is said of unstable loops, against an independent loop with an exact delay: servo_reference.py."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.result import Estimate, FitResult
from ident.hybrid.changed_machine import Change
from ident.hybrid.what_if import Before, what_if
from ident.matrix import Actuator
from ident.stability.remedy import Remedy
from tests.stability import servo_reference as reference

UNITS = {"Z0": "m^4/s", "tau": "s", "Cl": "m^3/(s*Pa)", "c0": "N*s/m", "m0": "kg", "Ka": "m^3/Pa"}
NAMES = {"gain": {"Kp", "Z0"}, "T": {"loop_delay.delay"}, "Ka": {"Ka"}, "c0": {"c0"}}


def fit_of(of) -> FitResult:
    """The fit that found the values of a loop."""
    values = {**{n: (of[n], UNITS[n]) for n in UNITS}, "loop_delay.delay": (of["T"], "s")}
    found = {n: Estimate(v, unit, 0.01 * v, 0.0, 10 * v, False) for n, (v, unit) in values.items()}
    return FitResult(
        "qian2014",
        ("loop_delay",),
        found,
        {},
        (),
        (),
        {},
        {},
        {},
        (),
        "ga",
        0,
        0,
        0.0,
        "",
        "",
        actuator=Actuator("A", piston_area=reference.AREA),
    )


def judged(loop, before=None):
    of, gain = loop
    earlier = None if before is None else Before(fit_of(before[0]), before[1])
    return what_if(fit_of(of), Change(), (gain, gain), before=earlier)


def test_frequency_growth_cause_and_remedy_of_unstable_loops(full):
    """Seed 56: the growing mode within 2 %, the cause right in 95 %; the first remedy leaves 3 dB and is smallest."""
    rng, right, trials = np.random.default_rng(56), 0, 200 if full else 3
    for _ in range(trials):
        name, before, after = reference.unstable(rng)
        found, root = judged(after, before), reference.growing(*after)
        (one,) = found.stability
        assert found.state == one.state == "unstable"
        assert one.mode.frequency == pytest.approx(root.imag / (2 * np.pi), rel=0.02)
        assert one.mode.growth == pytest.approx(root.real, rel=0.05, abs=0.1)
        right += bool(one.causes) and {cause.name for cause in one.causes} <= NAMES[name]
        first, factor = one.remedies[0], one.remedies[0].factor
        symbol = {"Kp": "gain", "loop_delay.delay": "T"}.get(first.name, first.name)
        assert reference.margin(*reference.changed(*after, symbol, factor)) >= 3.0
        assert reference.largest_margin(*after, first.size / 1.2) < 3.0
    assert right >= 0.95 * trials


def test_without_the_loop_before_remedies_are_listed_and_no_cause_is_named(full):
    """Seed 57."""
    rng = np.random.default_rng(57)
    for _ in range(100 if full else 2):
        (one,) = judged(reference.unstable(rng)[2]).stability
        assert one.remedies
        assert not one.causes
        assert "cause" not in " ".join(one.text)


def test_nothing_is_said_to_be_unstable_of_stable_loops(full):
    """Seed 58; every fourth has less than 3 dB."""
    rng = np.random.default_rng(58)
    for number in range(200 if full else 3):
        of, gain = reference.drawn(rng)
        gain *= 10 ** ((reference.margin(of, gain) - rng.uniform(0.1, 3.0)) / 20) if number % 4 == 0 else 1.0
        found = judged((of, gain))
        assert found.state == "stable"
        assert not any("nstable" in said for said in found.stability[0].text)
        assert found.stability[0].gain_margin == pytest.approx(reference.margin(of, gain), abs=0.05)


def test_a_quantity_whose_part_has_its_name_is_named_once():
    """As the numerical share of a structure."""
    share = Remedy("share", "numerical share", "", "1", 1.0, 0.5, 0.5, 0.7, None)
    assert str(share).startswith("numerical share × 0.5")
