"""The time that a job has left, judged by the courses of jobs of its kind that have ended.

Each ended job says: this one is where I was at the time t of my T seconds, and has taken r times as long to come here;
so r (T − t) are left. Of the stage that is under way r is its own, where it counts its steps. The estimate is the
median of what they say, where jobs that were asked the same, and took about as long to come here, count most. Where
they disagree, or are few, it leans to what is known of any work of unknown length: as long again as it has taken (Gott,
Nature 363, 1993, p. 315), and at least as long as the steps that are counted.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from app.jobs.stage_times import Course

MOST = 100  # ended jobs that are looked at, the newest
_INSTANT = 0.2  # s: what is shorter is the machine's, not the work's
_LEAST = 0.1  # of a stage that has gone on longer than expected: its least remaining share
_DIFFERENT = 0.5  # weight of a job for each thing that it was asked otherwise
_PACE = math.log(2)  # a job at twice or half the pace counts 0.6
_UNKNOWN = 1.6  # ln: half of all work lasts between a third and three times as long again as it has taken
_OWN = 0.5  # ln: what is uncertain about a job that goes as the others went


@dataclass(frozen=True)
class TimeLeft:
    """Seconds left; as likely as not they lie between `lower` and `upper`. `jobs` says how many ended jobs tell so."""

    seconds: float
    lower: float
    upper: float
    jobs: int


@dataclass(frozen=True)
class _Said:
    """What an ended job says: ln of the seconds left, what that counts, and the seconds left of a stage that counts."""

    left: float
    weight: float
    rest: float


def time_left(now: Course, ended: Sequence[Course]) -> TimeLeft | None:
    """The time that a job has left; None before it has said where it is, and where no ended job was there."""
    if not now.stages or now.seconds <= 0:
        return None
    said = sorted((one for past in ended for one in _told(now, past)), key=lambda one: one.left)
    if not said:
        return None
    weights = [one.weight for one in said]
    independent = sum(weights) ** 2 / sum(weight**2 for weight in weights)
    low, middle, high = (_quantile(said, share) for share in (0.16, 0.5, 0.84))
    spread = math.hypot((high - low) / 2, _OWN) * math.sqrt(1 + 1 / independent)
    trust = spread**-2 / (spread**-2 + _UNKNOWN**-2)
    again = max(now.seconds, min(one.rest for one in said))
    left = math.exp(trust * middle + (1 - trust) * math.log(again))
    factor, most = math.exp(0.67 * spread * math.sqrt(trust)), math.inf
    if now.limit is not None:
        most = max(now.limit - now.seconds, _INSTANT)
    return TimeLeft(min(left, most), min(left / factor, most), min(left * factor, most), len(said))


def _told(now: Course, past: Course) -> Iterator[_Said]:
    """What an ended job says, if it came to the stage that is under way, and was not cut."""
    found = None if past.cut else _same(now, past)
    if found is None:
        return
    stage, mine = past.stages[found], now.stages[-1]
    heard, share = mine.moments[-1]
    then = stage.when(share)
    times = mine.total / stage.total if stage.counts and mine.total > 1 < stage.total else 1.0  # as many steps
    pace = _ratio(heard, stage.began + times * (then - stage.began))
    within = _ratio(heard - mine.began, times * (then - stage.began)) if share else pace
    end = past.stages[found + 1].began if found + 1 < len(past.stages) else past.seconds
    rest, silent = within * times * (end - then), now.seconds - heard
    rest = max(rest - silent, _LEAST * max(rest, silent))
    left = rest + pace * (past.seconds - end)
    of_count = rest if share and stage.counts else 0.0
    yield _Said(math.log(max(left, _INSTANT / 4)), _weight(now, past, pace, found), of_count)


def _ratio(mine: float, theirs: float) -> float:
    """How many times as long as the other job this one took, both in s."""
    return (mine + _INSTANT) / (theirs + _INSTANT)


def _weight(now: Course, past: Course, pace: float, found: int) -> float:
    """How much an ended job counts: by what it was asked, and by the way that it came to the stage."""
    different = sum(now.asked.get(name) != past.asked.get(name) for name in {*now.asked, *past.asked})
    different += now.stages[-1].total != past.stages[found].total
    off = different + 0.5 * abs(len(now.stages) - 1 - found)
    alike: float = _DIFFERENT**off
    return alike * math.exp(-((math.log(pace) / _PACE) ** 2) / 2) + 1e-9


def _same(now: Course, past: Course) -> int | None:
    """Which stage of an ended job is the one that is under way: as often come to, else the last of its name."""
    name = now.stages[-1].name
    found = [place for place, stage in enumerate(past.stages) if stage.name == name]
    times = sum(stage.name == name for stage in now.stages)
    return found[min(times, len(found)) - 1] if found else None


def _quantile(said: Sequence[_Said], share: float) -> float:
    """That of what is said, by weight."""
    wanted, so_far = share * sum(one.weight for one in said), 0.0
    for one in said:
        so_far += one.weight
        if so_far >= wanted:
            return one.left
    return said[-1].left
