"""The steps of a search as the queue stores them: each generation once, with the step that made it.

A search's state holds the whole history so far. What a step adds to it is stored, and the whole is put together from
the steps again, bit for bit: also where the process that made the first of them was killed.
"""

from __future__ import annotations

from app.jobs.work import State


def added(before: State, made: State) -> State:
    """What a step made of the state `before`, without the generations that this knew.

    The first new generation is the population that was waiting in the state before: it is not stored again.
    """
    history = made["state"].get("history")
    if history is None or "history" not in before:
        return made
    known = len(before["history"])
    new = [dict(entry) for entry in history[known:]]
    if new and new[0]["population"] == before["population"]:
        del new[0]["population"]
    return {**made, "known": known, "state": {**made["state"], "history": new}}


def whole(before: State, stored: State) -> State:
    """What the step made; what a version before this one stored is whole already."""
    if "known" not in stored:
        return stored
    waiting = {"population": before["population"]}
    new = [waiting | entry for entry in stored["state"]["history"]]
    history = [*before["history"][: stored["known"]], *new]
    return {"outcome": stored["outcome"], "state": {**stored["state"], "history": history}}
