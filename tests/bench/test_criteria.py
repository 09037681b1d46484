"""Each number by which a record of a bench is read and compared decides a case that lies within a third of it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.bench import motion
from ident.bench.effect_ranking import finely
from ident.bench.model import Model
from ident.bench.motion import groups
from ident.bench.readings import Readings, fastest, readings
from ident.bench.records import Record, _in_steps, _refined
from ident.bench.reduced_record import Observed, _unsettled, rate_wanted
from ident.bench.speed_table import SpeedTable

RATE = 1000.0
STEP = 1e-5  # m, of a converter


def record(
    position: np.ndarray, current: np.ndarray | None = None, kind: str = "speed-levels", **given: object
) -> Record:
    """A record whose current changes sign in the middle, where none is given."""
    n = len(position)
    current = np.where(np.arange(n) < n // 2, -0.5, 0.5) if current is None else current
    fields = {"rate": RATE, "hold": "linear", "pressure": None, "resolution": STEP} | given
    return Record(id="r", kind=kind, current=current, position=position, **fields)  # type: ignore[arg-type]


def ends(seconds: float = 0.1, current: float = 0.5, off: float = 0.0) -> bool:
    """Whether a stay near the highest reading, under a current so far from its middle, is one at an end."""
    n = 1000
    position, drive = 1e-3 * np.sin(np.linspace(0.0, 3.0, n)), np.zeros(n)
    stay = slice(400, 400 + round(seconds * RATE))
    position[stay], drive[stay] = 2e-3 - off * STEP, current
    position[stay.start] = 2e-3
    return len(record(position, drive).parts) == 2


def test_an_actuator_is_at_its_end_where_it_stays_there_under_a_current():
    """20 ms, 2 % of the rated current, 0.6 steps."""
    assert [ends(seconds=0.017), ends(seconds=0.023)] == [False, True]
    assert [ends(current=0.017), ends(current=0.023)] == [False, True]
    assert [ends(off=0.7), ends(off=0.5)] == [False, True]


@pytest.mark.parametrize(("samples", "parts"), [(7, 0), (9, 1)])
def test_a_part_of_a_record_has_eight_samples(samples, parts):
    """Between two stays at its ends, of 50 ms each."""
    position = np.repeat([0.0, 5e-4, 1e-3], [50, samples, 50])
    drive = np.repeat([-0.5, 0.0, 0.5], [50, samples, 50])
    assert len(record(position, drive).parts) == parts


@pytest.mark.parametrize(("samples", "length"), [(150, 150), (170, 17)])
def test_a_record_is_reduced_to_sixteen_means_at_least(samples, length):
    assert record(np.linspace(0.0, 1.0, samples)).reduced(100.0).length == length


@pytest.mark.parametrize(
    ("size", "held", "jumps"),
    [(4.2e-5, 1, False), (5.8e-5, 1, True), (1e-3, 2, True), (1e-3, 3, True), (1e-3, 4, False)],
)
def test_a_current_jumps_about_where_it_scatters_within_four_milliseconds(size, held, jumps):
    """It jumps by this to either side, after so many samples."""
    current = size * np.where(np.arange(4800) // held % 2, 1.0, -1.0)
    assert record(np.zeros(4800), current).jumps is jumps


@pytest.mark.parametrize(("off", "of_one"), [(0.085, True), (0.115, False)])
def test_readings_are_of_one_converter_within_a_tenth_of_a_step(off, of_one):
    assert _in_steps(STEP * np.array([0.0, 1.0, 2.0 + off]), STEP) is of_one


@pytest.mark.parametrize(
    ("wrong", "readings_in_steps"),
    [
        (0.0155, np.arange(3000.0)),
        (0.0155, np.array([0, 25, 200])),
        (0.0155, np.array([0, 25 * (1 + 0.5 / 340), 250, 380])),
    ],
)
def test_the_step_of_a_converter_is_refined_over_thirty_steps_and_ten_times_as_far_each_time(wrong, readings_in_steps):
    """The smallest change is wrong by a sixty-fifth. At 30 steps that is less than half of one, at 39 it is more."""
    of = record(STEP * readings_in_steps, np.zeros(len(readings_in_steps)))
    assert _refined(STEP * (1.0 + wrong), [of]) == pytest.approx(STEP, rel=5e-4)


@pytest.mark.parametrize(("change", "picked"), [(0.85e-6, 0), (1.15e-6, 1)])
def test_a_reading_changes_by_more_than_a_millionth_of_a_step(change, picked):
    position = STEP * np.where(np.arange(20) < 10, 0.0, change)
    assert len(readings(position, STEP, np.zeros(20), 0.0).picked) == picked


def moves(position: np.ndarray) -> bool:
    """Whether a link moves forward anywhere."""
    return bool(np.any(groups(record(position)) > 0))


def play(monkeypatch: pytest.MonkeyPatch, of: Record) -> float:
    """The half-width of the play that frees a position of its flicker."""
    asked: list[float] = []

    def known(position: np.ndarray, width: float, out: np.ndarray) -> None:
        asked.append(width)
        out[:] = position

    monkeypatch.setattr(motion, "without_flicker", known)
    groups(of)
    return asked[0]


def test_a_reading_that_flickers_by_a_step_does_not_move(monkeypatch):
    """A play of three quarters of a step to either side hides it, and no motion of two steps."""
    assert play(monkeypatch, record(np.zeros(50))) == pytest.approx(0.75 * STEP)


def test_a_position_without_steps_moves_beyond_its_noise(monkeypatch):
    """Three deviations of its changes stand for a step."""
    noise = 1e-6 * np.random.default_rng(0).standard_normal(500)
    of = record(noise, resolution=0.0)
    assert play(monkeypatch, of) == pytest.approx(0.75 * 3.0 * np.std(np.diff(noise)), rel=0.01, abs=0.0)


def stairs(*pauses: float) -> np.ndarray:
    """A position that goes on by two steps after each of these times, s."""
    at = np.cumsum(np.round(np.array(pauses) * RATE).astype(int))
    return 2.0 * STEP * np.searchsorted(at, np.arange(at[-1] + 50), side="right")


@pytest.mark.parametrize(("pause", "rests"), [(0.34, False), (0.46, True)])
def test_a_pause_of_four_times_the_usual_is_a_rest(pause, rests):
    position = stairs(*[0.1] * 4, pause, *[0.1] * 4)
    inside = groups(record(position))[450 : 450 + round(0.5 * pause * RATE)]
    assert bool(np.any(inside == 0)) is rests


@pytest.mark.parametrize(("pause", "rests"), [(0.068, False), (0.092, True)])
def test_the_usual_time_between_two_steps_is_a_fiftieth_of_a_second_at_least(pause, rests):
    """Of steps that follow each other in milliseconds a pause of four times that is a rest."""
    position = stairs(*[0.003] * 6, pause, *[0.003] * 6)
    inside = groups(record(position))[25 : 15 + round(pause * RATE)]
    assert bool(np.any(inside == 0)) is rests


@pytest.mark.parametrize(("changes", "moving"), [(2, False), (3, True)])
def test_a_link_moves_where_its_reading_changes_three_times(changes, moving):
    assert moves(stairs(*[0.1] * changes)) is moving


@pytest.mark.parametrize(
    ("kind", "frequency", "rough", "rate"),
    [
        ("static", None, False, 250),
        ("static", None, True, 1000),
        ("speed-levels", None, False, 125),
        ("frequency", 5.0, False, 400),
    ],
)
def test_a_record_is_compared_at_the_rate_that_its_kind_needs(kind, frequency, rough, rate):
    current = 1e-3 * (np.arange(1000) % 2) if rough else np.linspace(0.0, 1.0, 1000) * 1e-3
    assert rate_wanted(record(np.zeros(1000), current, kind, frequency=frequency)) == rate


@pytest.mark.parametrize(
    ("resolution", "size", "scale"), [(0.0, 0.0, 1e-7), (0.0, 1e-2, 2e-5), (12**0.5 * 1e-4, 0.0, 1e-4)]
)
def test_a_position_counts_by_its_converter_and_two_thousandths_of_its_size(resolution, size, scale):
    position = size * np.where(np.arange(2000) % 2, 1.0, -1.0)
    of = Observed.of(record(position, np.zeros(2000), resolution=resolution), rate=RATE)
    assert of.position_scale == pytest.approx(scale, rel=0.02, abs=0.0)


def past(of: Record) -> int:
    """Samples that are left out at the start."""
    return _unsettled(of)


def test_a_record_is_compared_from_where_its_past_is_over():
    """A quarter of a second; a motion of three steps, or of a ten-thousandth of the way; a third of the record."""
    still = np.zeros(2000)
    assert past(record(still)) == 250
    assert past(record(still[:600])) == 200
    for off, seen in ((2.6, 2000 // 3), (3.4, 400)):
        moved = np.where(np.arange(2000) >= 400, off * STEP, 0.0) + np.where(np.arange(2000) >= 1000, 10 * STEP, 0.0)
        assert past(record(moved)) == seen
    for share, seen in ((0.85e-4, 2000 // 3), (1.15e-4, 400)):
        moved = np.where(np.arange(2000) >= 400, share, 0.0)
        moved[1000:] = 1.0
        assert past(record(moved, resolution=0.0)) == seen
    for periods, seen in ((2.05, 250), (2.4, 200)):
        sine = record(np.zeros(round(periods * 200)), kind="frequency", frequency=5.0)
        assert past(sine) == min(seen, sine.length // 3 if seen == 250 else seen)


def test_a_reading_counts_as_a_tenth_of_its_step_at_best():
    """Of a model that leaves nothing."""
    of = Observed.of(record(STEP * np.arange(400.0), np.zeros(400)), rate=RATE)
    told = Readings(np.arange(1, 300), np.zeros(299), np.full(299, 1e-9), 0.5, 0.0, STEP)

    class Exact(Observed):
        """A record of which a model leaves noise of a thousandth of a step."""

        def residual(self, _: Model) -> np.ndarray:
            """White."""
            return np.random.default_rng(0).standard_normal(self.count)

    exact = Exact(**{**vars(of), "readings": told})
    model = Model(0.01, 0.01, 0.0, 1e8, 1e5, SpeedTable.straight(0.1))
    found = exact.reweighed(model).readings
    assert found is not None
    assert found.extra == pytest.approx(0.1 * STEP / np.sqrt(12.0), rel=0.01, abs=0.0)


@pytest.mark.parametrize(("apart", "counts"), [(3, True), (4, False)])
def test_a_reading_is_timed_by_the_fastest_of_seven_samples(apart, counts):
    moved = np.zeros(20)
    moved[10] = 1.0
    assert bool(fastest(moved)[10 - apart]) is counts


def test_an_effect_is_sought_in_records_of_500_hertz():
    (of,) = finely([record(np.linspace(0.0, 1.0, 10_000), rate=1e4)])
    assert of.record.rate == 500.0
