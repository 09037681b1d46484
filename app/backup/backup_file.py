"""A backup on its way to who asked for it: it lies in the data folder until it has been sent."""

from __future__ import annotations

import shutil
import tempfile
from datetime import UTC, datetime
from pathlib import Path

from app.backup.service import backup
from app.context import Context

_FOLDERS = "backup-"
"""Beginning of the names of folders that hold one; what a kill leaves of them goes with the next."""


def taken(context: Context) -> tuple[Path, str]:
    """A new backup, and what it is to be called. Raises OSError where the disk is full; then nothing is left."""
    now = datetime.now(UTC)
    for left in context.settings.data.glob(f"{_FOLDERS}*"):
        if now.timestamp() - left.stat().st_mtime > 86_400:
            shutil.rmtree(left, ignore_errors=True)
    folder = Path(tempfile.mkdtemp(dir=context.settings.data, prefix=_FOLDERS))
    try:
        backup(context.settings, folder / "all.backup")
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return folder / "all.backup", f"servoident-{now:%Y-%m-%d-%H%M}.backup"


def drop(file: Path) -> None:
    """Remove it."""
    shutil.rmtree(file.parent, ignore_errors=True)
