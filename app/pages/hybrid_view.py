"""A hybrid simulation with the machine of a fit, as the page asks for it and shows it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode

from app.pages.control_view import ControlView, Earlier, case_called, said_of
from app.pages.job_view import JobPageView
from ident.custom.definition import preset_with
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.figures import DRAWINGS, subjects
from ident.figures.delay_map import DELAY_MAP
from ident.fit.result import FitResult
from ident.hybrid.controller_lookup import NAMED
from ident.hybrid.feedforward_tracking import FeedforwardTracking
from ident.presets import preset
from ident.presets.strano import STRANO
from ident.stages import PLACES
from ident.words.engineering import power_of, quantity, scaled_unit, with_unit
from ident.words.number import count, fixed, trimmed
from ident.words.percent import percent_in_print
from ident.words.titles import title
from schemas.hybrid_result import HybridView

_NAMED = {
    "none": "none: the command is the reference",
    "kalman": "delay compensation from live estimates (Kalman)",
    "feedforward": "feedforward from the inverse of the model",
}
_FIGURES = {drawing.name: drawing.title for drawing in DRAWINGS if drawing.of in (subjects.Simulated, subjects.Coupled)}
_COMPARED = {
    "tracking_rms": ("Tracking, RMS", "measured against numerical"),
    "tracking_peak": ("Tracking, peak", "measured against numerical"),
    "reference_rms": ("Reference, RMS", "measured against reference"),
    "reference_peak": ("Reference, peak", "measured against reference"),
    "numerical_rms": ("Numerical, RMS", "numerical against reference"),
}


Figure = tuple[str, str, str, str]


@dataclass(frozen=True)
class Choice:
    """One controller to choose."""

    value: str
    text: str


@dataclass(frozen=True)
class EffectChoice:
    """An effect that may be switched on, with its usual strength (a fifth of the largest) and the largest, in words."""

    name: str
    meaning: str
    strength_name: str
    strength_meaning: str
    usual: str
    upper: str


@dataclass(frozen=True)
class Simulated:
    """What a hybrid simulation gave: the verdict, scores (name, displacements compared, values), facts, figures.

    Scores are those under the controller and, where the same was simulated `without` one, those beside them.
    `figures` are address, name, title and query of each. Of several actuators `by_part` has the scores of each of the
    `parts`.
    """

    id: str
    title: str
    made: str
    stable: bool
    verdict: str
    stability: tuple[str, ...]
    spread: tuple[str, ...]
    scores: tuple[tuple[str, str, str, str], ...]
    facts: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]
    figures: tuple[Figure, ...]
    without: bool
    table: bool = False
    parts: tuple[str, ...] = ()
    by_part: tuple[tuple[str, str, tuple[str, ...]], ...] = ()


@dataclass(frozen=True)
class HybridSection:
    """The section: what may be chosen, the job that is under way or failed, what is shown, and the others."""

    controllers: tuple[Choice, ...]
    effects: tuple[tuple[str, tuple[EffectChoice, ...]], ...]
    job: JobPageView | None = None
    shown: Simulated | None = None
    others: tuple[Earlier, ...] = ()


def hybrid_view(
    fit: FitResult,
    stored: Sequence[HybridView],
    shown: HybridView | None,
    job: JobPageView | None,
    control: ControlView,
) -> HybridSection:
    """The section for the simulations of a fit, the newest first; the controller that is shown is chosen."""
    others = (one for one in stored if shown is None or one.id != shown.id)
    return HybridSection(
        controllers=tuple(_controllers(fit, control)),
        effects=_effects(fit),
        job=job,
        shown=None if shown is None else _simulated(shown),
        others=tuple(Earlier(one.id, _called(one), one.created_at) for one in others),
    )


def _controllers(fit: FitResult, control: ControlView) -> Iterator[Choice]:
    """Those that were designed, the one that is shown first, then those that go by a name."""
    if (made := control.shown) is not None:
        yield Choice(made.id, f"designed above: {made.structure}, {made.case}")
    for other in control.others:
        yield Choice(other.id, f"designed: {other.text}, {other.made[:16].replace('T', ' ')}")
    for name in NAMED:
        of_table = name == "feedforward" and fit.model != STRANO.name
        yield Choice(name, "feedforward, of a shaking table" if of_table else _NAMED.get(name, name))


def _called(one: HybridView) -> str:
    state = "stable" if one.stable else "unstable"
    return f"{_title(one)}: {state}"


def _title(one: HybridView) -> str:
    said = f"{case_called(one.case)}, {_controller(one.controller)}, {one.ground}"
    return said[0].upper() + said[1:]


def _controller(name: str) -> str:
    return "no controller" if name == "none" else f"controller {name}"


def _effects(fit: FitResult) -> tuple[tuple[str, tuple[EffectChoice, ...]], ...]:
    """The effects of the catalogue that the model of a fit takes and has not, by their place."""
    model = preset(fit.model)
    if model.kind != "chain":
        return ()
    able = [effect for effect in CATALOGUE if effect.name not in fit.effects and model.takes(effect)]
    places = ((place, tuple(_choice(fit, effect) for effect in able if effect.place == place)) for place in PLACES)
    return tuple((place, found) for place, found in places if found)


def _choice(fit: FitResult, effect: Effect) -> EffectChoice:
    strength = preset_with(fit.model, (effect.name,)).parameter(effect.name)
    return EffectChoice(
        effect.name,
        effect.meaning,
        strength.name,
        effect.strength.meaning,
        _short(strength.upper / 5, strength.unit),
        _short(strength.upper, strength.unit),
    )


def _short(value: float, unit: str) -> str:
    """A value with its unit as one may write it into a field."""
    power = power_of(value)
    if scaled_unit(unit, power).startswith("10"):
        return f"{value:.4g} {'' if unit == '1' else unit}".strip()
    return with_unit(trimmed(value / 10.0**power), unit, power)


def _simulated(one: HybridView) -> Simulated:
    found, at = one.model_dump(), f"/api/v1/hybrid-simulations/{one.id}/figures"
    return Simulated(
        id=one.id,
        title=_title(one),
        made=one.created_at,
        stable=one.stable,
        stability=said_of(one.stability),
        spread=() if one.spread is None else tuple(one.spread.sentences()),
        verdict=_verdict(found),
        scores=tuple(_scores(found)),
        facts=tuple(_facts(found)),
        notes=tuple(one.notes),
        figures=tuple(_figures(one, at)),
        without=one.without is not None and not one.parts,
        table=one.acceleration is not None,
        parts=tuple(part.name for part in one.parts),
        by_part=tuple(_by_part(one)),
    )


def _figures(one: HybridView, at: str) -> Iterator[Figure]:
    """Address, name, title and query of each figure, of several actuators those of each part."""
    for name in one.figures:
        told = _FIGURES.get(name, name)
        if not one.parts or name == DELAY_MAP.name:
            yield f"{at}/{name}", name, told, ""
            continue
        for number, part in enumerate(one.parts, 1):
            yield f"{at}/{name}", f"{name}-{number}", f"{told}, {part.name}", urlencode({"part": part.name})


def _by_part(one: HybridView) -> Iterator[tuple[str, str, tuple[str, ...]]]:
    """Of several actuators a score, what it compares, and its value for each part."""
    found = [part.model_dump() for part in one.parts]
    rows = [tuple(_scores({**part, "without": None})) for part in found]
    for of_all in zip(*rows, strict=True):
        yield of_all[0][0], of_all[0][1], tuple(row[2] for row in of_all)


def _verdict(found: Mapping[str, Any]) -> str:
    if found["stable"]:
        reference = found["scores"]["reference_rms"]
        return f"Stable; the measured displacement is {percent_in_print(reference)} (RMS) from the reference"
    if found.get("ended") is not None:
        return f"Unstable: diverged after {quantity(found['ended'], 's')}"
    return "Unstable: a pole of the sampled loop lies outside the unit circle"


def _scores(found: Mapping[str, Any]) -> Iterator[tuple[str, str, str, str]]:
    of, alone = found["scores"], (found["without"] or {}).get("scores", {})
    yield "Delay", "measured behind numerical", _time(of["delay"]), _time(alone.get("delay"))
    for key, (name, compared) in _COMPARED.items():
        yield name, compared, percent_in_print(of[key]), percent_in_print(alone.get(key))
    if (shaken := found.get("acceleration")) is not None:
        other = (found["without"] or {}).get("acceleration")
        within = f"against the record, {shaken['lowest']:g} to {shaken['highest']:g} Hz"
        yield "Acceleration spectrum", within, _level(shaken), _level(other)
        yield "Acceleration, RMS", within, percent_in_print(shaken["rms"]), percent_in_print((other or {}).get("rms"))
    yield "Command, RMS", "", _length(found["command_rms"]), _length((found["without"] or {}).get("command_rms"))


def _level(shaken: Mapping[str, Any] | None) -> str:
    """The largest difference of the spectra, and where."""
    return "–" if shaken is None else f"{fixed(shaken['worst'], 2)} dB at {quantity(shaken['worst_at'], 'Hz')}"


def _length(meters: float | None) -> str:
    return "–" if meters is None else quantity(meters, "m")


def _time(seconds: float | None) -> str:
    """In ms: what a rig's delay is spoken of in."""
    if seconds is None:
        return "–"
    return f"{fixed(round(1e3 * seconds, 2) + 0.0, 2)} ms"


def _facts(found: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    critical = found["critical_delay"]
    if found.get("acceleration") is None:  # a table has no loop through a structure
        yield "Critical delay of a perfect machine", "none" if critical is None else _time(critical)
    if found.get("largest_pole") is not None:
        yield "Largest pole of the sampled loop", f"{found['largest_pole']:.5f}"
    seconds = (found["samples"] - 1) / found["sample_rate"]
    yield "Simulated", f"{quantity(seconds, 's')} at {quantity(found['sample_rate'], 'Hz')}"
    yield "Computing delay", count(found["delay"], "sample")
    if found["effects"]:
        yield "Effects switched on", ", ".join(title(name.partition(".")[0]) for name in found["effects"])
    if one := found.get("feedforward"):
        yield "Feedforward", "; ".join(FeedforwardTracking.from_json(one).said)
    yield "Computing time", quantity(found["seconds"], "s")
