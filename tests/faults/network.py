"""A second machine: a network of its own, joined to this one by a link that can be cut."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

HERE, THERE = "10.213.77.1", "10.213.77.2"
NAME, ENDS = "servoident-other", ("servoident-a", "servoident-b")


def possible() -> str:
    """Why there can be no second machine here; nothing where there can."""
    if shutil.which("ip") is None:
        return "iproute2 is not installed"
    if os.geteuid() != 0:
        return "only root makes a network"
    trial = f"{NAME}-trial"
    done = subprocess.run(["ip", "netns", "add", trial], capture_output=True, text=True, check=False)
    if done.returncode:
        return f"no network can be made: {done.stderr.strip()}"
    _ip("netns", "del", trial)
    return ""


class Link:
    """The link between the two; `within` runs a command on the other machine."""

    within = ("ip", "netns", "exec", NAME)

    def cut(self) -> None:
        """Nothing comes through, and nobody is told."""
        _ip("link", "set", ENDS[0], "down")

    def restore(self) -> None:
        """As before."""
        _ip("link", "set", ENDS[0], "up")


@contextmanager
def joined() -> Iterator[Link]:
    """A second network and the link to it, gone at the end."""
    _ip("netns", "add", NAME)
    try:
        _ip("link", "add", ENDS[0], "type", "veth", "peer", "name", ENDS[1])
        _ip("link", "set", ENDS[1], "netns", NAME)
        _ip("addr", "add", f"{HERE}/30", "dev", ENDS[0])
        _ip("link", "set", ENDS[0], "up")
        _ip("-n", NAME, "addr", "add", f"{THERE}/30", "dev", ENDS[1])
        _ip("-n", NAME, "link", "set", ENDS[1], "up")
        _ip("-n", NAME, "link", "set", "lo", "up")
        yield Link()
    finally:
        subprocess.run(["ip", "link", "del", ENDS[0]], capture_output=True, check=False)
        _ip("netns", "del", NAME)


def _ip(*arguments: str) -> None:
    subprocess.run(["ip", *arguments], check=True, capture_output=True)
