"""What a change would do to an identified machine: response, peaks, poles, and the gain at which it goes unstable."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.bulk_modulus import BulkModulus, bulk_modulus
from ident.fit.result import Estimate, FitResult
from ident.hybrid.changed_machine import Carried, Change, ChangedMachine, changed_machine
from ident.hybrid.chosen_gain import ChosenGain, GainTarget, choose_gain
from ident.hybrid.drawn_loops import DrawnLoops, drawn_loops
from ident.hybrid.oil_column import PeakSearch, find_peak
from ident.hybrid.parameter_samples import Spread
from ident.hybrid.peak_problem import PeakTarget
from ident.hybrid.peaks import Peak, peaks
from ident.hybrid.qian_figure_19 import note_on_figure_19
from ident.hybrid.reached_limits import reached
from ident.hybrid.root_locus import Pole, RootLocus, poles, root_locus
from ident.hybrid.servo_loop import servo_loop, values_before
from ident.matrix import Actuator
from ident.plain import written
from ident.progress import Report, silent
from ident.rig.limits import RigLimits
from ident.run import Specimen
from ident.stability.gain_margin import WANTED
from ident.stability.judgement import STABLE, UNSTABLE, Judgement, judge
from ident.words.engineering import multiple
from ident.words.number import plain, trimmed
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]
USUAL_GAINS = (1.0, 10.0)
HIGHEST = 100.0
"""Hz: peaks are looked for up to here at least."""
_POINTS, _BEYOND = 1500, 1e3  # of a response; how far beyond the gains stability is sought


@dataclass(frozen=True)
class Response:
    """The response at one gain, None where there is no loop: |G| and its phase (degrees) over frequency (Hz)."""

    gain: float | None
    stable: bool
    poles: tuple[Pole, ...]
    peaks: tuple[Peak, ...]
    frequency: tuple[float, ...] = field(repr=False)
    magnitude: tuple[float, ...] = field(repr=False)
    phase: tuple[float, ...] = field(repr=False)


@dataclass(frozen=True)
class Before:
    """The loop when it was stable: the fit of its machine, and its gain Kp. None: those of the loop itself.

    Raises Unusable for a gain that is not above 0.
    """

    fit: FitResult | None = None
    gain: float | None = None

    def __post_init__(self) -> None:
        if self.gain is not None and not 0 < self.gain < np.inf:
            raise Unusable(
                "bad-gain", f"{self.gain:g} is not a gain above 0", "before gain", "give the one it was stable with"
            )


@dataclass(frozen=True)
class WhatIf(TabularResult):
    """An identified machine after a change. `critical_gain` is the smallest Kp above which it is no longer stable.

    It is None where the machine is stable, or unstable, at all gains that were looked at. `peak` is what was found for
    a peak that was asked for, `with_peak` the responses after the smallest change that puts it there. `stability`
    judges the loop at each gain; `state` is "unstable" where it is at any. `chosen` is the gain for a quantity that was
    asked for. `spread` has the loop at each gain over machines drawn from a spread that was stated.
    """

    model: str
    output: str
    actuator: Actuator
    specimen: Specimen
    parameters: dict[str, Carried]
    responses: tuple[Response, ...]
    locus: RootLocus | None
    critical_gain: float | None
    bulk_modulus: BulkModulus | None
    notes: tuple[str, ...]
    peak: PeakSearch | None = None
    with_peak: tuple[Response, ...] = ()
    state: str = STABLE
    stability: tuple[Judgement, ...] = ()
    chosen: ChosenGain | None = None
    spread: tuple[DrawnLoops, ...] = ()

    def listings(self) -> Iterator[Listing | str]:
        """Whether the loop is unstable and why, what was changed, the poles and peaks, what is to be said of them."""
        if self.chosen is not None:
            yield from self.chosen.sentences()
        for one in self.stability:
            yield from one.text
        for drawn in self.spread:
            yield from drawn.sentences()
        header = ("parameter", "fitted", "changed", "unit", "")
        yield Listing("", header, self._rows(), header[1:3])
        for each in self.responses:
            yield _in_words(each)
        for each in self.with_peak:
            yield _in_words(each, ", with the smallest change that makes the peak")
        if self.critical_gain is not None:
            yield f"stability is lost at Kp = {self.critical_gain:.4g}"
        for note in self.notes:
            yield f"note: {note}"

    def _rows(self) -> Iterator[tuple[str, ...]]:
        """A row a parameter, in a readable multiple of its unit."""
        for name, entry in self.parameters.items():
            size, unit = multiple(entry.before, entry.unit)
            yield name, plain(entry.before / size, 5), plain(entry.after / size, 5), unit, entry.why

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        data: dict[str, Any] = written(self)
        return data


def _in_words(of: Response, after: str = "") -> str:
    """The poles and peaks at one gain."""
    where = "no loop" if of.gain is None else f"Kp = {of.gain:g}"
    poles = ", ".join(f"{p.real:.4g}{p.imaginary:+.4g}i" if p.imaginary else f"{p.real:.4g}" for p in of.poles)
    tops = ", ".join(f"{peak.frequency:.4g} Hz (|G| {peak.magnitude:.3g})" for peak in of.peaks) or "none"
    return f"{where}{after}: poles {poles} Hz; peaks: {tops}"


def what_if(
    fit: FitResult,
    change: Change,
    gains: tuple[float, float] | None = None,
    peak: PeakTarget | None = None,
    seed: int = 0,
    report: Report = silent,
    rig: RigLimits | None = None,
    before: Before | None = None,
    choose: GainTarget | None = None,
    spread: Spread | None = None,
) -> WhatIf:
    """The machine of a fit after a change, at the two ends of a range of gains Kp; what would put a `peak` there.

    `before` is the loop when it was stable, by which the cause is found where it no longer is. Without it that is the
    fitted machine, where something of it was changed. Where limits of the `rig`, or of the fit's matrix, are stated,
    the first notes say which command reaches them.

    Where a gain is to be chosen for a quantity, responses without `gains` are those at it. Where a `spread` of the
    parameters is stated, the loop at each gain is judged over machines drawn from it.

    Responses are the linearisation of the fitted chain (:meth:`ident.chain.chain.Chain.linearise`). Raises Unusable
    as :func:`ident.hybrid.changed_machine.changed_machine` does, and for gains that are no range above 0.
    """
    machine = changed_machine(fit, change)
    chosen = None if choose is None else choose_gain(fit, machine, choose, seed, spread)
    ends = _gains(machine, (chosen.gain, chosen.gain) if chosen and gains is None else gains)
    band = _band(machine, ends)
    responses = tuple(response(machine, gain, band) for gain in ends)
    oil, found = _oil(fit, machine), None
    limits = rig or (fit.actuator.rig if fit.actuator else None)
    with_peak: tuple[Response, ...] = ()
    if peak is not None:
        found = find_peak(machine, replace(peak, gains=tuple(gain or 1.0 for gain in ends)), seed, report=report)
        with_peak = _with_peak(machine, found, ends, band)
    judged = tuple(_judged(machine, gain, fit, change, before) for gain in ends)
    critical = _critical_gain(machine, ends)
    return WhatIf(
        model=fit.model,
        output=machine.output,
        actuator=machine.actuator,
        specimen=machine.specimen,
        parameters=dict(machine.parameters),
        responses=responses,
        locus=_locus(machine, ends, judged, critical),
        critical_gain=critical,
        bulk_modulus=oil,
        peak=found,
        with_peak=with_peak,
        chosen=chosen,
        spread=tuple(drawn_loops(fit, machine, gain, spread, seed) for gain in ends) if spread else (),
        state=UNSTABLE if any(not one.stable for one in judged) else STABLE,
        stability=judged,
        notes=(*reached(machine, ends, limits), *_notes(machine, responses, oil), *(found.text if found else ())),
    )


def _judged(
    machine: ChangedMachine, gain: float | None, fit: FitResult, change: Change, before: Before | None
) -> Judgement:
    """Whether the loop at a gain is stable, and what made it unstable where that can be known."""
    known = 1.0 if gain is None else gain
    loop = servo_loop(machine, known)
    reference = before or (Before() if change.values or change.sizes else None)
    values = None
    if reference is not None:
        unchanged = changed_machine(reference.fit or fit, Change(specimen=change.specimen, known=change.known))
        values = values_before({**unchanged.values, "Kp": reference.gain or known}, loop)
    return judge(loop, values, "" if gain is None else f"at Kp = {trimmed(gain)}")


def _gains(machine: ChangedMachine, gains: tuple[float, float] | None) -> tuple[float | None, ...]:
    """The gains whose response is shown."""
    if not machine.has_gain:
        if gains is not None:
            raise Unusable("no-gain", "the model has no loop with a gain", "gain", "leave the gain out")
        return (None,)
    known = machine.preset.data.gains.get("Kp")
    lower, upper = gains or (USUAL_GAINS if known is None else (known, known))
    if not (0 < lower <= upper < np.inf):
        raise Unusable("bad-gain", f"{lower:g} to {upper:g} is not a range of gains above 0", "gain", "write it as 2:3")
    return (lower,) if lower == upper else (lower, upper)


def _with_peak(
    machine: ChangedMachine, found: PeakSearch, gains: tuple[float | None, ...], frequency: Array
) -> tuple[Response, ...]:
    """The responses after the smallest change."""
    if found.smallest is None:
        return ()
    factors = found.smallest.factors
    parameters = {n: replace(p, after=p.after * factors.get(n, 1.0)) for n, p in machine.parameters.items()}
    return tuple(response(replace(machine, parameters=parameters), gain, frequency) for gain in gains)


def response(machine: ChangedMachine, gain: float | None, frequency: Array) -> Response:
    """The response at one gain over `frequency` (f,) in Hz."""
    model = machine.linear(np.array([1.0 if gain is None else gain]))
    G = model.frequency_response(frequency)[0]
    roots = np.linalg.eigvals(model.A[0]).astype(complex) / (2 * np.pi)
    magnitude = np.abs(G)
    return Response(
        gain,
        bool(roots.real.max(initial=-np.inf) < 0),
        poles(roots),
        peaks(frequency, magnitude),
        tuple(frequency.tolist()),
        tuple(magnitude.tolist()),
        tuple(np.degrees(np.unwrap(np.angle(G))).tolist()),
    )


def _band(machine: ChangedMachine, gains: tuple[float | None, ...]) -> Array:
    """Frequencies in Hz that show every pole, (f,)."""
    roots = np.abs(np.linalg.eigvals(_at(machine, gains).A)) / (2 * np.pi)
    slowest = float(np.min(roots, where=roots > 1e-6 * roots.max(), initial=np.inf))
    lowest = min(0.1, slowest / 10)
    return np.geomspace(lowest, max(HIGHEST, 1.5 * float(roots.max())), _POINTS)


def _at(machine: ChangedMachine, gains: tuple[float | None, ...]) -> Any:
    return machine.linear(np.array([1.0 if gain is None else gain for gain in gains]))


def _growth(machine: ChangedMachine, gain: Array) -> Array:
    """The largest real part of a pole in 1/s, for gains (g,) → (g,)."""
    return np.asarray(np.linalg.eigvals(machine.linear(gain).A).real.max(axis=-1))


def _locus(
    machine: ChangedMachine, ends: tuple[float | None, ...], judged: tuple[Judgement, ...], critical: float | None
) -> RootLocus | None:
    """The poles over the gains, or over a decade around the one there is, marked; None without a loop."""
    if ends[0] is None or ends[-1] is None:
        return None
    lower, upper = (ends[0], ends[-1]) if len(ends) > 1 else (ends[0] / 3, ends[0] * 3)
    marked = {} if critical is None else {"stability is lost": critical}
    offered = {one.after for each in judged if not each.stable for one in each.remedies if one.name == "Kp"}
    if offered:
        marked[f"{trimmed(WANTED)} dB of gain margin"] = min(offered)
    return root_locus(machine, lower, upper, marked)


def _critical_gain(machine: ChangedMachine, ends: tuple[float | None, ...]) -> float | None:
    """Where stability is lost, up to 1000 times the upper gain, down to a thousandth of the lower where lost there."""
    if ends[0] is None or ends[-1] is None:
        return None
    lost_there = _growth(machine, np.array([ends[0]]))[0] >= 0
    gain = np.geomspace(ends[0] / (_BEYOND if lost_there else 1.0), _BEYOND * ends[-1], 601)
    growth = _growth(machine, gain)
    lost = np.flatnonzero((growth[:-1] < 0) & (growth[1:] >= 0))
    if not len(lost):
        return None
    at = lost[0]
    found = scipy.optimize.brentq(
        lambda log: float(_growth(machine, np.exp([log]))[0]), *np.log(gain[[at, at + 1]]), xtol=1e-10
    )
    return float(np.exp(found))


def _oil(fit: FitResult, machine: ChangedMachine) -> BulkModulus | None:
    """The bulk modulus after the change: a compressibility keeps its relative standard error, unless it is set."""
    after = {
        name: replace(old, value=new.after, std_error=_error(old, new))
        for name, new in machine.parameters.items()
        if (old := fit.parameters.get(name))
    }
    return bulk_modulus(after, machine.actuator)


def _error(old: Estimate, new: Carried) -> float | None:
    known = old.std_error is not None and new.why != "as set"
    return old.std_error * new.after / new.before if known and old.std_error is not None else None


def _notes(machine: ChangedMachine, responses: tuple[Response, ...], oil: BulkModulus | None) -> Iterator[str]:
    """What a reader has to know of the responses."""
    if machine.left_out:
        yield (
            f"Not in the response: {', '.join(machine.left_out)}. The linearised model ignores effects that depend on "
            "amplitude."
        )
    unstable = [each.gain for each in responses if not each.stable]
    if unstable:
        yield f"Unstable{_at_gains(unstable)}: the frequency response is not physical there."
    flat = [each.gain for each in responses if not any(peak.frequency < HIGHEST for peak in each.peaks)]
    if flat:
        yield f"No peak below {trimmed(HIGHEST)} Hz{_at_gains(flat)}."
    told = note_on_figure_19(machine, tuple(peak for each in responses for peak in each.peaks))
    if told:
        yield told
    if oil:
        yield oil.note


def _at_gains(gains: Sequence[float | None]) -> str:
    return "" if gains[0] is None else f" at Kp = {' and '.join(trimmed(gain) for gain in gains if gain is not None)}"
