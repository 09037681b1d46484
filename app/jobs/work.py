"""What a kind of job does: plain methods, which know nothing of the queue that calls them."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol

from sqlalchemy.orm import Session

from app.matrices.stored import load_row
from app.storage import Storage
from app.tables import JobRow, MatrixRow
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.progress import Progress, Report, silent

State = dict[str, Any]
Keep = Callable[[Session, JobRow, str, State], None]
"""Stores what a job made: its record, the actuator's serial number, what its work returned at the end."""


@dataclass(frozen=True)
class MadeSoFar(Progress):
    """What a job has made so far, to be stored as if it were its end: whatever becomes of the job later, it is there.

    In `made` as :meth:`Work.finish` returns it; what is stored later takes its place.
    """

    made: State = field(default_factory=dict)


@dataclass(frozen=True)
class Task:
    """What a job is asked: its settings, the stored fit and the matrix, if any, whom it tells of its progress.

    All but the last may pass from one process to another.
    """

    settings: dict[str, Any]
    parent: dict[str, Any] | None
    recorded: MatrixRow | None
    storage: Storage
    report: Report = silent

    @property
    def matrix(self) -> Matrix:
        """The samples, of a job that has a matrix. Raises Unusable."""
        assert self.recorded is not None
        return load_row(self.storage, self.recorded)

    @property
    def fit(self) -> FitResult | None:
        """The fit that the job starts from."""
        return None if self.parent is None else FitResult.from_json(self.parent)


class Work(Protocol):
    """A job in steps: begin, advance until the state says that it is `done`, finish. What is raised is how it ends.

    A state is plain JSON data, kept after every step: the job goes on there after a kill. The work of a kind is cut so,
    its turn in the process where it is done (app/jobs/worker_side.py), and the turn that the queue calls
    (app/jobs/steps.py).
    """

    @abstractmethod
    def begin(self) -> State:
        """The state before the first block of the search; it says whether it is `done` but for the finish."""
        ...

    @abstractmethod
    def advance(self, state: State) -> State:
        """The state after another block."""
        ...

    @abstractmethod
    def finish(self, state: State) -> State:
        """All that follows the search: what is made of the last state, as it is to be stored."""
        ...


class InOnePiece(Work):
    """Work without a search: a kill makes it run again from its beginning."""

    def begin(self) -> State:
        """Nothing comes before the finish."""
        return {"done": True}

    def advance(self, state: State) -> State:
        """Nothing to do."""
        return state


@dataclass(frozen=True)
class Kind:
    """A kind of job: its name in the record, the work that a task takes, and how what it made is stored."""

    name: str
    work: Callable[[Task], Work]
    keep: Keep
