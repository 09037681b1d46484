"""What is made of a fit: diagnoses, controllers, hybrid simulations, profiles, plans, effects of the lab."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Float, ForeignKey, LargeBinary, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base, now


class DiagnosisRow(Base):
    """What is missing from a fit. Its id is that of the job that made it."""

    __tablename__ = "diagnoses"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    matrix: Mapped[str] = mapped_column(ForeignKey("matrices.id"))
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"))
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), index=True)
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    result: Mapped[dict[str, Any]]


class ControllerRow(Base):
    """A controller that was designed for a fit: `asked` is the request, `result` the contract's controller JSON."""

    __tablename__ = "controllers"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), index=True)
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    asked: Mapped[dict[str, Any]]
    result: Mapped[dict[str, Any]]


class HybridRow(Base):
    """A hybrid simulation. Its id is that of the job that made it.

    `asked` is what its job was asked, `records` the displacements of its figures: see `app/hybrid/records.py`.
    """

    __tablename__ = "hybrid_simulations"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), index=True)
    matrix: Mapped[str] = mapped_column(ForeignKey("matrices.id"))
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"))
    controller: Mapped[str | None] = mapped_column(ForeignKey("controllers.id"))
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    asked: Mapped[dict[str, Any]]
    result: Mapped[dict[str, Any]]
    records: Mapped[bytes] = mapped_column(LargeBinary, deferred=True)


class ProfileRow(Base):
    """The profile likelihood of a parameter of a fit. Its id is that of the job that made it."""

    __tablename__ = "profiles"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), index=True)
    parameter: Mapped[str] = mapped_column(String(200))
    created_at: Mapped[str] = mapped_column(String(40), default=now)
    result: Mapped[dict[str, Any]]


class PlanRow(Base):
    """A test plan for a rig, of a fit or of none: what its command files are made from. Its id is that of its job."""

    __tablename__ = "plans"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    fit: Mapped[str | None] = mapped_column(ForeignKey("fits.id"), index=True)
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    result: Mapped[dict[str, Any]]


class AnnotationRow(Base):
    """What people wrote on a fit; nothing that is identified depends on it."""

    __tablename__ = "annotations"
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), primary_key=True)
    name: Mapped[str] = mapped_column(String(100), default="")
    tags: Mapped[list[Any]]
    note: Mapped[str] = mapped_column(Text, default="")
    who: Mapped[str] = mapped_column(String(200), default="")
    changed_at: Mapped[str] = mapped_column(String(40), default=now)


class OwnEffectRow(Base):
    """An effect of the lab's own that is kept under a name: see `app/own_effects/own_effect.py`."""

    __tablename__ = "own_effects"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    name: Mapped[str] = mapped_column(String(60), unique=True, index=True)
    definition: Mapped[dict[str, Any]]
    model: Mapped[str | None] = mapped_column(Text)
    meaning: Mapped[str] = mapped_column(Text, default="")
    origin: Mapped[str] = mapped_column(String(40))
    diagnosis: Mapped[str | None] = mapped_column(ForeignKey("diagnoses.id"))
    data_hash: Mapped[str | None] = mapped_column(String(64))
    nats: Mapped[float | None] = mapped_column(Float)
    bar: Mapped[float | None] = mapped_column(Float)
    alike: Mapped[list[Any]]
    version: Mapped[str] = mapped_column(String(40))
    created_at: Mapped[str] = mapped_column(String(40), default=now)
