"""Which equations a fit was made with, as a hash: whether a model has changed since is seen without a refit."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

from ident.custom.definition import preset_with
from ident.errors import Unusable


def equations_of(result: Mapping[str, Any]) -> str:
    """The hash of the equations of a fit's model with its effects; "" where this version does not know the model."""
    custom = result.get("settings", {}).get("custom", ())
    try:
        equations = preset_with(result["model"], result["effects"], custom).chain.equations
        return hashlib.sha256("\n".join(equation.text for equation in equations).encode()).hexdigest()
    except Unusable:
        return ""
