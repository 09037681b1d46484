"""Laws of parameters over conditions, against oils drawn by the laws themselves (seeds 576 to 579)."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from scipy import stats

from ident.statistics import FEWEST_FOR_LAW, condition_laws
from tests.reference.viscosity_reference import COLD, HOT, drawn_law, drawn_sets, walther

KINDS = ("Arrhenius", "Walther")


def test_the_reference_has_the_viscosity_of_a_published_oil():
    """An ISO VG 46 oil of 46 mm²/s at 40 °C and 6.8 at 100 °C has about 29 mm²/s at 50 °C by the chart of ASTM D341."""
    assert walther(46.0, 6.8)(323.15) == pytest.approx(29.9, abs=0.5)


def test_the_band_holds_the_law_and_a_verdict_at_60_degrees_is_not_wrong(full):
    """30 sets at −20 to 80 °C, 5 % scatter; limits within ± 10 % of the truth at 60 °C, where verdicts are hard.

    The long form counts the coverage at eleven temperatures; the short one has too few draws for it, and counts the
    law that is chosen, verdicts, and a coverage that no sound band misses (99.99 %).
    """
    draws, rng = (500 if full else 16), np.random.default_rng(576)
    grid = np.linspace(COLD, HOT, 11)
    covered, chosen, outcomes, held = [], Counter(), Counter(), 0
    for draw in range(draws):
        kind = KINDS[draw % 2]
        truth = drawn_law(rng, kind)
        law = condition_laws(*drawn_sets(rng, truth, 30, 0.05), temperature=True)[0]
        levels = [(law.at(kelvin), truth(kelvin)) for kelvin in grid]
        covered.append([level.lower <= true <= level.upper for level, true in levels])
        chosen[kind, law.name] += 1
        held += law.holds
        for limit in truth(333.15) * rng.uniform(0.9, 1.1, 10):
            outcomes[_verdict(law, limit, truth(333.15))] += 1
    assert chosen["Arrhenius", "Arrhenius"] + chosen["Walther", "Walther"] >= 0.97 * draws
    assert held >= 0.97 * draws - 2
    assert outcomes["wrong"] <= 0.01 * outcomes.total()
    assert outcomes["far"] == 0
    if full:
        assert np.all((np.mean(covered, axis=0) >= 0.93) & (np.mean(covered, axis=0) <= 0.97))
    else:
        assert np.mean(covered) > 0.80


def _verdict(law, limit, true):
    """Whether what is said at 60 °C of an upper limit is right, wrong, left open near it, or left open far from it."""
    level = law.at(333.15)
    away = (level.value - limit) / level.std_error
    if abs(away) < law.sure:
        return "open" if abs(away) <= 3 else "far"
    return "right" if (away > 0) == (true > limit) else "wrong"


def test_a_line_is_that_of_linear_regression():
    """Of values of both signs: value, standard error and band are those of SciPy's regression."""
    rng = np.random.default_rng(577)
    x = rng.uniform(150e5, 280e5, 20)
    y = 3e-7 * (x - 200e5) + 0.3 * rng.standard_normal(20)
    law = condition_laws(x, y)[0]
    judge = stats.linregress(x - 210e5, y)
    level = law.at(210e5)
    assert (law.name, law.relative) == ("linear", False)
    assert (level.value, level.std_error) == pytest.approx((judge.intercept, judge.intercept_stderr), rel=1e-6)
    assert level.upper - level.value == pytest.approx(stats.t.ppf(0.975, 18) * judge.intercept_stderr, rel=1e-6)
    assert law.change(200e5, 210e5).shift == pytest.approx(10e5 * judge.slope, rel=1e-6)


def test_what_does_not_depend_on_a_condition_is_constant():
    """BIC takes a line for a constant in about one case of fifteen (χ² above ln 30); of 100 draws at most 15."""
    rng = np.random.default_rng(578)
    names = Counter(
        condition_laws(rng.uniform(COLD, HOT, 30), 5 * (1 + 0.05 * rng.standard_normal(30)))[0].name for _ in range(100)
    )
    assert names["constant"] >= 85


def test_a_law_that_the_sets_contradict_does_not_hold():
    """A parameter with a maximum at 30 °C: each law is tried, none holds."""
    rng = np.random.default_rng(579)
    kelvin = rng.uniform(COLD, HOT, 30)
    values = (2.0 - ((kelvin - 303.15) / 50) ** 2) * (1 + 0.02 * rng.standard_normal(30))
    assert not condition_laws(kelvin, values, temperature=True)[0].holds


def test_few_sets_and_one_condition_have_no_law_of_it():
    """Four sets have none; five at one temperature have a mean only; exact values have no scatter and hold."""
    assert condition_laws([290.0] * (FEWEST_FOR_LAW - 1), [1.0, 2.0, 3.0, 4.0]) == ()
    only = condition_laws([290.0] * 5, [1.0, 1.1, 0.9, 1.0, 1.05], temperature=True)
    assert [law.name for law in only] == ["constant"]
    exact = condition_laws([280.0, 290.0, 300.0, 310.0, 320.0, 330.0], [3.0] * 6, temperature=True)
    assert all(law.holds for law in exact)
    assert exact[0].at(300.0).value == pytest.approx(3.0)
