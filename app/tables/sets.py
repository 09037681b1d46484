"""Fits, the parameter sets that they are, and which of these is in force."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Float, ForeignKey, Index, Integer, LargeBinary, String, Text, text
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.tables.base import Base, now


class FitRow(Base):
    """A finished fit. Its id is that of the job that made it; `set` is what it says of its actuator.

    `result` is without its evolution, which is an `EvolutionRow`; fits of earlier versions hold it themselves.
    """

    __tablename__ = "fits"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    matrix: Mapped[str] = mapped_column(ForeignKey("matrices.id"), index=True)
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"), index=True)
    parent: Mapped[str | None] = mapped_column(String(64))
    model: Mapped[str] = mapped_column(String(60))
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    result: Mapped[dict[str, Any]]
    set: Mapped[SetRow] = relationship(
        lazy="joined", innerjoin=True, back_populates="whole", cascade="all, delete-orphan"
    )


class SetRow(Base):
    """The parameter set of a fit, in a narrow row: what a production line asks for, and where the set comes from.

    Sets are numbered as they come, so that the newest are found, and paged through, by number. `unstable_fit` and
    `unstable_verify` are the ids of the runs of either use on which the model is unstable.
    """

    __tablename__ = "parameter_sets"
    __table_args__ = (
        Index("ix_parameter_sets_serial", "serial", "number"),
        Index("ix_parameter_sets_batch", "batch", "number"),
        Index("ix_parameter_sets_model", "model", "number"),
    )
    number: Mapped[int] = mapped_column(Integer, primary_key=True)
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), unique=True)
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"))
    batch: Mapped[str] = mapped_column(String(200), default="")
    model: Mapped[str] = mapped_column(String(60))
    created_at: Mapped[str] = mapped_column(String(40), default=now)
    error_fit: Mapped[float | None] = mapped_column(Float)
    error_verify: Mapped[float | None] = mapped_column(Float)
    error_with_mean_fit: Mapped[float | None] = mapped_column(Float)
    error_with_mean_verify: Mapped[float | None] = mapped_column(Float)
    unstable_fit: Mapped[list[Any]] = mapped_column(default=list)
    unstable_verify: Mapped[list[Any]] = mapped_column(default=list)
    effects: Mapped[list[Any]] = mapped_column(default=list)
    data_hash: Mapped[str] = mapped_column(String(64), default="")
    seed: Mapped[int | None] = mapped_column(Integer)
    version: Mapped[str] = mapped_column(String(40), default="")
    equations: Mapped[str] = mapped_column(String(64), default="")
    who: Mapped[str] = mapped_column(String(200), default="")
    whole: Mapped[FitRow] = relationship(back_populates="set")
    values: Mapped[list[ValueRow]] = relationship(
        lazy="selectin", order_by="ValueRow.place", cascade="all, delete-orphan"
    )
    approvals: Mapped[list[ApprovalRow]] = relationship(lazy="selectin", order_by="ApprovalRow.id", viewonly=True)

    @property
    def approved_at(self) -> str | None:
        """When it was approved last; None where it never was."""
        return self.approvals[-1].since if self.approvals else None

    @property
    def current(self) -> bool:
        """Whether it is the set in force of its actuator."""
        return any(approval.until is None for approval in self.approvals)


class ValueRow(Base):
    """One parameter of a set, in a row of its own: two indexes hold all that a range needs.

    By value for a range that few sets match, by number for one that many do.
    """

    __tablename__ = "set_values"
    __table_args__ = (
        Index("ix_set_values_name_value", "name", "value", "number"),
        Index("ix_set_values_name_number", "name", "number", "value"),
        {"sqlite_with_rowid": False},
    )
    number: Mapped[int] = mapped_column(ForeignKey("parameter_sets.number"), primary_key=True)
    name: Mapped[str] = mapped_column(String(100), primary_key=True)
    place: Mapped[int] = mapped_column(Integer)
    value: Mapped[float] = mapped_column(Float)
    unit: Mapped[str] = mapped_column(String(60))
    std_error: Mapped[float | None] = mapped_column(Float)


_OPEN = text("until IS NULL")


class ApprovalRow(Base):
    """From when until when a set was in force for a serial number, who made it so, and why.

    One without a set says that none was: the one before was withdrawn. The database itself holds that at most one a
    serial number is open.
    """

    __tablename__ = "approvals"
    __table_args__ = (
        Index("ix_approvals_in_force", "serial", unique=True, sqlite_where=_OPEN, postgresql_where=_OPEN),
        Index("ix_approvals_number_in_force", "number", sqlite_where=_OPEN, postgresql_where=_OPEN),
        Index("ix_approvals_serial", "serial", "id"),
        Index("ix_approvals_since", "since", "number"),
    )
    id: Mapped[int] = mapped_column(Integer, primary_key=True)
    serial: Mapped[str] = mapped_column(ForeignKey("actuators.serial"))
    number: Mapped[int | None] = mapped_column(ForeignKey("parameter_sets.number"), index=True)
    since: Mapped[str] = mapped_column(String(40), default=now)
    until: Mapped[str | None] = mapped_column(String(40))
    who: Mapped[str] = mapped_column(String(200), default="")
    why: Mapped[str] = mapped_column(Text, default="")


class EvolutionRow(Base):
    """The history of the search that made a fit, which is long: a blob, or what an earlier version kept here."""

    __tablename__ = "evolutions"
    fit: Mapped[str] = mapped_column(ForeignKey("fits.id"), primary_key=True)
    content: Mapped[bytes] = mapped_column(LargeBinary, default=b"")
    blob: Mapped[str | None] = mapped_column(String(64))
