"""Figures of a fit: those of its data, and the ladder of fits that led to it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from app.context import Context
from app.errors import Failure
from app.fits import lineage, service
from app.matrices import service as matrices
from ident.errors import Unusable
from ident.figures import MEDIA, Chart, figure, ladder, look, render
from ident.figures.ladder import Step
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.presets import preset
from schemas.fit import LadderRung


def drawn(context: Context, fit_id: str, name: str, kind: str, options: dict[str, Any]) -> tuple[bytes, str]:
    """A figure of a fit as bytes and their media type."""
    row = service.find(context, fit_id)
    if kind not in MEDIA:
        raise Failure(404, "no-such-format", f"no figures as {kind!r}", "figure", f"use {', '.join(MEDIA)}")
    theme = options.pop("theme", "light")
    fit, matrix = FitResult.from_json(row.result), matrices.load(context, row.matrix)
    if name == "ladder":
        if options:
            raise Unusable("unknown-option", f"no option {next(iter(options))!r}", "figure ladder", "use theme")
        steps = list(_steps(lineage.ladder(context, fit_id).rungs, fit.model))
        return render(ladder(steps, fit.noise_floor.get("fit"), matrix.actuator, look(theme)), kind), MEDIA[kind]
    return render(_figure(context, name, matrix, fit, theme, options), kind), MEDIA[kind]


def _figure(context: Context, name: str, matrix: Matrix, fit: FitResult, theme: str, options: dict[str, Any]) -> Chart:
    if options.get("candidate"):
        options["candidate"] = FitResult.from_json(service.find(context, str(options["candidate"])).result)
    else:
        options.pop("candidate", None)
    return figure(name, matrix, fit, theme, **options)


def _steps(rungs: list[LadderRung], model: str) -> Iterator[Step]:
    """A step a fit: the model, then what each refit added."""
    for place, rung in enumerate(rungs):
        names = [name.replace("_", " ") for name in rung.added]
        label = " + ".join(names if place else (preset(model).title, *names)) or "fitted again"
        yield label, rung.error["fit"], rung.error["verify"]
