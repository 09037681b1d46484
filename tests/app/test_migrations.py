"""What an earlier version stored is still there after the newest migrations, and after going back."""

from __future__ import annotations

from pathlib import Path

from alembic import command
from alembic.config import Config

from app.database import MIGRATIONS, connect

ANSWERED = "INSERT INTO idempotency VALUES ('k', 'asked', 202, '{\"id\": 1}', '/x', '2026-01-01T00:00:00.000000+00:00')"
CLAIMED = "INSERT INTO idempotency (key, fingerprint, body, location, created_at) VALUES ('c', 'asked', '{}', '', '')"
KEYS = "SELECT key, status FROM idempotency"


def test_answers_outlive_the_claims_of_keys(tmp_path: Path) -> None:
    """Going back leaves out what was claimed and never answered: the version before knows no claims."""
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.attributes["url"] = f"sqlite:///{tmp_path / 'records.sqlite'}"
    engine = connect(config.attributes["url"])
    command.upgrade(config, "0004")
    with engine.begin() as connection:
        connection.exec_driver_sql(ANSWERED)
    command.upgrade(config, "head")
    with engine.begin() as connection:
        connection.exec_driver_sql(CLAIMED)
        assert set(connection.exec_driver_sql(KEYS)) == {("k", 202), ("c", None)}
    command.downgrade(config, "0004")
    with engine.begin() as connection:
        assert set(connection.exec_driver_sql(KEYS)) == {("k", 202)}
    engine.dispose()
