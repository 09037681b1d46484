"""The tables. Times are UTC in ISO 8601 text, so that SQLite and PostgreSQL sort and return them alike."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import JSON, Boolean, Float, ForeignKey, Index, Integer, LargeBinary, String, Text
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship


def now() -> str:
    """This moment, UTC."""
    return datetime.now(UTC).isoformat(timespec="microseconds")


def before(age: timedelta) -> str:
    """The moment so long ago, UTC."""
    return (datetime.now(UTC) - age).isoformat(timespec="microseconds")


class Base(DeclarativeBase):
    """Common base; its metadata is what the migrations are checked against."""

    type_annotation_map = {dict[str, Any]: JSON, list[Any]: JSON}  # noqa: RUF012  SQLAlchemy's own convention


class ActuatorRow(Base):
    """An actuator by serial number."""

    __tablename__ = "actuators"
    serial: Mapped[str] = mapped_column(String(200), primary_key=True)
    name: Mapped[str] = mapped_column(Text, default="")
    batch: Mapped[str] = mapped_column(String(200), default="", index=True)
    piston_area: Mapped[float | None] = mapped_column(Float)
    created_at: Mapped[str] = mapped_column(String(40), default=now)


class MatrixRow(Base):
    """A matrix: `source` says which blobs hold it, `summary` what a page shows of it without reading them."""

    __tablename__ = "matrices"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"), index=True)
    parent: Mapped[str | None] = mapped_column(ForeignKey("matrices.id"), index=True)
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    source: Mapped[dict[str, Any]]
    summary: Mapped[dict[str, Any]]


class JobRow(Base):
    """A job and where it is. `parent` is the fit that it starts from, if any.

    It is to stop where it is told to `cancel`, and keeps what it found where it is told to `conclude`.
    `sequence` counts the changes of its state, for readers of its events.
    """

    __tablename__ = "jobs"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    kind: Mapped[str] = mapped_column(String(20), default="fit")
    state: Mapped[str] = mapped_column(String(20), default="queued", index=True)
    matrix: Mapped[str] = mapped_column(ForeignKey("matrices.id"), index=True)
    parent: Mapped[str | None] = mapped_column(String(64), index=True)
    settings: Mapped[dict[str, Any]]
    progress: Mapped[dict[str, Any]] = mapped_column(default=dict)
    sequence: Mapped[int] = mapped_column(Integer, default=0)
    cancel: Mapped[bool] = mapped_column(Boolean, default=False)
    conclude: Mapped[bool] = mapped_column(Boolean, default=False)
    problem: Mapped[dict[str, Any] | None]
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    ended_at: Mapped[str | None] = mapped_column(String(40))


class FitRow(Base):
    """A finished fit, which is a parameter set of its actuator. Its id is that of the job that made it.

    `result` is without its evolution, which is an `EvolutionRow`; fits of earlier versions hold it themselves.
    """

    __tablename__ = "fits"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    matrix: Mapped[str] = mapped_column(ForeignKey("matrices.id"), index=True)
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"), index=True)
    parent: Mapped[str | None] = mapped_column(String(64))
    model: Mapped[str] = mapped_column(String(60))
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    approved_at: Mapped[str | None] = mapped_column(String(40), index=True)
    current: Mapped[bool] = mapped_column(Boolean, default=False)
    error_fit: Mapped[float | None] = mapped_column(Float)
    error_verify: Mapped[float | None] = mapped_column(Float)
    result: Mapped[dict[str, Any]]
    values: Mapped[list[ValueRow]] = relationship(lazy="selectin", order_by="ValueRow.id")


class ValueRow(Base):
    """One parameter of a set, in a row of its own so that a range query on any parameter finds an index."""

    __tablename__ = "parameter_values"
    __table_args__ = (Index("ix_parameter_values_name_value", "name", "value"),)
    id: Mapped[int] = mapped_column(Integer, primary_key=True)
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), index=True)
    name: Mapped[str] = mapped_column(String(100))
    value: Mapped[float] = mapped_column(Float)
    unit: Mapped[str] = mapped_column(String(60))
    std_error: Mapped[float | None] = mapped_column(Float)


class EvolutionRow(Base):
    """The history of the search that made a fit, which is long: apart, and compressed."""

    __tablename__ = "evolutions"
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), primary_key=True)
    content: Mapped[bytes] = mapped_column(LargeBinary)


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


class OwnEffectRow(Base):
    """An effect of the lab's own that is kept under a name: see `app/own_effects/kept.py`."""

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


class AnswerRow(Base):
    """What a POST with an Idempotency-Key was answered; without a status it is a claim that waits for its answer.

    `subject` is the id of what comes of it, decided with the claim; `created_at` the time of the claim.
    """

    __tablename__ = "idempotency"
    key: Mapped[str] = mapped_column(String(255), primary_key=True)
    fingerprint: Mapped[str] = mapped_column(String(64))
    subject: Mapped[str] = mapped_column(String(64), default="")
    status: Mapped[int | None] = mapped_column(Integer)
    body: Mapped[dict[str, Any]]
    location: Mapped[str] = mapped_column(Text, default="")
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
