"""The log as lines of JSON, for a machine: each with its request's id, and its job's, where it belongs to one."""

from __future__ import annotations

import json
import logging
import sys
from datetime import UTC, datetime

from app.request_id import request_id

_TOLD = ("job", "kind", "worker", "lease", "state", "method", "path", "status", "seconds")
"""What a line may say besides its text."""


class JsonLines(logging.Formatter):
    """A record as one line of JSON."""

    def format(self, record: logging.LogRecord) -> str:
        """The line."""
        line = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "text": record.getMessage(),
            "request": request_id(),
        }
        line |= {name: getattr(record, name) for name in _TOLD if hasattr(record, name)}
        if record.exc_info:
            line["traceback"] = self.formatException(record.exc_info)
        return json.dumps({name: value for name, value in line.items() if value != ""}, default=str)


def in_json() -> None:
    """Log all that the program does, and what its libraries warn of, as lines of JSON on standard error."""
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(JsonLines())
    logging.basicConfig(level=logging.WARNING, handlers=[handler], force=True)
    logging.getLogger("servoident").setLevel(logging.INFO)
