"""/fits: look at a fit, hold it against its data and others, take it away as a file."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.fits import error_sizes, export, service
from ident.residuals.budget import Budget
from schemas.fit import (
    ComparisonView,
    ErrorSizesView,
    FitView,
    SideBySideView,
)

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)
_EXPORTS: dict[str, dict[str, str]] = {media: {} for media in export.MEDIA.values()}
Mass = Annotated[str, Query(max_length=60, description="Mass that the machine moves, such as 2.06 kg")]
Stiffness = Annotated[str, Query(max_length=60, description="Stiffness of its specimen, such as 30.65 kN/m")]
Damping = Annotated[str, Query(max_length=60, description="Damping of its specimen, such as 120 N*s/m")]
Gain = Annotated[str, Query(max_length=60, description="Gain Kp of its loop; without it that of the model, or 1")]
Rate = Annotated[str, Query(max_length=60, description="Samples a second; without it 4096 Hz")]


@router.get("/{fit}", dependencies=[READERS], response_model_exclude_unset=True)
def get_fit(here: Here, fit: str) -> FitView:
    """A fit: the contract's fit JSON in `result`."""
    return service.get(here, fit)


@router.get("/{fit}/compare", dependencies=[READERS])
def compare_fit(here: Here, fit: str) -> ComparisonView:
    """Eq. (17) of every run, recomputed, where the model fails, and what the error is made of."""
    return service.comparison(here, fit)


@router.get("/{fit}/beside", dependencies=[READERS])
def compare_fits(here: Here, fit: str, other: Annotated[list[str], Query(max_length=7)]) -> SideBySideView:
    """The fit and others side by side: errors, parameters, runs; at most eight in all."""
    return service.side_by_side(here, fit, other)


@router.get("/{fit}/error-sizes", dependencies=[READERS])
def get_error_sizes(here: Here, fit: str) -> ErrorSizesView:
    """RMSE and MAE of each run in the unit of its output, beside which eq. (17) is a ratio."""
    return error_sizes.sizes(here, fit)


@router.get("/{fit}/budget", dependencies=[READERS])
def get_error_budget(here: Here, fit: str) -> Budget:
    """The error budget on estimation data: noise, error of the linear model, what only a nonlinear model removes."""
    return service.budget_of(here, fit)


@router.get(
    "/{fit}/identification.h",
    dependencies=[READERS],
    response_class=Response,
    responses={200: {"content": {"text/x-c": {}}}},
)
def export_identification(here: Here, fit: str) -> Response:
    """The identification of a bench's set as C header: a control unit finds the sheet from its own records."""
    name = 'attachment; filename="identification.h"'
    return Response(export.identification(here, fit), media_type="text/x-c", headers={"Content-Disposition": name})


@router.get(
    "/{fit}/export.{kind}", dependencies=[READERS], response_class=Response, responses={200: {"content": _EXPORTS}}
)
def export_fit(
    here: Here,
    fit: str,
    kind: str,
    mass: Mass = "",
    stiffness: Stiffness = "",
    damping: Damping = "",
    gain: Gain = "",
    sample_rate: Rate = "",
) -> Response:
    """The machine of a fit as h (C header), mat (state space of its linear part) or fmu (FMI 2, co-simulation)."""
    specimen = {"mass": mass, "stiffness": stiffness, "damping": damping}
    content, media, name = export.file(here, fit, kind, specimen, gain, sample_rate)
    return Response(content, media_type=media, headers={"Content-Disposition": f'attachment; filename="{name}"'})
