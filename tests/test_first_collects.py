"""One worker collects first, and compiles what the others find."""

from __future__ import annotations

import threading

import pytest

from tests.first_collects import after_the_first


def test_those_that_come_meanwhile_go_on_together_when_the_first_has_ended(tmp_path):
    pytest.importorskip("fcntl")
    (tmp_path / "file").touch()
    ended, begun, end, both = [], threading.Event(), threading.Event(), threading.Barrier(2, timeout=60.0)

    def first() -> None:
        with after_the_first(tmp_path / "file"):
            begun.set()
            end.wait()
            ended.append("first")

    def other() -> None:
        with after_the_first(tmp_path / "file"):
            both.wait()
            ended.append("other")

    threads = [threading.Thread(target=first), *(threading.Thread(target=other) for _ in range(2))]
    threads[0].start()
    begun.wait()
    for thread in threads[1:]:
        thread.start()
    threads[1].join(0.2)
    end.set()
    for thread in threads:
        thread.join()
    assert ended == ["first", "other", "other"]
