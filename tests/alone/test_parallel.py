"""Work runs side by side, work inside of work too; linear algebra is held to one thread meanwhile, and let go after."""

from __future__ import annotations

import time
from collections.abc import Iterator
from threading import Barrier, Event, Thread, current_thread

import numpy as np
import pytest
import scipy.linalg  # noqa: F401  brings its own linear algebra, beside numpy's
from threadpoolctl import ThreadpoolController

from ident.cached import cached_property
from ident.fit import simulated_runs
from ident.fit.simulated_runs import SimulatedRuns, every_run
from ident.matrix import Actuator, Matrix
from ident.parallel import LEAST_SHARED, Once, cores, each
from ident.presets import preset
from ident.run import Run

OWN = 2  # threads that a notebook gave to linear algebra, also on a machine of one core


@pytest.fixture
def notebook() -> Iterator[None]:
    """A process in which nobody computes."""
    with ThreadpoolController().limit(limits=OWN, user_api="blas"):
        yield


def threads() -> set[int]:
    """Of every library of linear algebra in this process."""
    np.linalg.norm(np.eye(2))
    return {library["num_threads"] for library in ThreadpoolController().info() if library["user_api"] == "blas"}


class Call:
    """A call of `each` in a thread of its own that lasts until it is let go; what it saw at its end."""

    def __init__(self) -> None:
        self.inside, self.go, self.seen = Event(), Event(), {0}
        self.thread = Thread(target=each, args=(self.work, [0]))
        self.thread.start()
        assert self.inside.wait(30)

    def work(self, _: int) -> None:
        self.inside.set()
        assert self.go.wait(30)
        self.seen = threads()

    def end(self) -> set[int]:
        self.go.set()
        self.thread.join()
        return self.seen


@pytest.mark.usefixtures("notebook")
def test_of_two_calls_that_overlap_the_first_to_leave_takes_nothing_from_the_other() -> None:
    job, drawing = Call(), Call()
    assert [job.end(), drawing.end()] == [{1}, {1}]
    assert threads() == {OWN}


@pytest.mark.usefixtures("notebook")
def test_a_notebooks_own_work_keeps_its_threads_also_after_a_failure() -> None:
    def fail(_: int) -> None:
        assert threads() == {1}
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        each(fail, [0, 1])
    assert threads() == {OWN}


def test_nothing_goes_on_after_a_failure() -> None:
    begun, ended = Event(), Event()

    def work(number: int) -> None:
        if number == 0:
            assert begun.wait(30)
            raise ZeroDivisionError
        begun.set()
        time.sleep(0.2)  # the failure is there by now
        ended.set()

    if cores() == 1:
        pytest.skip("with one core the first failure ends it")
    with pytest.raises(ZeroDivisionError):
        each(work, [0, 1])
    assert ended.is_set()


class Worth:
    """Something whose worth is worked out on all cores."""

    def __init__(self, begun: Event, go: Event) -> None:
        self.begun, self.go = begun, go

    @cached_property
    def value(self) -> int:
        self.begun.set()
        assert self.go.wait(30)
        return sum(each(lambda number: number, range(5)))


def test_two_that_ask_for_the_worth_of_different_things_do_not_wait_for_each_other() -> None:
    """One holds a worth and needs the cores, the cores are at work on the worth of others: both come to an end."""
    begun, go, at_once = Event(), Event(), Event()
    at_once.set()
    first, others = Worth(begun, go), [Worth(Event(), at_once) for _ in range(cores())]
    one = Thread(target=lambda: first.value, daemon=True)
    one.start()
    assert begun.wait(30)
    two = Thread(target=each, args=(lambda worth: worth.value, others), daemon=True)
    two.start()
    for other in others:
        assert other.begun.wait(30)
    go.set()
    for thread in (one, two):
        thread.join(30)
        assert not thread.is_alive()
    assert [worth.value for worth in (first, *others)] == [10] * (cores() + 1)


def test_the_first_failure_in_order_is_raised_and_nothing_more_is_begun() -> None:
    begun: list[int] = []

    def fail(number: int) -> None:
        begun.append(number)
        raise KeyError(number)

    with pytest.raises(KeyError, match="0"):
        each(fail, range(50))
    assert len(begun) <= cores()


@pytest.mark.skipif(cores() < 2, reason="one core has nobody to help")
def test_work_inside_of_the_only_item_is_shared_out() -> None:
    met = Barrier(2, timeout=30)

    def outer(_: int) -> list[int]:
        return each(inner, range(2))

    def inner(number: int) -> int:
        met.wait()  # both at once, or never
        return number

    assert each(outer, [0]) == [[0, 1]]


def test_who_waits_for_the_last_of_the_work_lends_a_core_to_what_is_inside_of_it() -> None:
    """The others are done, and one is at work on two things that can only end side by side."""
    if cores() == 1:
        pytest.skip("nothing is side by side on one core")
    caller, begun, both = current_thread(), Event(), Barrier(2)

    def side_by_side(number: int) -> int:
        both.wait(30)
        return number

    def work(number: int) -> int:
        if current_thread() is caller:
            assert begun.wait(30)
            return number
        begun.set()
        return number + sum(each(lambda one: time.sleep(0.5) or 0 if one == 0 else side_by_side(one), range(3)))

    assert sum(each(work, range(2))) == 4


def test_what_two_threads_ask_for_at_once_is_worked_out_once() -> None:
    once, counted = Once[str, int](), list[int]()
    second = Event()

    def found() -> int:
        counted.append(1)
        assert second.wait(30)
        time.sleep(0.05)  # the other one asks meanwhile
        return len(each(lambda item: item, range(4)))  # work inside, for which the one that waits lends its core

    def ask(is_second: bool) -> int:
        if is_second:
            second.set()
        return once.of("bar", found)

    assert each(ask, [False, True]) == [4, 4] if cores() > 1 else each(ask, [True, False]) == [4, 4]
    assert len(counted) == 1


def test_what_failed_is_worked_out_when_it_is_asked_for_again() -> None:
    once = Once[str, int]()
    with pytest.raises(ZeroDivisionError):
        once.of("bar", lambda: 1 // 0)
    assert once.of("bar", lambda: 1) == once.of("bar", lambda: 2) == 1


def runs(length: int) -> SimulatedRuns:
    """Four runs of a motor, of that length each."""
    record = tuple(
        Run(f"r{i}", "", 100.0, {"command": np.ones(length), "velocity": np.arange(length)}, output="velocity")
        for i in range(4)
    )
    return every_run(preset("motor"), Matrix(Actuator("A"), record))


def test_short_runs_are_simulated_in_one_go_and_long_ones_by_every_core(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simulated_runs, "cores", lambda: 2)
    least = LEAST_SHARED // (4 * 5 * 2)  # of four runs, five vectors and two steps a sample
    assert [len(list(runs(length).together(5, 2))) for length in (least - 1, least + 1)] == [1, 2]
