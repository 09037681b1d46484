"""Each number of the evidence decides a case that lies within a third of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from ident.diagnosis.evidence import blocks, chance
from ident.diagnosis.evidence.blocks import correlation_time
from ident.diagnosis.evidence.comparison import Residuals, compare
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.disturbance import Disturbance
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record, _edges, _harmonics
from ident.diagnosis.evidence.separation import both_probable, indistinguishable
from tests.diagnosis.test_rule import evidence


@pytest.mark.parametrize(("gain", "probable"), [(11.6, True), (13.2, False)])
def test_the_worse_of_two_models_is_as_improbable_as_chance_at_twelve_nats(gain, probable):
    """η G = ln(1/0.05 − 1) with η = 0.24."""
    assert both_probable(evidence(gain=gain)) is probable


@pytest.mark.parametrize(("apart", "near"), [(0.043, True), (0.057, False)])
def test_outputs_are_near_within_a_twentieth_of_the_unexplained_power(apart, near):
    assert indistinguishable(evidence(apart=apart)) is near


def test_noise_hides_a_difference_of_thirty_six_variances():
    """Of white noise, of which all samples are independent."""
    noise = np.random.default_rng(1).standard_normal(4000)
    bands = EnergyBands((Record(1.0, floor=1.0),), (4000,))
    of = Residuals((noise,), bands)
    assert 31.0 < compare(of, of).resolved * of.independent / of.power < 41.0


# Energy bands


def test_a_band_of_many_samples_has_thirty_distinct_degrees_of_freedom_and_all_bands_a_hundred():
    conditions = tuple(Record(1.0, number) for number in range(30))
    bands = EnergyBands(conditions, (20_000,) * 30)
    assert 27.0 < bands.distinct.max() < 31.0
    energies = np.ones((1, bands.size))
    assert 95.0 < Disturbance.of_energies(bands, energies, np.zeros(30)).distinct < 101.0


def test_bands_are_a_quarter_of_an_octave_wide_and_have_four_lines_at_least():
    edges = _edges(1 << 20, EVIDENCE_CRITERIA)
    assert np.log2(edges[-1] / edges[-41]) == pytest.approx(10.0, rel=0.05)
    assert np.diff(edges)[1] == 4.0


@pytest.mark.parametrize(("samples", "harmonics"), [(10_000, 40), (160, 20)])
def test_a_periodic_test_has_forty_harmonics_at_most_and_eight_samples_for_each(samples, harmonics):
    assert _harmonics(samples, 1000.0, EVIDENCE_CRITERIA) == harmonics


def test_a_tenth_of_the_explainable_energy_is_added_to_the_disturbance():
    """Of a model that leaves nothing."""
    bands = EnergyBands((Record(1.0),), (1000,))
    energies = np.array([np.ones(bands.size), np.zeros(bands.size)])
    found = Disturbance.of_energies(bands, energies, np.zeros(1))
    assert found.energy.sum() == pytest.approx(0.1 * bands.size)


@pytest.mark.parametrize(("ratio", "is_possible"), [(1.017, False), (1.023, True)])
def test_nothing_can_be_gained_within_two_per_cent_of_the_floor(ratio, is_possible):
    bands = EnergyBands((Record(1.0, floor=1.0),), (1000,))
    floor = bands.white(np.ones(1))
    found = Disturbance.of_energies(bands, np.array([ratio**2 * floor]), np.ones(1))
    assert (found.most(ratio**2 * floor) > 1e-9) is is_possible


def test_the_bar_is_of_two_hundred_surrogates(monkeypatch):
    made: list[int] = []
    of_energies = Disturbance.of_energies

    def counted(*given: Any) -> Disturbance:
        made.append(1)
        return of_energies(*given)

    rng = np.random.default_rng(2)
    bands = EnergyBands((Record(1.0, floor=0.01),), (64,))
    residual, columns = rng.standard_normal(64), rng.standard_normal((64, 3))
    spectrum = of_energies(bands, bands.energies([residual])[None], np.array([0.01]))
    monkeypatch.setattr(Disturbance, "of_energies", counted)
    assert chance.bar([residual], [np.empty((64, 0))], [columns], spectrum) > 0
    assert len(made) == 200


@pytest.mark.parametrize(("size", "is_kept"), [(2.9e-5, False), (3.4e-5, True)])
def test_a_response_of_which_the_sensitivities_leave_a_part_in_thirty_thousand_is_explained(size, is_kept):
    assert bool(chance._unit(np.array([[size]]), np.ones((1, 1))).shape[1]) is is_kept


# Blocks


@pytest.mark.parametrize(("samples", "length"), [(10_000, 100.0), (960, 80.0), (240, 40.0)])
def test_a_block_has_ten_correlation_times_and_of_a_short_record_as_many_as_make_twelve_blocks(
    monkeypatch, samples, length
):
    """And four at least: of a correlation time of ten samples."""
    monkeypatch.setattr(blocks, "correlation_time", lambda _: 10.0)
    assert blocks._length_of_a_block(np.zeros(samples), EVIDENCE_CRITERIA) == pytest.approx(length)


@pytest.mark.parametrize(("runs", "samples", "count"), [(1, 30, 4), (1, 10_000, 64), (3, 10_000, 64), (4, 10_000, 1)])
def test_a_record_has_four_blocks_to_sixty_four_and_of_four_runs_each_is_one(monkeypatch, runs, samples, count):
    monkeypatch.setattr(blocks, "correlation_time", lambda _: 10.0 if samples < 100 else 1.0)
    assert blocks._blocks([np.zeros(samples)] * runs, EVIDENCE_CRITERIA) == [count] * runs


@pytest.mark.parametrize(("lag", "counts"), [(5, True), (6, False)])
def test_the_correlations_of_a_series_are_summed_over_five_correlation_times(lag, counts):
    """White noise and its echo, which is correlated at one lag alone."""
    noise = np.random.default_rng(3).standard_normal(100_000)
    found = correlation_time(noise[lag:] + noise[:-lag])
    assert found == pytest.approx(2.0 if counts else 1.0, abs=0.1)
