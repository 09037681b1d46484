"""Machines of many kinds: what is hidden is what it says, and of the records that are kept the page is made."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lsim

from ident.checks.missing_input import missing_inputs
from ident.checks.self_oscillation import self_oscillation
from tests.blind.campaign import rows
from tests.blind.levers import Levers
from tests.blind.loops import Loop
from tests.blind.various import KINDS, Various, sound
from tests.blind.various_table import ROWS, rates
from tests.short_form import short_form

DRAWN = {kind: next(of for seed in range(400) if (of := Various.drawn(seed, True)).kind == kind) for kind in KINDS}


@pytest.mark.parametrize("kind", ["motor", "mass"])
def test_a_machine_with_nothing_hidden_answers_as_the_linear_one(kind):
    """T w' + w = u, and x'' + 2 D W x' + W² x = W² u, straight between the samples, by SciPy's own simulation."""
    of = next(m for seed in range(400) if (m := Various.drawn(seed, False)).kind == kind and m.hold == "linear")
    u, w = of.command(np.random.default_rng(1)), of.quick
    system = ([30.0 * w], [1.0, w]) if kind == "motor" else ([0.01 * w * w], [1.0, 2 * of.damping * w, w * w])
    start = {"motor": [of.level / w], "mass": [0.0, of.level / w**2]}[kind]
    _, wanted, _ = lsim(system, u, np.arange(len(u)), X0=start)
    np.testing.assert_allclose(of.answered(u), wanted, atol=2e-4 * wanted.std())


@pytest.mark.parametrize("kind", short_form(KINDS, *[*KINDS][::3]))
def test_what_is_hidden_shows(kind):
    """Beyond a hundredth of the output."""
    of = DRAWN[kind]
    u = of.command(np.random.default_rng(1))
    hidden, bare = of.answered(u), sound(of).answered(u)
    assert np.all(np.isfinite(hidden))
    assert np.std(hidden - bare) > 0.01 * bare.std()


@pytest.mark.parametrize("seed", [168801, 168802, 168803])
def test_a_lever_that_is_missing_and_a_loop_that_oscillates_are_said(seed):
    """Of few seeds; `python -m tests.blind.various_trial 168801 169000 --checks` counts those of many."""
    lacking, whole = Levers.drawn(seed, missing=True), Levers.drawn(seed, missing=False)
    assert missing_inputs(lacking.run("fit")) or not lacking.shown
    assert not missing_inputs(whole.run("fit"))
    assert self_oscillation(Loop.drawn(seed, stable=True).run("fit")) is None


@pytest.mark.parametrize("seed", [180102, 180166])
def test_a_few_delayed_answers_and_a_stray_start_miss_no_input(seed):
    """Levers that are all recorded, 100 Hz: the drive is late, and filtered noise crosses the limit once or twice."""
    assert not missing_inputs(Levers.drawn(seed, missing=False).run("fit"))


def test_the_table_counts_what_is_kept():
    text, kept = "\n".join(rates(rows(ROWS))), [row for row in rows(ROWS) if "checks" not in row]
    assert len({row["seed"] for row in kept}) == len(kept) >= 10
    lacking = [row["named"] for row in kept if row["hidden"] == "missing input" and row["shown"]]
    assert f"| a missing input said | {sum(lacking)} of {len(lacking)} |" in text
