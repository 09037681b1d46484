"""Couriers with a clock that is set by hand, and a database whose records are made by hand."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy.orm import Session, sessionmaker

from app.settings import Settings
from app.tables import ActuatorRow, FitRow, MatrixRow, SetRow, ValueRow
from app.webhooks.courier import Courier
from app.webhooks.key import key_of
from app.webhooks.sending import client
from tests.conftest import ROOT

SUMMARY: dict[str, Any] = {"data_hash": "", "runs": [], "findings": [], "notices": []}
RESULT: dict[str, Any] = json.loads((ROOT / "tests" / "stored" / "fit.json").read_text(encoding="utf-8"))
PATIENCE = 0.3  # s, of the tests


@dataclass
class World:
    """A courier at a moment, which lies behind all that a test takes."""

    sessions: sessionmaker[Session]
    settings: Settings
    moment: datetime = field(default_factory=lambda: datetime.now(UTC) + timedelta(hours=1))

    def __post_init__(self) -> None:
        self.http = client(PATIENCE)
        self.courier = Courier(self.sessions, self.settings, lambda: self.moment, self.http)

    def round(self, **later: float) -> None:
        """All that is due after so much time."""
        self.moment += timedelta(**later)
        self.courier.round(key_of(self.settings))


def set_of(session: Session, serial: str, z0: float = 2.6e-6) -> str:
    """A fit of an actuator, as if it had been made; its id."""
    session.add(ActuatorRow(serial=serial, batch="B"))
    session.flush()
    session.add(MatrixRow(id=f"m-{serial}", serial=serial, batch="B", source={}, summary=SUMMARY))
    session.flush()
    row = FitRow(id=f"f-{serial}", matrix=f"m-{serial}", serial=serial, model="qian2014", result=RESULT)
    row.set = SetRow(serial=serial, batch="B", model="qian2014", error_fit=0.01, error_verify=0.02)
    row.set.values = [ValueRow(name="Z0", place=0, value=z0, unit="m^4/s", std_error=1e-8)]
    session.add(row)
    return row.id
