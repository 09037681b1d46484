"""/backups: all that the service knows, as one file."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from fastapi.responses import FileResponse
from starlette.background import BackgroundTask

from app.access.roles import ADMIN
from app.backup import backup_file
from app.context import Here
from app.errors import COMMON

router = APIRouter(prefix="/backups", tags=["operation"], responses=COMMON)
_FILE: dict[int | str, dict[str, Any]] = {200: {"content": {"application/zip": {}}, "description": "The backup"}}


@router.post("", dependencies=[ADMIN], response_class=FileResponse, responses=_FILE)
def take_backup(here: Here) -> FileResponse:
    """All records and raw uploads as they are at one moment, as `servoident backup` writes them."""
    file, name = backup_file.taken(here)
    return FileResponse(
        file, media_type="application/zip", filename=name, background=BackgroundTask(backup_file.drop, file)
    )
