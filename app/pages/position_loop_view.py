"""Margins of a position loop around a servo-actuator, as the page asks for them and shows them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

from app.fits.service import Stored
from ident.bench.position_loop import AmplitudeMargin, PositionLoop
from ident.custom.definition import preset_with
from ident.figures import drawings
from ident.stability.judgement import UNSTABLE
from ident.words.number import plain
from ident.words.percent import percent
from schemas.hybrid import PositionLoopRequest

FIELDS = (
    ("kp", "Kp", "80 %/mm", "Rated currents a metre of position error"),
    ("ki", "Ki", "0", "Rated currents a metre and second, 0 for a P regulator"),
    ("sample_time", "Sample time", "2 ms", "Empty for an analogue regulator"),
    ("delay", "Computation delay", "1 ms", "From sampling the position until the current changes"),
    ("limit", "Output limit", "100 %", "Of the rated current"),
    ("amplitudes", "Amplitudes at the play", "1 %; 5 %", "Of the rated current, with semicolons between them"),
)
"""Fields of the form: name, label, example, hint."""


@dataclass(frozen=True)
class MarginRow:
    """The loop at one amplitude, in words."""

    amplitude: str
    gain_margin: str
    phase_margin: str
    frequency: str
    gain: str


@dataclass(frozen=True)
class PositionLoopView:
    """The section of a fit: its form, the answer, or why there is none; `there` only where the model has a play."""

    fit: str
    there: bool
    given: Mapping[str, str]
    fields: tuple[tuple[str, str, str, str], ...] = FIELDS
    sentences: tuple[str, ...] = ()
    unstable: bool = False
    rows: tuple[MarginRow, ...] = ()
    figures: tuple[tuple[str, str], ...] = ()
    query: str = ""
    problem: str = ""

    @property
    def address(self) -> str:
        """Where its figures are."""
        return f"/api/v1/fits/{self.fit}/position-loop/figures"


def asked(given: Mapping[str, str]) -> PositionLoopRequest:
    """The request of a form; empty fields are left out."""
    stated = {name: given.get(name, "").strip() for name, *_ in FIELDS[:-1]}
    sizes: list[float | str] = [one.strip() for one in given.get("amplitudes", "").split(";") if one.strip()]
    return PositionLoopRequest(
        kp=stated.pop("kp") or 0.0, amplitudes=sizes, **{name: text for name, text in stated.items() if text}
    )


def position_loop_form(stored: Stored, given: Mapping[str, str], problem: str = "") -> PositionLoopView:
    """The section without an answer, and why there is none."""
    fit = stored.found
    model = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    return PositionLoopView(stored.id, model.kind == "bench", given, problem=problem)


def position_loop_view(
    stored: Stored, given: Mapping[str, str], request: PositionLoopRequest, found: PositionLoop
) -> PositionLoopView:
    """The section with its answer."""
    return PositionLoopView(
        stored.id,
        True,
        given,
        sentences=tuple(one.text for one in found.amplitudes),
        unstable=found.state == UNSTABLE,
        rows=tuple(map(_row, found.amplitudes)),
        figures=tuple((name, drawing.title) for name, drawing in drawings(found).items()),
        query=urlencode({"asked": request.model_dump_json(exclude_defaults=True)}),
    )


def _row(one: AmplitudeMargin) -> MarginRow:
    return MarginRow(
        percent(one.amplitude),
        _cell(one.gain_margin, "dB"),
        _cell(one.phase_margin, "°"),
        _cell(one.oscillation_frequency, "Hz"),
        _cell(one.oscillation_gain, "1/m"),
    )


def _cell(value: float | None, unit: str) -> str:
    """Three digits, as the sentences have them; a degree stands close to its number."""
    if value is None:
        return "none"
    space = "" if unit == "°" else " "
    return f"{plain(value, 3)}{space}{unit}".replace("-", "−")
