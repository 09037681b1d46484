"""Every query on a lab's own effects."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import asdict, fields

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.own_effects.own_effect import OwnEffect
from app.tables import DiagnosisRow, OwnEffectRow
from ident.diagnosis.result import Diagnosis

_FIELDS = tuple(field.name for field in fields(OwnEffect))


def find(session: Session, name: str) -> OwnEffectRow | None:
    """The row of a name."""
    return session.scalars(select(OwnEffectRow).where(OwnEffectRow.name == name)).one_or_none()


def known(session: Session, effect_id: str) -> OwnEffectRow | None:
    """The row of an id."""
    return session.get(OwnEffectRow, effect_id)


def page(session: Session, after: str | None, limit: int) -> Sequence[OwnEffectRow]:
    """Rows by name."""
    query = select(OwnEffectRow).order_by(OwnEffectRow.name).limit(limit)
    return session.scalars(query if after is None else query.where(OwnEffectRow.name > after)).all()


def named(session: Session, names: Collection[str]) -> Sequence[OwnEffectRow]:
    """The rows of those of these names that there are, by name."""
    return session.scalars(select(OwnEffectRow).where(OwnEffectRow.name.in_(names)).order_by(OwnEffectRow.name)).all()


def every(session: Session) -> Sequence[OwnEffectRow]:
    """All rows by name."""
    return session.scalars(select(OwnEffectRow).order_by(OwnEffectRow.name)).all()


def diagnosis(session: Session, diagnosis_id: str) -> Diagnosis | None:
    """The diagnosis that proposes a term."""
    row = session.get(DiagnosisRow, diagnosis_id)
    return None if row is None else Diagnosis.from_json(row.result)


def add(session: Session, effect_id: str, kept: OwnEffect) -> OwnEffectRow:
    """A new row; the commit raises IntegrityError where the name, or the id, is there already."""
    data = asdict(kept) | {"alike": list(kept.alike)}
    row = OwnEffectRow(id=effect_id, **{name: value for name, value in data.items() if value != ""})
    session.add(row)
    return row


def drop(session: Session, row: OwnEffectRow) -> None:
    """Remove a row."""
    session.delete(row)


def kept(row: OwnEffectRow) -> OwnEffect:
    """What a row holds."""
    data = {name: getattr(row, name) for name in _FIELDS}
    return OwnEffect(**data | {"alike": tuple(row.alike)})
