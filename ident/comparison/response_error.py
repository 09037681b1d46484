"""How surely the frequency response of a linear model is known, from the covariance of its parameters.

First order: δ ln G = Σ (∂ ln G/∂θ) δθ, so that the covariance of ln|G| and of the phase is J Σ Jᵀ (Ljung, System
Identification, 2nd ed., section 9.4).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import linear_model
from ident.comparison.compare import fitted
from ident.fit.result import FitResult
from ident.matrix import Actuator, Matrix
from ident.run import Run

Array = NDArray[np.float64]
_STEP = 1e-3  # of a standard error


def response_error(fit: FitResult, run: Run, actuator: Actuator, frequency: Array) -> tuple[Array, Array] | None:
    """Standard errors of ln|G| and of the phase (rad) of the fitted model at `frequency` (f,) in Hz, both (f,).

    None where the model has effects, or where the errors of its parameters are not known.
    """
    if fit.effects:
        return None
    names = [name for name, entry in fit.parameters.items() if name in fit.correlation and not entry.fixed]
    errors = [fit.parameters[name].std_error for name in names]
    if not names or any(error is None for error in errors):
        return None
    deviation = np.array(errors, float)
    correlation = np.array([[fit.correlation[a].get(b, float(a == b)) for b in names] for a in names])

    def log_response(moved: FitResult) -> NDArray[np.complex128]:
        preset, matrix, values = fitted(moved, Matrix(actuator, (run,)))
        model = linear_model(preset.core, values, matrix.runs[0], actuator)
        return np.asarray(np.log(model.frequency_response(frequency)[0]))

    here = log_response(fit)
    slopes = np.array(
        [
            _wrapped(log_response(_moved(fit, name, _STEP * error)) - here) / _STEP
            for name, error in zip(names, deviation, strict=True)
        ]
    )
    size, phase = (
        np.sqrt(np.maximum(np.einsum("af,ab,bf->f", part, correlation, part), 0.0))
        for part in (slopes.real, slopes.imag)
    )
    return size, phase


def _moved(fit: FitResult, name: str, by: float) -> FitResult:
    entry = fit.parameters[name]
    return replace(fit, parameters={**fit.parameters, name: replace(entry, value=entry.value + by)})


def _wrapped(difference: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """With phases within half a turn."""
    return np.asarray(difference.real + 1j * np.angle(np.exp(1j * difference.imag)))
