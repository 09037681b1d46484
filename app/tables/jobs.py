"""Jobs, and the processes that work on them."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Boolean, Float, ForeignKey, Index, Integer, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base, now


class JobRow(Base):
    """A job and where it is. `parent` is the fit that it starts from, if any; `matrix` has the runs that it needs.

    `who` asked for it. It is to stop where it is told to `cancel`, and keeps what it found where it is told to
    `conclude`. `worker` has it under way, by the turn `fence`: see `app/jobs/lease.py`.
    `sequence` counts the changes of its state, for readers of its events. The work of its last turn began at
    `began_at` and took the `course` of app/jobs/stage_times.py.
    """

    __tablename__ = "jobs"
    __table_args__ = (Index("ix_jobs_kind_ended", "kind", "state", "ended_at"),)
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    kind: Mapped[str] = mapped_column(String(20), default="fit")
    state: Mapped[str] = mapped_column(String(20), default="queued", index=True)
    matrix: Mapped[str | None] = mapped_column(ForeignKey("matrices.id"), index=True)
    parent: Mapped[str | None] = mapped_column(String(64), index=True)
    settings: Mapped[dict[str, Any]]
    progress: Mapped[dict[str, Any]] = mapped_column(default=dict)
    sequence: Mapped[int] = mapped_column(Integer, default=0)
    cancel: Mapped[bool] = mapped_column(Boolean, default=False)
    conclude: Mapped[bool] = mapped_column(Boolean, default=False)
    who: Mapped[str] = mapped_column(String(200), default="")
    problem: Mapped[dict[str, Any] | None]
    worker: Mapped[str | None] = mapped_column(String(200), index=True)
    fence: Mapped[int] = mapped_column(Integer, default=0)
    course: Mapped[list[Any]] = mapped_column(default=list, server_default="[]")
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    began_at: Mapped[str | None] = mapped_column(String(40))
    ended_at: Mapped[str | None] = mapped_column(String(40))


class TallyRow(Base):
    """How many jobs of a kind ended in a state, and the seconds that they took: so that nobody has to count them."""

    __tablename__ = "tallies"
    kind: Mapped[str] = mapped_column(String(20), primary_key=True)
    state: Mapped[str] = mapped_column(String(20), primary_key=True)
    jobs: Mapped[int] = mapped_column(Integer, default=0)
    seconds: Mapped[float] = mapped_column(Float, default=0.0)


class WorkerRow(Base):
    """A process that works on jobs. `beat` grows while it lives; `start` is another each time that it starts."""

    __tablename__ = "workers"
    name: Mapped[str] = mapped_column(String(200), primary_key=True)
    start: Mapped[str] = mapped_column(String(32))
    host: Mapped[str] = mapped_column(Text)
    process: Mapped[int] = mapped_column(Integer)
    version: Mapped[str] = mapped_column(String(40))
    beat: Mapped[int] = mapped_column(Integer, default=0)
    silent: Mapped[bool] = mapped_column(Boolean, default=False)
    started_at: Mapped[str] = mapped_column(String(40), default=now)
