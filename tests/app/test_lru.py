"""What was used last is in memory, and what was not used longest is forgotten."""

from __future__ import annotations

from app.lru import LRU


def test_an_item_is_made_once_while_it_is_used():
    made: list[str] = []

    def make(name: str) -> str:
        made.append(name)
        return name.upper()

    items: LRU[str] = LRU(2)
    for name in ("a", "b", "a", "c", "a", "b"):
        assert items.get(name, lambda name=name: make(name)) == name.upper()
    assert made == ["a", "b", "c", "b"]


def test_the_first_of_two_that_were_made_at_a_time_stays():
    items: LRU[str] = LRU(2)
    assert items.put("a", "first") == "first"
    assert items.put("a", "second") == "first"
    assert items.get("a", lambda: "third") == "first"
