"""Collected by tests/test_alone.py alone: in a process that other tests share, what they look at may be another's."""

from __future__ import annotations

import os

collect_ignore_glob = [] if os.environ.get("SERVOIDENT_ALONE") else ["test_*.py"]
