"""The numbers of the sets that meet all that is asked, newest first.

Where many meet it, the newest sets are looked through, which soon fills a page. Where few do, those that meet each
condition are collected by its index, and put together here: a database takes three times as long to. Either way is slow
where the other belongs, so a page is first looked for among so many of the newest as cost next to nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial, reduce

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import String, cast, func, select
from sqlalchemy.orm import Session

from app.parameters.repository.conditions import SET, Condition, Numbers, Test, conditions, never_approved
from app.parameters.wanted import Wanted

FEW = 20_000
"""Sets of one condition that are collected at most, and of the newest that are looked through first."""
_SAMPLE = 2000  # of the newest, which tell whether it is worth while to look through so many
_TESTED = 1000  # of those that were collected, tested at once for what is left


def numbers(session: Session, wanted: Wanted, before: int | None, limit: int) -> list[int]:
    """The numbers of a page, from the one before this number on."""
    asked = list(conditions(wanted))
    tests: list[Test] = [never_approved] if wanted.approved is False else []
    narrow = _collected(session, [one for one in asked if one.few])
    if not narrow:
        lead = next((one for one in asked if one.walk is not None), None)
        others = [*tests, *(one.test for one in asked if one is not lead)]
        top = before if before is not None else (session.scalar(select(func.max(SET))) or 0) + 1
        for newest in (_SAMPLE, FEW):
            found = _numbers(session, _walk(lead, others, before, top - newest).limit(limit))
            if len(found) == limit or top <= newest:
                return found
            if 2 * len(found) * (FEW // newest) < limit:  # not among so many either
                break
        narrow = _collected(session, [one for one in asked if not one.few])
        if not narrow:
            return _numbers(session, _walk(lead, others, before).limit(limit))
    common = np.sort(reduce(partial(np.intersect1d, assume_unique=True), narrow.values()))
    common = common[: None if before is None else np.searchsorted(common, before)][::-1]
    tests += [one.test for one in asked if id(one) not in narrow]
    return _tested(session, common.tolist(), tests, limit) if tests else common[:limit].tolist()


def every(wanted: Wanted) -> Numbers:
    """The query for all of them, in no order."""
    query = select(SET)
    for condition in conditions(wanted):
        query = query.where(SET.in_(condition.hits))
    return query.where(never_approved(SET)) if wanted.approved is False else query


def _walk(lead: Condition | None, tests: Sequence[Test], before: int | None, after: int = 0) -> Numbers:
    """Sets between two numbers, newest first, found by the index of a condition and tested for the others."""
    query, number = (select(SET), SET) if lead is None or lead.walk is None else (lead.walk, lead.number)
    for test in tests:
        query = query.where(test(number))
    if before is not None:
        query = query.where(number < before)
    if after > 0:
        query = query.where(number > after)
    return query.order_by(number.desc())


def _collected(session: Session, asked: Sequence[Condition]) -> dict[int, NDArray[np.int64]]:
    """The numbers of the sets that meet each condition that few meet, by its id; each number once.

    They come as one text: as rows they would take five times as long.
    """
    found = {}
    for condition in asked:
        some = condition.hits.limit(FEW + 1).subquery("some")
        text = session.scalar(select(func.aggregate_strings(cast(some.c[0], String), ",")))
        each = np.fromstring(text, np.int64, sep=",") if text else np.empty(0, np.int64)
        if len(each) <= FEW:
            found[id(condition)] = each
    return found


def _tested(session: Session, numbers: Sequence[int], tests: Sequence[Test], limit: int) -> list[int]:
    """Those that pass, until there are as many as are wanted."""
    found: list[int] = []
    for at in range(0, len(numbers), _TESTED):
        query = select(SET).where(SET.in_(numbers[at : at + _TESTED]), *(test(SET) for test in tests))
        found += _numbers(session, query.order_by(SET.desc()))
        if len(found) >= limit:
            break
    return found[:limit]


def _numbers(session: Session, query: Numbers) -> list[int]:
    return list(session.scalars(query))
