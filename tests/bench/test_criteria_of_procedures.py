"""Each number of the procedures of a bench decides a case that lies within a third of it."""

from __future__ import annotations

from inspect import signature
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.bench import analysis, frequency, position_loop, speed, speed_linearity, static, time_constant
from ident.bench.model import Model
from ident.bench.position_loop import AmplitudeMargin
from ident.bench.records import Record
from ident.bench.speed import Curve
from ident.bench.speed_table import SpeedTable
from ident.rig.regulator import Regulator

RATE = 1000.0


class Known(Exception):
    """What a test asks for is known."""


def record(current: np.ndarray, kind: str = "speed-levels") -> Record:
    """A link that goes 0.1 m in a second."""
    return Record("r", kind, RATE, "linear", current, 1e-4 * np.arange(len(current)), None, 1e-6)


def levels(monkeypatch: pytest.MonkeyPatch, current: np.ndarray, lag: float = 0.0, left: float = 1.0) -> int:
    """How many levels there are, where friction leaves so much of the speed."""
    monkeypatch.setattr(speed, "_after_play", lambda _, of: of.current)
    monkeypatch.setattr(speed, "factor", lambda _, after: np.full(len(after), left))
    return len(speed.levels(SimpleNamespace(T=lag), [record(current)]))


@pytest.mark.parametrize(("change", "one"), [(1.7e-3, True), (2.3e-3, False)])
def test_a_level_is_one_within_two_thousandths_of_the_rated_current(monkeypatch, change, one):
    assert (levels(monkeypatch, np.repeat([0.5, 0.5 + change], 300)) == 1) is one


@pytest.mark.parametrize(
    ("seconds", "lag", "lasts"), [(0.085, 0.0, 0), (0.115, 0.0, 1), (0.7, 0.112, 0), (0.7, 0.085, 1)]
)
def test_a_level_lasts_a_tenth_of_a_second_after_six_lags(monkeypatch, seconds, lag, lasts):
    assert levels(monkeypatch, np.full(round(seconds * RATE), 0.5), lag) == lasts


@pytest.mark.parametrize(("left", "points"), [(0.65, 0), (0.75, 1)])
def test_a_level_is_a_point_where_friction_leaves_seven_tenths_of_the_speed(monkeypatch, left, points):
    assert levels(monkeypatch, np.full(500, 0.5), left=left) == points


def test_a_speed_is_divided_by_a_fifth_at_least(monkeypatch):
    monkeypatch.setattr(speed, "_after_play", lambda _, of: of.current)
    monkeypatch.setattr(speed, "factor", lambda _, after: np.full(len(after), 0.01))
    found = speed.curve(SimpleNamespace(), record(np.full(500, 0.5), "speed-continuous"))
    assert found.free_speed == pytest.approx(found.speed / 0.2)


def test_a_speed_is_smoothed_at_fifteen_hertz(monkeypatch):
    """A sine of that frequency, passed forward and back, keeps half of its amplitude (Butterworth 1930)."""
    t = np.arange(4000) / RATE
    monkeypatch.setattr(speed, "_after_play", lambda _, of: of.current)
    monkeypatch.setattr(speed, "factor", lambda _, after: np.ones(len(after)))
    monkeypatch.setattr(speed, "differentiated", lambda *_: np.sin(2 * np.pi * 15.0 * t))
    found = speed.curve(SimpleNamespace(), record(np.full(4000, 0.5), "speed-continuous"))
    assert np.std(found.speed[500:-500]) * np.sqrt(2.0) == pytest.approx(0.5, rel=0.1)


@pytest.mark.parametrize("of", [speed.speed, speed.curve])
def test_the_curve_through_the_levels_is_of_the_seventh_degree(of):
    assert signature(of).parameters["degree"].default == 7


def stroke(samples: int) -> Curve:
    """A curve of so many samples, evenly over the currents."""
    current = np.linspace(-1.0, 1.0, samples)
    return Curve("r", "iir", current, current, current, current, current + 2.0)


def test_a_stroke_is_thinned_to_forty_places():
    assert len(speed._points([], [stroke(10_000)])) == pytest.approx(40, abs=1)


@pytest.mark.parametrize(("samples", "points"), [(120, False), (165, True)])
def test_a_place_of_a_stroke_has_four_samples(samples, points):
    assert (len(speed._points([], [stroke(samples)])) > 20) is points


