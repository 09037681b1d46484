"""The numbers of the sets that meet all that is asked, newest first.

Where many meet it, the newest sets are looked through, which soon fills a page. Where few do, those that meet each
condition are collected by its index, and put together here: a database takes three times as long to. Either way is slow
where the other belongs, so a page is first looked for among so many of the newest as cost next to nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import BindParameter, Integer, Select, String, bindparam, cast, func, select
from sqlalchemy.orm import Session

from app.parameters.repository.conditions import (
    SET,
    Condition,
    Numbers,
    Shape,
    Test,
    conditions,
    never_approved,
    shape,
    values,
)
from app.parameters.set_query import SetQuery

FEW = 20_000
"""Sets of one condition that are collected at most, and of the newest that are looked through first."""
_SAMPLE = 1000  # of the newest, which tell whether it is worth while to look through so many
_MOST: BindParameter[int] = bindparam("most", type_=Integer)
_LAST = select(func.max(SET))
_TESTED = 1000  # of those that were collected, tested at once for whether they remain


def numbers(session: Session, wanted: SetQuery, before: int | None, limit: int) -> list[int]:
    """The numbers of a page, from the one before this number on."""
    asked = _asked(shape(wanted))
    given = values(wanted)
    narrow = _collected(session, asked.few, given)
    if not narrow:
        top = before if before is not None else (session.scalar(_LAST) or 0) + 1
        found: list[int] = []
        upto = top
        for newest in (_SAMPLE, FEW):
            found += _walked(session, asked, given, upto, top - newest, limit - len(found))
            if len(found) == limit or top <= newest:
                return found
            if 2 * len(found) * (FEW // newest) < limit:  # not among so many either
                break
            upto = top - newest + 1
        narrow = _collected(session, asked.others, given)
        if not narrow:
            return _walked(session, asked, given, top, 0, limit)
    common = np.sort(reduce(partial(np.intersect1d, assume_unique=True), narrow.values()))
    common = common[: None if before is None else np.searchsorted(common, before)][::-1]
    tests = [*asked.tests, *(one.test for one in (*asked.few.of, *asked.others.of) if one not in narrow)]
    return _tested(session, common.tolist(), tests, given, limit) if tests else common[:limit].tolist()


def every(wanted: SetQuery) -> Numbers:
    """The query for all of them, in no order."""
    asked = shape(wanted)
    query = select(SET)
    for condition in conditions(asked):
        query = query.where(SET.in_(condition.hits))
    query = query.where(never_approved(SET)) if wanted.approved is False else query
    return query.params(values(wanted))


@dataclass(frozen=True, eq=False)
class _Collection:
    """Conditions, and the query for the numbers that meet each, so many at most, as one text each.

    As rows they would take five times as long.
    """

    of: tuple[Condition, ...]

    @cached_property
    def query(self) -> Select[*tuple[Any, ...]]:
        some = (one.hits.limit(_MOST).subquery(f"some_{at}") for at, one in enumerate(self.of))
        texts = (select(func.aggregate_strings(cast(each.c[0], String), ",")).scalar_subquery() for each in some)
        return select(*texts)


@dataclass(frozen=True)
class _Asked:
    """The queries for what is asked, made once: to make them takes as long as many of their answers.

    `walk` finds sets between two numbers, newest first, by the index of one condition, and tests them for the others.
    """

    few: _Collection
    others: _Collection
    tests: tuple[Test, ...]
    walk: Numbers


@lru_cache(maxsize=256)
def _asked(asked: Shape) -> _Asked:
    every_one = tuple(conditions(asked))
    tests: tuple[Test, ...] = (never_approved,) if asked.approved is False else ()
    lead = next((one for one in every_one if one.walk is not None), None)
    query, number = (select(SET), SET) if lead is None or lead.walk is None else (lead.walk, lead.number)
    for test in (*tests, *(one.test for one in every_one if one is not lead)):
        query = query.where(test(number))
    walk = query.where(number < bindparam("upto"), number > bindparam("after")).order_by(number.desc()).limit(_MOST)
    few, others = (tuple(one for one in every_one if one.few is wanted) for wanted in (True, False))
    return _Asked(_Collection(few), _Collection(others), tests, walk)


def _walked(session: Session, asked: _Asked, given: Mapping[str, Any], upto: int, after: int, limit: int) -> list[int]:
    """The newest sets between two numbers that meet all."""
    return list(session.scalars(asked.walk, {**given, "upto": upto, "after": max(after, 0), "most": limit}))


def _collected(session: Session, asked: _Collection, given: Mapping[str, Any]) -> dict[Condition, NDArray[np.int64]]:
    """The numbers of the sets that meet each condition that few meet; each number once."""
    found = {}
    texts = session.execute(asked.query, {**given, "most": FEW + 1}).one() if asked.of else ()
    for condition, text in zip(asked.of, texts, strict=True):
        each = np.fromstring(text, np.int64, sep=",") if text else np.empty(0, np.int64)
        if len(each) <= FEW:
            found[condition] = each
    return found


def _tested(
    session: Session, numbers: Sequence[int], tests: Sequence[Test], given: Mapping[str, Any], limit: int
) -> list[int]:
    """Those that pass, until there are as many as are wanted."""
    found: list[int] = []
    for at in range(0, len(numbers), _TESTED):
        query = select(SET).where(SET.in_(numbers[at : at + _TESTED]), *(test(SET) for test in tests))
        found += session.scalars(query.order_by(SET.desc()), given)
        if len(found) >= limit:
            break
    return found[:limit]
