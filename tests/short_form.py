"""Of many cases of one test, those of the short form; the others run with ``--full``."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def short_form(cases: Iterable[Any], *kept: Any) -> list[Any]:
    """All cases for `parametrize`, of which those that are not `kept` are marked `full`.

    A case of several arguments is a tuple. Raises ValueError where one that is to be kept is none of them.
    """
    cases = list(cases)
    unknown = [one for one in kept if one not in cases]
    if unknown:
        raise ValueError(f"no such case: {unknown}")
    return [one if one in kept else _full(one) for one in cases]


def _full(case: Any) -> Any:
    values = case if isinstance(case, tuple) else (case,)
    return pytest.param(*values, marks=pytest.mark.full)