def fit_of(monkeypatch: pytest.MonkeyPatch, room: Any) -> list[Any]:
    """The steps of the fits of a procedure, the first of which ends it."""
    asked: list[Any] = []

    def known(_: Any, steps: int, **__: Any) -> Any:
        asked.append(steps)
        raise Known

    monkeypatch.setattr(room, "Residual", lambda *given: given)
    monkeypatch.setattr(room, "solve", known)
    return asked


def test_a_table_is_fitted_in_three_steps(monkeypatch):
    asked = fit_of(monkeypatch, speed)
    with pytest.raises(Known):
        speed.fit_table(SimpleNamespace(table=SimpleNamespace(names=())), ())
    assert asked == [3]


def test_a_static_fit_has_four_steps(monkeypatch):
    asked = fit_of(monkeypatch, static)
    with pytest.raises(Known):
        static.static((), None, ())
    assert asked == [4]


def test_a_delay_is_looked_for_in_the_sines_in_five_steps(monkeypatch):
    asked = fit_of(monkeypatch, time_constant)
    whole = SimpleNamespace(model=None, residual=SimpleNamespace(names=(), observed=()))
    with pytest.raises(Known):
        time_constant.delay_check(whole, ())
    assert asked == [5]


def starts(monkeypatch: pytest.MonkeyPatch, rough: bool) -> tuple[float, list[tuple[float, float]]]:
    """The rate at which starts are compared, and of each its dead space and hysteresis, of a width of 0.1."""
    rates, tried = [], []

    def observed(_: Any, rate: float, **__: Any) -> Any:
        rates.append(rate)

    def ended(given: Any, **_: Any) -> Any:
        model = given[0]
        tried.append((model.dead_space, model.B))
        return SimpleNamespace(cost=0.0, model=model)

    monkeypatch.setattr(static, "by_groups", lambda _: (0.0, 0.1, 1e5))
    monkeypatch.setattr(static, "observe", observed)
    monkeypatch.setattr(static, "Residual", lambda *given: given)
    monkeypatch.setattr(static, "solve", ended)
    static.first_values([SimpleNamespace(jumps=rough)], 0.02, 2e7)
    return rates[0], tried


def test_starts_of_a_static_fit_are_chosen_at_fifty_hertz(monkeypatch):
    """At 250 Hz where the current jumps about."""
    assert [starts(monkeypatch, rough)[0] for rough in (False, True)] == [50.0, 250.0]


def test_a_static_fit_begins_with_shares_of_the_dead_space(monkeypatch):
    """Half and a quarter of it are tried, too, where the current jumps about."""
    smooth, rough = (np.array(starts(monkeypatch, jumps)[1]) for jumps in (False, True))
    assert smooth[:, 1] / smooth[:, 0] == pytest.approx([0.3, 0.6, 0.85])
    assert rough[::3, 0] == pytest.approx([0.1, 0.05, 0.025])


def test_a_dead_space_to_begin_with_is_not_zero(monkeypatch):
    monkeypatch.setattr(static, "groups", lambda _: np.array([1, -1]))
    monkeypatch.setattr(static, "onsets", lambda *_: np.zeros(1))
    monkeypatch.setattr(static, "_pressure", lambda _: np.zeros(2))
    assert static.by_groups([SimpleNamespace(current=None)])[1] == pytest.approx(1e-5)


def descent(error: Any, start: float = 1.0) -> tuple[list[float], int]:
    """The time constants that a descent asks for, the first of them where it begins, and its steps."""
    asked: list[float] = []

    def known(T: float) -> float:
        asked.append(T)
        return float(error(T))

    *_, steps = time_constant.gradient_descent(SimpleNamespace(error=known), start)
    return asked, steps


def test_a_time_constant_lies_between_a_ten_thousandth_and_one_second():
    """Where the error falls without end it is the least that is searched."""
    asked, _ = descent(lambda T: T, 1e-3)
    assert min(asked) == pytest.approx(1e-4, rel=0.01)


def test_the_descent_begins_with_a_third_and_ends_below_a_thousandth():
    """Each is longer by a fifth after one that helped, and a third as long after a failure. There are 25 at most."""
    falling = iter(range(1000, 0, -1))
    assert descent(lambda _: next(falling))[1] == 25
    asked, _ = descent(lambda T: 1.0 + 1e-9 * T, 0.9)
    places = np.log(np.array(asked) / 0.9)
    assert places[[1, 2]] == pytest.approx([1e-3, -0.3], rel=0.02)
    assert places[4] - places[2] == pytest.approx(-0.3 * 1.2, rel=0.02)
    asked, steps = descent(lambda T: 1.0 if T == 0.9 else 2.0, 0.9)
    assert np.log(asked[4] / 0.9) == pytest.approx(-0.3 * 0.35, rel=0.02)
    assert steps == 6


