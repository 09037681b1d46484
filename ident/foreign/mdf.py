"""Measurement Data Format, versions 3 and 4, by asammdf."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from asammdf import MDF


def columns(path: str) -> Iterator[tuple[str, str, Any]]:
    """Every channel as ``group/channel``, the times of a group as ``group/time``; a lone group needs no number.

    Raises ValueError where no group holds samples.
    """
    with MDF(path) as file:
        groups = [number for number, group in enumerate(file.groups) if group.channel_group.cycles_nr]
        if not groups:
            raise ValueError("no group holds samples")
        for number in groups:
            before = f"{number}/" if len(groups) > 1 else ""
            master = file.masters_db.get(number)
            yield f"{before}time", "s", file.get_master(number)
            for place, channel in enumerate(file.groups[number].channels):
                if place != master:
                    signal = file.get(group=number, index=place)
                    yield f"{before}{channel.name}", str(signal.unit or ""), signal.samples
