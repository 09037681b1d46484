"""Linear algebra is held to one thread while work runs side by side, and has all its threads back afterwards."""

from __future__ import annotations

from collections.abc import Iterator
from threading import Event, Thread

import numpy as np
import pytest
import scipy.linalg  # noqa: F401  brings its own linear algebra, beside numpy's
from threadpoolctl import ThreadpoolController

from ident.parallel import each

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
