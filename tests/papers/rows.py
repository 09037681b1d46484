"""All rows, in the order of the papers."""

from __future__ import annotations

import re

from tests.papers import (
    hybrid,
    kononykhin_model,
    kononykhin_use,
    payload,
    qian_identification,
    qian_model,
    qian_use,
    service,
)
from tests.papers.page import PAPERS
from tests.papers.row import Row

ROOMS = (qian_model, qian_identification, qian_use, kononykhin_model, kononykhin_use, payload, hybrid, service)


def _place(row: Row) -> tuple[int, int]:
    """By the paper, then by the number."""
    return list(PAPERS).index(row.name[0]), int(re.sub(r"\D", "", row.name))


ROWS: tuple[Row, ...] = tuple(sorted((row for room in ROOMS for row in room.ROWS), key=_place))
