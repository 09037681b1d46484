"""A drive by inverse-dynamics regression: mass and friction from measured force and motion, the rest by output error.

    drive_force = m₀ v′ + c₀ v + Fc sgn v − F0

gives mass, viscous and dry friction and the constant force at once, see :mod:`ident.fit.inverse_dynamics`; only the
gains of a position loop, where there is one, are then searched. Errors are those of the simulated position, as of any
fit.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ident.errors import Unusable
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.identification import Identification
from ident.fit.inverse_dynamics import InverseDynamics, regress
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.progress import Report, silent
from ident.words.error import error_said
from ident.words.run_name import run_name

NAME = "inverse-dynamics"
EFFECTS = ("coulomb_friction", "static_load")


class RegressedIdentification(Identification):
    """One fit of the model `drive`. Raises Unusable with effects of its own, or without a force."""

    def __init__(self, matrix: Matrix, settings: Settings, report: Report = silent) -> None:
        if set(settings.effects) - set(EFFECTS):
            raise Unusable(
                "method-does-not-fit",
                f"{NAME} finds mass, friction and a constant force",
                "method",
                f"use it with no effect but {' and '.join(EFFECTS)}",
            )
        self.asked, self.regression = settings, regress(matrix)
        fixed = {**_values(self.regression), "k0": FIT_CRITERIA.inverse_dynamics.slack, **settings.fixed}
        super().__init__(matrix, replace(settings, method="ga", effects=EFFECTS, fixed=fixed), report)

    def finish(self, state: dict[str, Any]) -> FitResult:
        """The fit, with the regression's standard errors."""
        found = super().finish(state)
        parameters = dict(found.parameters)
        for name, source in _SOURCES.items():
            error = self.regression.coefficients[source].std_error
            parameters[name] = replace(parameters[name], std_error=error, fixed=False)
        with_, without = self.regression.residual, self.regression.residual_without_friction
        said = tuple(
            f"{run_name(run)}: force residual {error_said(with_[run])}, without dry friction {error_said(without[run])}"
            for run in with_
        )
        return replace(
            found,
            method=NAME,
            parameters=parameters,
            notes=(*found.notes, *said),
            settings={**found.settings, "method": NAME},
        )


_SOURCES = {"m0": "mass", "c0": "viscous", "coulomb_friction.force": "coulomb", "static_load.force": "offset"}


def _values(regression: InverseDynamics) -> dict[str, float]:
    values = {name: regression.coefficients[source].value for name, source in _SOURCES.items()}
    for name in ("m0", "c0", "coulomb_friction.force"):
        if values[name] <= 0:
            raise Unusable(
                "not-a-drive", f"{name} would be {values[name]:.3g}", NAME, "check the signs of force and position"
            )
    return values | {"static_load.force": -values["static_load.force"]}
