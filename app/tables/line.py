"""What a production line asks of sets: limits, regressions."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Float, ForeignKey, String
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base, now


class LimitRow(Base):
    """What a parameter, or an error, of a model has to keep to: in a batch, or, with batch "", in all. SI."""

    __tablename__ = "limits"
    model: Mapped[str] = mapped_column(String(60), primary_key=True)
    batch: Mapped[str] = mapped_column(String(200), primary_key=True)
    name: Mapped[str] = mapped_column(String(100), primary_key=True)
    lower: Mapped[float | None] = mapped_column(Float)
    upper: Mapped[float | None] = mapped_column(Float)
    unit: Mapped[str] = mapped_column(String(60))
    who: Mapped[str] = mapped_column(String(200), default="")
    changed_at: Mapped[str] = mapped_column(String(40), default=now)


class RegressionRow(Base):
    """A recheck of approved sets: which were asked for, and how far a quantity may move."""

    __tablename__ = "regressions"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    asked: Mapped[dict[str, Any]]
    tolerance: Mapped[float] = mapped_column(Float)
    who: Mapped[str] = mapped_column(String(200), default="")
    created_at: Mapped[str] = mapped_column(String(40), default=now)


class RecheckRow(Base):
    """The recheck of one set, made by the job of this id; `changes` are there when it has ended well."""

    __tablename__ = "rechecks"
    id: Mapped[str] = mapped_column(ForeignKey("jobs.id"), primary_key=True)
    regression: Mapped[str] = mapped_column(ForeignKey("regressions.id"), index=True)
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"))
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"))
    seconds: Mapped[float | None] = mapped_column(Float)
    changes: Mapped[list[Any] | None]
