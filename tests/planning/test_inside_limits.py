"""Every command of a plan, played on an independent reference that differs from the model, keeps every limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.errors import Unusable
from ident.fit.result import Estimate
from ident.planning.files import columns_of
from ident.planning.plan import AIM, plan
from ident.rig.limits import RigLimits
from tests.planning.rigs import PROGRAM, another, drawn_plant, drawn_rig, fit_of, peaks
from tests.reference.qian_reference import Cell, Plant

SMALL, FULL = 6, 200  # rigs
SEED = 56
ONE = {"gains": [7], "amplitudes": ["0.05 in"], "seconds": "1 s"}
WIDE, TIGHT = RigLimits(speed=5.0), RigLimits(speed=0.2, force=1e4)


def test_drawn_rigs_are_kept_inside_and_used(full):
    """Parameters within ± 20 %: no limit is left, and of the runs that were scaled the median takes 60 % and more."""
    shares, program = [], PROGRAM if full else {**PROGRAM, "gains": [7], "amplitudes": ["0.1 in"]}
    for number in range(FULL if full else SMALL):
        rng = np.random.default_rng([SEED, number])
        plant = drawn_plant(rng)
        rig, true = drawn_rig(plant, rng), another(plant, rng)
        planned = plan(program, fit_of(plant), rig, seconds=1.0, seed=number, least=1e-3)
        for run in planned.runs:
            cell = Cell(run.specimen.mass, run.specimen.stiffness, run.specimen.damping, run.gain)
            worst = rig.utilisation(peaks(true, cell, 1e-3 * columns_of(run)[0]["command_mm"]))[0]
            assert not worst.exceeded, f"rig {number}, run {run.id}: {worst}"
            shares += [worst.share] if run.scale < 1 else []
    print(f"{len(shares)} runs scaled, median share {np.median(shares):.3f}, largest {max(shares):.3f}")
    assert np.median(shares) >= 0.6


def test_a_run_that_fits_stays_as_it_is_asked():
    """No limit is near: the amplitude is the program's."""
    (run,) = plan(ONE, fit_of(Plant()), WIDE).runs
    assert run.scale == 1
    assert run.share < 0.2


def test_a_run_is_scaled_to_its_tightest_limit():
    """A linear machine's peaks go with the amplitude: the share is what is aimed at."""
    (run,) = plan(ONE, fit_of(Plant()), TIGHT).runs
    assert (run.limit, run.share) == ("speed", pytest.approx(AIM))
    assert 0.1 < run.scale < 0.9


def test_what_cannot_be_is_refused_with_the_factor():
    """A least share of 1 leaves no amplitude to be changed; the factor is the scale that would do."""
    (scaled,) = plan(ONE, fit_of(Plant()), TIGHT).runs
    with pytest.raises(Unusable, match=f"shrink its amplitude to {scaled.scale:.3g} times") as refused:
        plan(ONE, fit_of(Plant()), TIGHT, least=1.0)
    assert refused.value.code == "beyond-limits"
    made = plan({**ONE, "amplitudes": ["0.001 in", "0.05 in"]}, fit_of(Plant()), TIGHT, least=1.0)
    assert [one.factor for one in made.refused] == [pytest.approx(scaled.scale, rel=0.3)]
    assert len(made.runs) == 1


def test_a_loop_that_a_corner_makes_unstable_is_refused():
    """No amplitude helps, so no factor is named."""
    made = plan({**ONE, "gains": [7, 54]}, fit_of(Plant()), WIDE)
    assert [run.gain for run in made.runs] == [7]
    assert [(one.factor, "unstable" in one.why) for one in made.refused] == [(None, True)]


def test_without_a_model_the_command_alone_is_judged_and_that_is_said():
    """Its rate is held against the speed; of a pressure nothing is known."""
    made = plan(ONE, rig=RigLimits(speed=0.5, supply_pressure=2e7))
    (run,) = made.runs
    command = 1e-3 * columns_of(run)[0]["command_mm"]
    assert np.abs(np.diff(command)).max() * 4096 == pytest.approx(AIM * 0.5, rel=1e-6)
    assert any("commands alone" in one for one in made.sentences())
    assert made.unjudged == ("supply_pressure",)


def test_a_machine_that_is_not_linear_is_simulated():
    """An opening that saturates at 5 mm leaves more amplitude within the speed than the linear part alone."""
    fit = fit_of(Plant())
    bend = {"flow_saturation.inverse_opening": Estimate(200.0, "1/m", None, 0.0, 300.0, False)}
    saturated = replace(fit, effects=("flow_saturation",), parameters={**fit.parameters, **bend})
    linear, found = (plan(ONE, one, TIGHT).runs[0] for one in (fit, saturated))
    assert found.share <= AIM * 1.001
    assert found.scale > linear.scale
