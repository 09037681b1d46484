"""Everything that the page shows which puts a fit to use."""

from __future__ import annotations

from dataclasses import dataclass

from app.fits.rows import error_rows
from app.fits.service import Stored
from app.pages.control_view import ControlView
from app.pages.hybrid_view import HybridSection
from app.pages.position_loop_view import PositionLoopView
from app.pages.tracking_view import TrackingView
from app.pages.what_if_view import WhatIfView
from ident.custom.definition import preset_with
from ident.export import FORMATS, Format
from ident.words.titles import with_effects

CASES = (
    ("qian", "Qian et al. 2014, one storey"),
    *((f"benchmark2020-{n}", f"benchmark of 2020, case {n}") for n in (1, 2, 3, 4)),
)
"""Cases that are built in, with what they are."""
OWN_CASE = """\
structure: {mass: 87.5 kg, stiffness: 87.5 kN/m, damping: 3.5 kN*s/m}
physical: {mass: 8.75 kg, stiffness: 17.5 kN/m, damping: 0 N*s/m}
gain: 2
piston_area: 497 mm^2
ground: {kind: blwn, band: 30 Hz, amplitude: 0.1 g, duration: 10 s}
sample_rate: 4096 Hz
delay: 1
noise: {displacement: 1 um}
"""
"""What the field for an own case begins with: the first case, written out."""


@dataclass(frozen=True, kw_only=True)
class UseView:
    """A fit and what can be done with it: a section a task."""

    id: str
    serial: str
    matrix: str
    title: str
    current: bool
    errors: str
    control: ControlView
    hybrid: HybridSection
    what_if: WhatIfView
    tracking: TrackingView
    position_loop: PositionLoopView
    on_bench: bool
    cases: tuple[tuple[str, str], ...] = CASES
    example: str = OWN_CASE
    exports: tuple[Format, ...] = tuple(FORMATS.values())


def use_view(
    stored: Stored,
    control: ControlView,
    hybrid: HybridSection,
    what_if: WhatIfView,
    tracking: TrackingView,
    position_loop: PositionLoopView,
) -> UseView:
    """The page of a fit with its sections."""
    fit = stored.found
    model = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    errors = [f"{row.error} on {row.use.lower()} runs" for row in error_rows(fit)]
    return UseView(
        id=stored.id,
        serial=stored.serial,
        matrix=stored.matrix,
        title=with_effects(model.title, fit.effects),
        current=stored.current,
        errors=", ".join(errors),
        control=control,
        hybrid=hybrid,
        what_if=what_if,
        tracking=tracking,
        position_loop=position_loop,
        on_bench=model.kind == "bench",
    )
