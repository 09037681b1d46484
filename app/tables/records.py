"""Actuators and their test matrices."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Float, ForeignKey, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base, now


class ActuatorRow(Base):
    """An actuator by serial number, with what the last upload says of it."""

    __tablename__ = "actuators"
    serial: Mapped[str] = mapped_column(String(200), primary_key=True)
    name: Mapped[str] = mapped_column(Text, default="")
    batch: Mapped[str] = mapped_column(String(200), default="", index=True)
    piston_area: Mapped[float | None] = mapped_column(Float)
    created_at: Mapped[str] = mapped_column(String(40), default=now)


class MatrixRow(Base):
    """A matrix: `source` says which blobs hold it, `summary` what a page shows of it without reading them.

    Batch and area are those that this upload states. One whose raw runs were removed by the rule has no source.
    """

    __tablename__ = "matrices"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"), index=True)
    parent: Mapped[str | None] = mapped_column(ForeignKey("matrices.id"), index=True)
    batch: Mapped[str] = mapped_column(String(200), default="")
    piston_area: Mapped[float | None] = mapped_column(Float)
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    source: Mapped[dict[str, Any]]
    summary: Mapped[dict[str, Any]]
    removed_at: Mapped[str | None] = mapped_column(String(40))
