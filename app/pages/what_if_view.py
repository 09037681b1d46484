"""What a change would do to the machine of a fit, as the page asks for it and shows it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

from app.fits.rows import ParameterRow, parameter_rows
from app.fits.service import Stored
from ident.figures import drawings
from ident.fit.result import Estimate, FitResult
from ident.hybrid.changed_machine import SIZES
from ident.hybrid.loop_figures import QUANTITIES
from ident.hybrid.oil_column import JointChange, PeakSearch
from ident.hybrid.root_locus import Pole
from ident.hybrid.what_if import HIGHEST, USUAL_GAINS, Response, WhatIf
from ident.presets import preset
from ident.stability.judgement import UNSTABLE
from ident.words.engineering import multiple, quantity
from ident.words.number import fixed, places, plain, trimmed
from ident.words.plus_minus import plus_minus
from schemas.hybrid import WhatIfRequest

_EXAMPLES = {"area": "239 mm^2", "stroke": "4 in", "volume": "0.1 l"}
_KNOWN = {"area": ("piston_area", "m^2"), "stroke": ("stroke", "m"), "volume": ("volume", "m^3")}


@dataclass(frozen=True)
class SizeField:
    """A size of the cylinder: what the fit knows of it, "" for nothing, and an example of what to write."""

    name: str
    known: str
    example: str


@dataclass(frozen=True)
class ValueField:
    """A parameter that may be set: its value now in words, and as one would write it."""

    name: str
    symbol: str
    meaning: str
    said: str
    plain: str


@dataclass(frozen=True)
class WhatIfForm:
    """What may be asked of a machine, and what was: `given` by the names of the fields."""

    sizes: tuple[SizeField, ...]
    parameters: tuple[ValueField, ...]
    has_gain: bool
    usual: tuple[str, str]
    quantities: tuple[tuple[str, str], ...]
    given: Mapping[str, str]


@dataclass(frozen=True)
class CarriedRow:
    """A parameter before and after, in one unit."""

    symbol: str
    meaning: str
    before: str
    after: str
    unit: str
    factor: str
    why: str
    changed: bool


@dataclass(frozen=True)
class LoopRow:
    """The loop at one gain: poles and peaks in words."""

    gain: str
    stable: bool
    poles: str
    peaks: str


@dataclass(frozen=True)
class FactorRow:
    """A parameter's part in the smallest change that puts a peak there; `span`: of all changes that do as well."""

    symbol: str
    alone: str
    together: str
    span: str


@dataclass(frozen=True)
class WhatIfFound:
    """The answer; `chosen`, `stability` and `spread` are sentences, `figures` name and title of each."""

    chosen: tuple[str, ...]
    unstable: bool
    stability: tuple[str, ...]
    spread: tuple[str, ...]
    facts: tuple[tuple[str, str], ...]
    parameters: tuple[CarriedRow, ...]
    loops: tuple[LoopRow, ...]
    notes: tuple[str, ...]
    peak: str
    factors: tuple[FactorRow, ...]
    size: str
    starts: str
    after: tuple[LoopRow, ...]
    figures: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class WhatIfView:
    """The section for a fit: its form, the answer, or why there is none; `request` is what its figures are asked."""

    fit: str
    form: WhatIfForm
    found: WhatIfFound | None = None
    request: str = ""
    problem: str = ""

    @property
    def asked(self) -> bool:
        """Whether something was asked."""
        return bool(self.form.given)

    @property
    def parameters_given(self) -> bool:
        """Whether a parameter or a size of the fitted machine was stated."""
        return any(name.startswith(("set.", "fitted.")) for name in self.form.given)

    @property
    def before_given(self) -> bool:
        """Whether something is said of the loop when it was stable."""
        return any(name.startswith("before_") for name in self.form.given)

    @property
    def lacks(self) -> bool:
        """Whether the fit does not know a size of its machine."""
        return not all(size.known for size in self.form.sizes)

    @property
    def query(self) -> str:
        """What was asked, as the query of its figures."""
        return urlencode({"asked": self.request})

    @property
    def figures(self) -> str:
        """Where its figures are."""
        return f"/api/v1/fits/{self.fit}/what-if/figures"

    @property
    def numbers(self) -> str:
        """Where all its numbers are."""
        return f"/fits/{self.fit}/use/what-if.json?{urlencode(self.form.given)}"

    @property
    def highest(self) -> str:
        """Hz, up to where peaks are looked for at least."""
        return trimmed(HIGHEST)


def what_if_form(fit: FitResult, given: Mapping[str, str]) -> WhatIfForm:
    """The form for a fit, filled with what was given."""
    model = preset(fit.model)
    known = model.data.gains.get("Kp")
    usual = USUAL_GAINS if known is None else (known, known)
    return WhatIfForm(
        sizes=tuple(SizeField(name, _size(fit, name), _EXAMPLES[name]) for name in SIZES),
        parameters=tuple(_value(row, fit.parameters[row.name]) for row in parameter_rows(fit)),
        has_gain=model.kind == "chain" and "Kp" in model.chain.symbols,
        usual=(trimmed(usual[0]), trimmed(usual[1])),
        quantities=tuple((name, f"{name.replace('_', ' ')} ({unit})") for name, unit in QUANTITIES.items()),
        given=given,
    )


