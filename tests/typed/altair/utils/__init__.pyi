"""The part whose checks are turned off."""

from typing import Any

schemapi: Any