def test_the_search_for_the_time_constant_begins_at_twenty_milliseconds():
    assert pytest.approx(0.02) == analysis.FIRST_T


def test_the_search_of_the_library_ends_within_a_ten_thousandth(monkeypatch):
    asked: dict[str, Any] = {}

    def known(*_: Any, **given: Any) -> Any:
        asked.update(given)
        return SimpleNamespace(x=np.zeros(1))

    monkeypatch.setattr(time_constant.scipy.optimize, "least_squares", known)
    time_constant.by_library(SimpleNamespace(), 0.02)
    assert (asked["xtol"], asked["ftol"], asked["max_nfev"]) == (1e-4, 1e-6, 30)


@pytest.mark.parametrize(
    ("errors", "share", "said"), [(3.4, 1.0, False), (4.6, 1.0, True), (9.0, 0.017, False), (9.0, 0.023, True)]
)
def test_a_delay_is_said_from_four_deviations_and_a_fiftieth_of_the_lag_on(monkeypatch, errors, share, said):
    """So many standard errors, and this share of a lag of one second."""
    delay = time_constant._DELAY
    correlation = {a: dict.fromkeys(("T", "B", delay), 0.0) for a in ("T", "B", delay)}

    class Solution(SimpleNamespace):
        """A fit with a delay."""

        residual = SimpleNamespace(names=(), observed=())

    model = SimpleNamespace(T=1.0, B=0.0)
    ended = Solution(
        values={"T": 1.0, "B": 0.0, delay: share},
        deviations={delay: share / errors},
        correlation=correlation,
        model=model,
    )
    monkeypatch.setattr(time_constant, "Residual", lambda *given: given)
    monkeypatch.setattr(time_constant, "solve", lambda *_, **__: ended)
    monkeypatch.setattr(time_constant, "scatter", lambda _: None)
    monkeypatch.setattr(time_constant, "replace", lambda of, **_: of)
    assert bool(time_constant.delay_check(ended, ())[1].doubt) is said


def test_a_period_of_a_sine_is_reduced_to_two_hundred_samples():
    asked: list[float] = []

    def reduced(rate: float) -> Any:
        asked.append(rate)
        raise Known

    with pytest.raises(Known):
        frequency.point(SimpleNamespace(frequency=3.0, reduced=reduced))
    assert asked == [600.0]


@pytest.mark.parametrize(("lacking", "periods"), [(0.0075, 2), (0.0125, 1)])
def test_a_period_counts_that_lacks_a_hundredth(lacking, periods):
    """The last of three, of which the first is not compared."""
    rate = 399.0  # below four hundred, so that nothing is reduced
    t = np.arange(1 + round((3.0 - lacking) * rate)) / rate
    of = Record("r", "frequency", rate, "linear", np.sin(2 * np.pi * t), np.sin(2 * np.pi * t), None, 0.0, 1.0)
    assert frequency.point(of).periods == periods


def test_a_table_is_read_at_two_hundred_and_one_currents():
    asked: list[int] = []

    def known(current: np.ndarray) -> np.ndarray:
        asked.append(len(current))
        return current

    speed_linearity.of_table(SimpleNamespace(nodes=[1.0], speed=known))  # type: ignore[arg-type]
    assert asked == [201]


def test_a_loop_is_judged_from_a_half_beyond_the_dead_space_to_ten_times(monkeypatch):
    monkeypatch.setattr(position_loop, "_actuator", lambda _: SimpleNamespace(dead_space=0.01))
    monkeypatch.setattr(position_loop, "margins", lambda *given: AmplitudeMargin(given[-1], 0.0, 0.0, stands=True))
    found = position_loop.position_loop(SimpleNamespace(model="m"), Regulator(1.0))  # type: ignore[arg-type]
    assert [one.amplitude for one in found.amplitudes] == pytest.approx([0.015, 0.03, 0.1])


def loop() -> AmplitudeMargin:
    """Of an analogue regulator around an actuator with a lag of 10 ms."""
    model = Model(0.01, 1e-4, 0.0, 1e8, 1e4, SpeedTable.straight(0.1))
    return position_loop.margins(model, Regulator(30.0), 0.1)


def test_a_loop_is_looked_at_from_a_hundredth_of_a_hertz_on():
    assert loop().frequency[0] == pytest.approx(0.01)


def test_an_analogue_loop_is_looked_at_up_to_a_hundred_times_its_lag():
    assert loop().frequency[-1] == pytest.approx(100.0 / (2 * np.pi * 0.01))
