"""Each number of the search for terms decides a case that lies within a third of it."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis.discovery import characteristic_plot
from ident.diagnosis.discovery.characteristic_plot import _explained_share, characteristic_view
from ident.diagnosis.discovery.free_curves import FreeCurve, free_curves, offered
from ident.diagnosis.discovery.regression import Regression, _alone
from ident.diagnosis.discovery.regressors import _within
from ident.diagnosis.discovery.run_data import samples_of_each
from ident.diagnosis.discovery.search import TermSearch, _chosen, _parts, least_gain
from ident.diagnosis.discovery.term import Curve, Shape, Term
from ident.diagnosis.discovery.term_candidate import TermCandidate, term_candidates
from ident.diagnosis.discovery.term_evidence import TermEvidence, _of_run
from ident.diagnosis.discovery.term_library import TermLibrary
from ident.diagnosis.discovery.term_to_effect import definition, searched_bounds
from ident.fit.multiple_shooting import ShootingWindows
from ident.presets import preset
from ident.run import Run

UNITS = {"w": "m", "Q": "m^3/s", "P": "Pa", "v": "m/s", "x": "m", "R": "N", "e": "m", "Ke": "m^3/Pa", "t": "s"}


def regressed(terms: Sequence[Term], gains: Sequence[float], products: np.ndarray | None = None) -> Regression:
    """A regression of terms that each take a share off a residual of power one; of no part in each other."""
    of = np.eye(len(terms)) if products is None else products
    return Regression(tuple(terms), of, np.sqrt(np.array(gains) * np.diag(of)), 1.0, len(terms))


def of_load(kind: str, shapes: tuple[Shape, ...] = (), text: str = "") -> Term:
    return Term("load", "R", text or f"{kind} * v", kind, ("v",), {"m": 1.0, "s": -1.0}, shapes)


# Classes and candidates


def test_the_six_best_classes_are_refitted():
    terms = [of_load(str(n)) for n in range(9)]
    found, _ = term_candidates(regressed(terms, np.linspace(0.5, 0.1, 9).tolist()), UNITS)
    assert [one.terms[0] for one in found] == terms[:6]


@pytest.mark.parametrize(("gain", "refitted"), [(0.29, False), (0.21, False), (0.36, True)])
def test_a_kind_with_a_shape_is_refitted_where_it_gains_half_of_the_best(gain, refitted):
    """The best gains 0.6; six others are refitted before it."""
    terms = [*(of_load(str(n)) for n in range(6)), of_load("late", (Shape("T", 0.1, "s"),))]
    found, _ = term_candidates(regressed(terms, [0.6, *[0.5] * 5, gain]), UNITS)
    assert ("late" in [one.terms[0].kind for one in found]) is refitted


def of_pairs(shares: Sequence[float]) -> Regression:
    """A term at the spool, and terms at the load that explain together with it so much of the residual each."""
    places = ["spool", *["load"] * len(shares)]
    terms = [Term(place, "w", f"{n} * w", str(n), ("w",), {"m": 1.0}) for n, place in enumerate(places)]
    with_residual = np.array([0.5, *(np.sqrt(2.0 * share) - 0.5 for share in shares)])
    return Regression(tuple(terms), np.eye(len(terms)), with_residual, 1.0, len(terms))


@pytest.mark.parametrize(
    ("shares", "count"),
    [([0.6, 0.59, 0.58, 0.57, 0.56, 0.55], 4), ([0.6, 0.36], 2), ([0.6, 0.24], 1)],
)
def test_four_pairs_at_most_are_refitted_and_none_that_gains_less_than_half_of_the_best(shares, count):
    found, _ = term_candidates(of_pairs(shares), UNITS)
    assert len([one for one in found if len(one.terms) == 2]) == count


@pytest.mark.parametrize(("cosine", "classes"), [(0.99885, 2), (0.99915, 1)])
def test_two_terms_are_one_class_where_the_data_cannot_tell_them_apart(cosine, classes):
    found = regressed([of_load("a"), of_load("b")], [0.5, 0.49], np.array([[1.0, cosine], [cosine, 1.0]]))
    assert len(found.classes()) == classes


@pytest.mark.parametrize(("more", "first"), [(3e-9, 0), (5e-8, 1)])
def test_the_reductions_of_two_terms_differ_from_the_eighth_digit_on(more, first):
    found = regressed([of_load("a"), of_load("b")], [0.5, 0.5 + more])
    assert found.classes()[0] == [first]


@pytest.mark.parametrize(("beyond", "seen"), [(0.8e-4, False), (1.2e-4, True)])
def test_a_term_that_the_parameters_explain_is_absorbed_but_for_a_part_in_ten_thousand(beyond, seen):
    """A column along the one parameter, and so much of its power along the residual."""
    known = np.eye(3)[:, :2]
    column = np.sqrt(1.0 - beyond) * known[:, :1] + np.sqrt(beyond) * known[:, 1:]
    regressors: Any = SimpleNamespace(known=known, to=lambda *_: (column, np.array([True])))
    gains, _ = _alone([of_load("a")], [regressors], {"R": [None]}, known.T @ known)  # type: ignore[dict-item]
    assert bool(gains[0] > 0.5) is seen


# The band and its samples


@pytest.mark.parametrize(("frequency", "inside"), [(1.25, True), (1.35, False)])
def test_the_search_reaches_a_third_beyond_the_band_of_the_command(frequency, inside):
    """A line at so many times the end of the band, in the regression and in the evidence."""
    rate, band = 100.0, 2 * np.pi * 10.0
    line = np.sin(frequency * band * np.arange(2000) / rate)
    record: Any = SimpleNamespace(rate=rate, anchoring=ShootingWindows(0))
    found, _ = _within(line[:, None], record, band)
    assert bool(np.abs(found).max() > 1.0) is inside
    floor = np.random.default_rng(1).standard_normal(2000)
    assert bool(_of_run(floor + 10.0 * line, floor, rate, band) > 10.0) is inside


def test_a_line_gains_what_it_adds_to_the_mean_of_sixteen_frequencies():
    """Of a flat spectrum, to which it adds 64 times the level: 16 ln (1 + 64/16) nats."""
    n, rng = 320, np.random.default_rng(2)
    spectrum = np.exp(2j * np.pi * rng.random(n // 2 + 1))
    spectrum[0] = 0.0
    after = np.fft.irfft(spectrum, n)
    spectrum[40] *= np.sqrt(65.0)
    before = np.fft.irfft(spectrum, n)
    assert _of_run(before, after, 1.0, 2 * np.pi * 144.5 / n / 1.3) == pytest.approx(16.0 * np.log(5.0), rel=0.02)


@pytest.mark.parametrize(("runs", "samples"), [(12, 4096), (600, 256)])
def test_each_run_has_256_samples_of_the_coarse_clock_at_least(runs, samples):
    assert samples_of_each(runs) == samples


# Curves


def library(**signals: np.ndarray) -> TermLibrary:
    """A library of the load, which reads these signals."""
    return TermLibrary({"R": "load"}, {"R": [*signals]}, {"R": np.ones(1), **signals}, UNITS, 2 * np.pi * 10.0, 10.0)


@pytest.mark.parametrize(("values", "drawn"), [(3, False), (4, True)])
def test_a_curve_has_four_knots_at_least(values, drawn):
    """Of a signal that has so many values."""
    x = np.repeat(np.arange(float(values)), 100)
    assert bool(free_curves(library(x=x))) is drawn


def test_four_curves_at_most_are_offered():
    drawn = [FreeCurve("x", (0.0, 1.0), of_load(str(n), text="h")) for n in range(6)]
    hats = [hat for curve in drawn for hat in curve.hats()]
    found = offered(regressed(hats, np.repeat(np.linspace(0.2, 0.1, 6), 2).tolist()), drawn)
    assert len(found) == 4


def test_a_curve_may_rise_to_twenty_times_its_value_at_the_knot_that_is_held():
    term = Term("load", "R", "h", "free curve", ("x",), {}, curve=Curve("x", (0.0, 1.0), (1.0, 0.5)))
    own = definition("p", (term,), (1.0,), 1.0, {"R": np.ones(5), "x": np.linspace(0.0, 1.0, 5)}, UNITS)
    assert searched_bounds(own, (term,)) == {"p.h_2": (-20.0, 20.0)}


@pytest.mark.parametrize(("size", "strength", "upper"), [(2.0, 0.01, 2.0), (2.0, 0.5, 5.0)])
def test_a_strength_reaches_four_times_the_size_of_its_signal_and_ten_times_its_first_value(size, strength, upper):
    """Of a force that varies by one, and a speed of a size."""
    turning = np.tile([1.0, -1.0], 50)
    own = definition("p", (of_load("a", text="v"),), (1.0,), strength, {"R": turning, "v": size * turning}, UNITS)
    assert own["strength"]["upper"] == pytest.approx(upper)


# The picture


def test_a_characteristic_with_24_steps_is_seen_whole():
    """A wave that turns from one of 24 equal parts of a signal to the next: fewer parts, or more, would blur it."""
    by = np.linspace(0.0, 1.0, 24 * 60, endpoint=False)
    assert _explained_share(np.where((24 * by).astype(int) % 2, 1.0, -1.0), by, straight=False) > 0.99


@pytest.mark.parametrize(("small", "view"), [(0.085, "w(P)/w"), (0.115, "w(w)")])
def test_no_quotient_is_drawn_of_a_signal_below_a_tenth_of_its_deviation(small, view):
    """A force that hardly depends on the size of the opening: over small ones its share of the opening scatters."""
    rng = np.random.default_rng(3)
    w = np.where(rng.random(20_000) < 0.5, small, np.sqrt(2.0)) * np.sign(rng.standard_normal(20_000))  # of one
    known = {"w": w, "P": rng.uniform(-1.0, 1.0, 20_000)}
    term = Term("spool", "w", "abs(P) * sgn(w)", "any", ("w", "P"), {})
    assert characteristic_view(term, preset("qian2014"), known) == view


# Evidence


@pytest.mark.parametrize(("reduction", "worthwhile"), [(0.0085, False), (0.0115, True)])
def test_a_term_is_worthwhile_where_the_error_falls_by_a_hundredth(reduction, worthwhile):
    assert TermEvidence(np.array([30.0]), reduction).worthwhile is worthwhile


@pytest.mark.parametrize(("deviations", "consistent"), [(2.6, False), (3.4, True)])
def test_runs_agree_where_their_mean_gain_is_three_standard_errors_above_zero(deviations, consistent):
    """Also without the one that gains most, of a hundred, so that it hardly counts."""
    scatter = np.tile([1.0, -1.0], 50)
    gains = scatter + deviations * float(np.std(scatter, ddof=1)) / 10.0
    assert TermEvidence(gains, 0.1).consistent is consistent


@pytest.mark.parametrize(("gains", "consistent"), [([9.0, 5.0, -4.0], True), ([9.0, 5.0, -4.0, 5.0], False)])
def test_the_scatter_of_two_runs_is_not_known(gains, consistent):
    assert TermEvidence(np.array(gains), 0.1).consistent is consistent


@pytest.mark.parametrize(("lost", "beyond"), [(2.5, True), (3.5, False)])
def test_runs_lose_three_in_a_hundred_of_the_gains_at_most(lost, beyond):
    assert TermEvidence(np.array([40.0, 30.0, 30.0, -lost]), 0.1).beyond(14.0) is beyond


def test_the_best_of_many_terms_has_to_gain_five_nats_beyond_the_logarithm_of_their_number():
    assert least_gain(1000) - np.log(1000) == pytest.approx(5.0)


@pytest.mark.parametrize(("count", "few"), [(5, True), (6, False)])
def test_six_runs_are_parted_into_those_that_search_choose_and_confirm(count, few):
    runs: Any = [Run(str(n), "", 1.0, {"command": np.arange(3.0)}, output="command") for n in range(count)]
    sought, chosen_by, confirming = _parts(runs)
    assert (sought == chosen_by == confirming) is few
    assert {run.id for run in (*sought, *chosen_by, *confirming)} == {run.id for run in runs}


def test_three_terms_are_proposed_at_most(monkeypatch):
    added: list[bool] = []

    def one_more(self: TermSearch, curves: bool = False) -> bool:
        added.append(curves)
        self.proposals.append(None)  # type: ignore[arg-type]
        return True

    monkeypatch.setattr(TermSearch, "_added", one_more)
    monkeypatch.setattr(TermSearch, "_restated", lambda _self, proposal: proposal)
    models: Any = SimpleNamespace(at_floor=lambda _: False, runs=())
    TermSearch(models, SimpleNamespace(effects=()), lambda _: None, (), asked=False).run()  # type: ignore[arg-type]
    assert added == [False] * 3


@pytest.mark.parametrize(("lost", "taken"), [(0.0008, 0), (0.0012, 1)])
def test_a_simpler_term_may_lose_a_quarter_of_the_gain(lost, taken):
    """The best term takes 0.004 off: a simpler one that loses 0.0008 of it is taken, one that loses 0.0012 is not."""

    def leaving(error: float, simplicity: int) -> Any:
        return SimpleNamespace(simplicity=simplicity), SimpleNamespace(held_out=SimpleNamespace(error=error)), None

    base: Any = SimpleNamespace(held_out=SimpleNamespace(error=0.1))
    tried = [leaving(0.096 + lost, 0), leaving(0.096, 1)]
    assert _chosen(base, tried, ()) is tried[taken]


@pytest.mark.parametrize(("value", "same"), [(1.065, True), (1.09, False)])
def test_two_first_values_lead_to_one_refit_within_a_hundredth_of_the_range(value, same):
    """Of a shape that a refit moves from an eighth to eight times its value."""
    one, other = (
        TermCandidate((of_load("a", (Shape("h", of, "1", lower=0.125, upper=8.0),)),), (1.0,), 1.0, 0.5)
        for of in (1.0, value)
    )
    assert one.begins_as(other) is same


@pytest.mark.parametrize(("size", "sound"), [(0.8e60, True), (1.2e60, False)])
def test_a_response_beyond_all_numbers_has_diverged(size, sound):
    record: Any = SimpleNamespace(rate=1.0, anchoring=ShootingWindows(0))
    _, finite = _within(np.array([[size], [0.0], [0.0]]), record, 1.0)
    assert bool(finite[0]) is sound


def test_a_curve_has_a_knot_near_every_quantile_of_its_signal():
    (curve, *_) = free_curves(library(x=np.linspace(0.0, 1.0, 2001)))
    assert max(np.abs(np.array(curve.knots) - place).min() for place in np.linspace(0.0, 1.0, 201)) < 0.07


@pytest.mark.parametrize(("share", "view"), [(0.43, ""), (0.57, "R(x)")])
def test_a_curve_shows_a_term_where_it_explains_half_of_it(monkeypatch, share, view):
    monkeypatch.setattr(characteristic_plot, "_explained_share", lambda *_, straight: share if straight else 0.0)
    term = Term("load", "R", "x**3", "cube", ("x",), {})
    known = {"R": np.ones(5), "x": np.linspace(0.0, 1.0, 5)}
    assert characteristic_view(term, preset("qian2014"), known) == view