def _value(row: ParameterRow, entry: Estimate) -> ValueField:
    example = f"{entry.value:.5g} {'' if entry.unit == '1' else entry.unit}".strip()
    return ValueField(row.name, row.symbol, row.meaning, quantity(entry.value, entry.unit), example)


def _size(fit: FitResult, name: str) -> str:
    attribute, unit = _KNOWN[name]
    value = getattr(fit.actuator, attribute, None)
    return "" if value is None else quantity(value, unit)


def what_if_view(stored: Stored, form: WhatIfForm, request: WhatIfRequest, found: WhatIf) -> WhatIfView:
    """The section with its answer."""
    text = request.model_dump_json(exclude_defaults=True)
    return WhatIfView(stored.id, form, what_if_found(stored.found, found), text)


def what_if_found(fit: FitResult, found: WhatIf) -> WhatIfFound:
    """The answer in words and rows."""
    named = {row.name: row for row in parameter_rows(fit)}
    peak = found.peak
    return WhatIfFound(
        chosen=() if found.chosen is None else tuple(found.chosen.sentences()),
        unstable=found.state == UNSTABLE,
        stability=tuple(said for one in found.stability for said in one.text),
        spread=tuple(said for one in found.spread for said in one.sentences()),
        facts=tuple(_facts(found)),
        parameters=tuple(_carried(found, named)),
        loops=tuple(map(_loop, found.responses)),
        notes=tuple(note for note in found.notes if peak is None or note not in peak.text),
        peak="" if peak is None else " ".join(peak.text[:1]),
        factors=() if peak is None else tuple(_factors(peak, named)),
        size="" if peak is None or peak.smallest is None else plain(peak.smallest.size, 3),
        starts="" if peak is None or peak.starts is None else str(peak.starts),
        after=tuple(map(_loop, found.with_peak)),
        figures=tuple((one.name, one.title) for one in drawings(found).values()),
    )


def _facts(found: WhatIf) -> Iterator[tuple[str, str]]:
    size, moved = found.actuator, found.specimen
    yield "Piston area", quantity(size.piston_area, "m^2")
    yield "Stroke", quantity(size.stroke, "m")
    if size.volume is not None:
        yield "Oil volume", quantity(size.volume, "m^3")
    parts = ((moved.mass, "kg"), (moved.stiffness, "N/m"), (moved.damping, "N*s/m"))
    yield "Specimen", ", ".join(quantity(value, unit) for value, unit in parts if value) or "none"
    if found.locus is not None:
        yield "Stability is lost at", _critical(found)
    if (oil := found.bulk_modulus) is not None:
        yield "Bulk modulus", f"{plus_minus(oil.value, oil.std_error, 'Pa')}; V = {quantity(oil.volume, 'm^3')}"


def _critical(found: WhatIf) -> str:
    if found.critical_gain is not None:
        return f"Kp = {trimmed(found.critical_gain)}"
    return "no gain that was looked at" if found.responses[0].stable else "every gain that was looked at"


def _carried(found: WhatIf, named: Mapping[str, ParameterRow]) -> Iterator[CarriedRow]:
    for name, entry in found.parameters.items():
        size, unit = multiple(entry.before, entry.unit)
        before, after = entry.before / size, entry.after / size
        changed = entry.before != entry.after
        yield CarriedRow(
            symbol=named[name].symbol,
            meaning=named[name].meaning,
            before=plain(before, 5),
            after=plain(after, 5),
            unit=unit,
            factor=plain(after / before, 4) if changed and before else "–",
            why=entry.why,
            changed=changed,
        )


def _loop(of: Response) -> LoopRow:
    peaks = [f"{trimmed(peak.frequency)} Hz (|G| = {plain(peak.magnitude, 3)})" for peak in of.peaks]
    return LoopRow(
        gain="no loop" if of.gain is None else trimmed(of.gain),
        stable=of.stable,
        poles=", ".join(_pole(pole) for pole in of.poles if pole.imaginary >= 0),
        peaks=", ".join(peaks) or "none",
    )


def _pole(pole: Pole) -> str:
    """One of the two of a pair, in Hz."""
    decimals = min(3, max(places(part, 4) for part in (pole.real, pole.imaginary) if part) if pole.real else 3)
    real = fixed(pole.real, decimals)
    return f"{real} ± {fixed(pole.imaginary, decimals)}i" if pole.imaginary else real


def _factors(peak: PeakSearch, named: Mapping[str, ParameterRow]) -> Iterator[FactorRow]:
    for name, alone in peak.singles.items():
        span = peak.others.get(name)
        yield FactorRow(
            symbol=named[name].symbol,
            alone="–" if alone is None else f"× {plain(alone, 3)}",
            together=_factor(peak.smallest, name),
            span="–" if span is None else f"× {plain(span.lower, 3)} to {plain(span.upper, 3)}",
        )


def _factor(change: JointChange | None, name: str) -> str:
    return "–" if change is None or name not in change.factors else f"× {plain(change.factors[name], 3)}"
