"""What a request needs of the running service."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Protocol

from fastapi import Depends, Request
from sqlalchemy import Engine
from sqlalchemy.orm import Session, sessionmaker

from app.processes import Place
from app.settings import Settings
from app.storage import Storage


class Queue(Protocol):
    """The queue of jobs, as those use it that have something done; `running` while it is served."""

    running: bool

    def submit(self, job: str) -> None:
        """Queue a job; a job that is queued already stays as it is."""
        ...

    def give_back(self, executor: str) -> None:
        """Queue again what a process had under way that will not go on with it."""
        ...

    def mend(self) -> None:
        """Queue again what has come to a stop through no fault of its own."""
        ...

    def launch(self) -> None:
        """Start; what this process left unfinished is taken up again."""
        ...

    def stop(self) -> None:
        """End: what runs is let go, and goes on elsewhere or at the next start."""
        ...


@dataclass(frozen=True)
class Context:
    """Settings, database, blobs and job queue of one service; where it reads uploads, and works on jobs."""

    settings: Settings
    engine: Engine
    sessions: sessionmaker[Session]
    storage: Storage
    jobs: Queue
    readers: Place
    worker: Place


def context_of(request: Request) -> Context:
    """The context of the application that serves a request."""
    context: Context = request.app.state.context
    return context


Here = Annotated[Context, Depends(context_of)]
