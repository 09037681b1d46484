"""Room that is kept free: below it nothing large is taken in, so that what is under way can still be stored."""

from __future__ import annotations

import shutil

from app.context import Context
from app.errors import Failure


def check_reserve(context: Context) -> None:
    """Raise Failure 507 where less is free than the reserve."""
    settings = context.settings
    free = shutil.disk_usage(settings.data).free
    if free < settings.reserve:
        what = f"{free >> 20} MB are free where {settings.reserve >> 20} MB are kept in reserve"
        raise Failure(507, "disk-reserve", what, "upload", "free some space, or lower --reserve; reading still works")
