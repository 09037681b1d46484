"""The estimate of a parameter in a diagnosis."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ParameterEstimate:
    """One parameter of a refit, SI, with its standard error (None where the data do not determine it)."""

    value: float
    unit: str = "1"
    std_error: float | None = None
    symbol: str = ""
