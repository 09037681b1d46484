"""A chart in two parts: the frame, built once for all that are alike, and what is put into it.

What differs from run to run and from band to band are tables, words and ends of axes. A frame names them, so that it
need not be built again, and a page that draws it live need only exchange them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Lock
from typing import Any

import altair as alt
from altair.utils import schemapi

_lock = Lock()
_building = 0
Row = dict[str, Any]
Frame = Mapping[str, Any]
"""Vega-Lite without data; its `params` are declared, what else it names is a blank."""


@contextmanager
def unchecked() -> Iterator[None]:
    """Altair would check each part against its schema, which takes longer than all the rest, and knows no blanks.

    It has one switch for all threads: the checks are on again once nobody draws.
    """
    global _building  # noqa: PLW0603
    with _lock:
        _building += 1
        schemapi.DEBUG_MODE = False
    try:
        yield
    finally:
        with _lock:
            _building -= 1
            schemapi.DEBUG_MODE = _building == 0


def blank(name: str) -> Any:
    """A place in a frame for a word, a number or a list that is put in later."""
    return alt.ExprRef(expr=name)


def frame(chart: alt.TopLevelMixin, values: Mapping[str, Any] | None = None) -> Frame:
    """A chart with blanks as a frame, not to be changed, with the `values` by name that its expressions read.

    Altair would hand each value on to every panel and back, with a copy of the whole chart at each step.
    """
    built: dict[str, Any] = chart.to_dict(validate=False)
    if values:
        declared = ({"name": name, "value": value} for name, value in values.items())
        built["params"] = [*built.get("params", ()), *declared]
    return built


@dataclass(frozen=True)
class Filled:
    """A frame with its tables, and with the values of its parameters and its blanks by name."""

    frame: Frame
    tables: Mapping[str, list[Row]]
    values: Mapping[str, Any]

    def to_dict(self, *, live: bool = False) -> dict[str, Any]:
        """Vega-Lite; the blanks are filled in, or where it is to be drawn `live`, are parameters too."""
        declared = self.frame.get("params", ())
        names = {param["name"] for param in declared}
        blanks = {name: value for name, value in self.values.items() if name not in names}
        params = [{**p, "value": self.values[p["name"]]} if p["name"] in self.values else p for p in declared]
        spec = dict(self.frame) if live else _put_in(self.frame, blanks)
        if live:
            params += [{"name": name, "value": value} for name, value in blanks.items()]
        return {**spec, **({"params": params} if params else {}), "datasets": dict(self.tables)}

    def to_json(self, *, live: bool = False, **_: Any) -> str:
        """As text."""
        return json.dumps(self.to_dict(live=live))


def _put_in(part: Any, blanks: Mapping[str, Any]) -> Any:
    """A part of a frame with its blanks filled in."""
    if isinstance(part, Mapping):
        if part.keys() == {"expr"} and part["expr"] in blanks:
            return blanks[part["expr"]]
        return {name: _put_in(each, blanks) for name, each in part.items()}
    if isinstance(part, Sequence) and not isinstance(part, str):
        return [_put_in(each, blanks) for each in part]
    return part
