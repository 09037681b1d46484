"""What a request needs of the running service."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Request
from sqlalchemy import Engine
from sqlalchemy.orm import Session, sessionmaker

from app.jobs.engine import Jobs
from app.processes import Place
from app.settings import Settings
from app.storage import Storage


@dataclass(frozen=True)
class Context:
    """Settings, database, blobs and job queue of one service; where it reads uploads, and works on jobs."""

    settings: Settings
    engine: Engine
    sessions: sessionmaker[Session]
    storage: Storage
    jobs: Jobs
    readers: Place
    worker: Place


def context_of(request: Request) -> Context:
    """The context of the application that serves a request."""
    context: Context = request.app.state.context
    return context


Here = Annotated[Context, Depends(context_of)]
