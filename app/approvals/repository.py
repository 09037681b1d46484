"""Every query on approvals. What is in force for a serial number is one open row; the database holds to that itself."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import select, update
from sqlalchemy.orm import Session, joinedload

from app.tables import ActuatorRow, ApprovalRow, SetRow, now


def history(session: Session, serial: str) -> Sequence[tuple[ApprovalRow, str | None]]:
    """Every approval of a serial number with its fit, the newest first."""
    query = select(ApprovalRow, SetRow.fit).join(SetRow, SetRow.number == ApprovalRow.number, isouter=True)
    found = session.execute(query.where(ApprovalRow.serial == serial).order_by(ApprovalRow.id.desc()))
    return [(row, fit) for row, fit in found]


def in_force(session: Session, serials: Sequence[str]) -> dict[str, SetRow]:
    """The sets in force, by serial number, each with its values and approvals by the one query: a line asks all day."""
    query = select(SetRow).join(ApprovalRow, ApprovalRow.number == SetRow.number)
    query = query.where(ApprovalRow.serial.in_(serials), ApprovalRow.until.is_(None))
    whole = query.options(joinedload(SetRow.values), joinedload(SetRow.approvals))
    return {row.serial: row for row in session.scalars(whole).unique()}


def put_in_force(session: Session, serial: str, number: int | None, who: str, why: str) -> None:
    """From now on this set, or none, is in force; the approval that was open ends. One at a time for an actuator."""
    session.execute(select(ActuatorRow.serial).where(ActuatorRow.serial == serial).with_for_update())
    moment = now()
    open_ = update(ApprovalRow).where(ApprovalRow.serial == serial, ApprovalRow.until.is_(None))
    session.execute(open_.values(until=moment))
    session.add(ApprovalRow(serial=serial, number=number, since=moment, who=who, why=why))
    session.flush()
