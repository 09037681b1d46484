"""A fit as a file for another program."""

from __future__ import annotations

from collections.abc import Mapping

from app.context import Context
from app.errors import Failure
from app.fits import service
from app.fits.studied import study
from ident.custom.definition import preset_with
from ident.errors import Unusable
from ident.export import FORMATS, USUAL_RATE, as_identification, exported
from ident.fit.result import FitResult
from ident.run import Specimen
from ident.units.quantity import parameter_value, quantity
from ident.words.titles import with_effects

MEDIA = {form.ending: form.media for form in FORMATS.values()}
"""The forms of an exported machine, by the ending of the file's name, with their media types."""


def identification(context: Context, fit_id: str) -> bytes:
    """The identification of the set that a fit is of, as C header.

    Raises Failure 404, and Unusable where the fit is not of a bench, or has effects.
    """
    found = FitResult.from_json(service.find(context, fit_id).result)
    model = preset_with(found.model, found.effects, found.settings.get("custom", ()))
    if model.kind != "bench" or found.effects:
        named = with_effects(found.model, found.effects)
        raise Unusable(
            "no-export",
            f"a control unit does not identify the model {named}",
            "fit",
            "give the fit of a bench's records, without effects",
        )
    _bench, analysis = study(context, fit_id).procedures
    return as_identification(analysis).encode()


def file(
    context: Context, fit_id: str, kind: str, specimen: Mapping[str, str], gain: str, sample_rate: str
) -> tuple[bytes, str, str]:
    """The machine of a fit as a file: bytes, media type, name; what is empty is not stated.

    Raises Failure 404, and Unusable for conditions that cannot be.
    """
    form = next((form for form in FORMATS.values() if form.ending == kind), None)
    if form is None:
        raise Failure(404, "no-such-format", f"no export as {kind!r}", "export", f"use {', '.join(MEDIA)}")
    moved = Specimen(**{name: quantity(text, name, name) for name, text in specimen.items() if text.strip()})
    rate = quantity(sample_rate, "frequency", "sample_rate") if sample_rate.strip() else USUAL_RATE
    kp = parameter_value(gain, "1", "gain") if gain.strip() else None
    row = service.find(context, fit_id)
    machine = exported(FitResult.from_json(row.result), moved, kp, rate)
    return form.write(machine), form.media, f"{machine.preset.name}.{form.ending}"
