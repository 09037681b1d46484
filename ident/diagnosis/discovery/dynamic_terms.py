"""Terms with a memory: lags, play, resonance, recovery, the integral of an error and its rate."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import scipy  # signal, which takes most of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.site import Site
from ident.diagnosis.discovery.term import STATE, Shape, Signals, Term, multiplied
from ident.units.grammar import Powers

Array = NDArray[np.float64]
SLIP = "v / sqrt(v**2 + vs**2)"
"""Friction that slips near rest: below vs it grows with the speed."""
_REMEMBERED = {("controller", "x"), ("flow", "P"), ("load", "v"), ("load", "x")}  # places of another signal's memory
_ERROR = {"dr", "v_in"}  # the signals by which a loop knows the rate of its error


def dynamic_terms(site: Site, place: str, at: str, a: str) -> Iterator[Term]:
    """Terms with a memory of a signal `a` that add to `at`."""
    if a == at or (place, a) in _REMEMBERED:
        yield from _late(site, place, at, a)
        yield from _play(site, place, at, a)
    if (place, a) == ("load", "x") and "v" in site.signals[at]:
        yield from _yielding(site, place, at)
    if a == at:
        yield from _after(site, place, at)
    if a == at or (place, a) == ("load", "x"):
        yield from _resonant(site, place, at, a)


def error_terms(site: Site, place: str, at: str) -> Iterator[Term]:
    """The integral and the rate of the error, which a controller may use in addition to a gain."""
    if place != "controller" or not site.units.keys() >= _ERROR:
        return

    def summed(signals: Signals, rate: float) -> Array:
        return np.asarray(np.cumsum(signals[at]) / rate)

    def changing(signals: Signals, rate: float) -> Array:
        return np.asarray(np.gradient(signals[at]) * rate)

    lasting = multiplied(site.unit((at, 1)), {"s": 1.0}, 1)
    moving = site.unit(("Kp", 1), ("v_in", 1))
    yield Term(place, at, STATE, "integral", (at,), lasting, worked_out=summed, state=at, in_time=True)
    yield Term(place, at, "Kp * (dr - v_in)", "rate", (at,), moving, worked_out=changing, in_time=True)


def _late(site: Site, place: str, at: str, a: str) -> Iterator[Term]:
    by, unit = _by(site, place, at, a)
    for share in CRITERIA.terms.lags:
        T = Shape("T", share / site.band * 2 * np.pi, "s")

        def late(signals: Signals, rate: float, T: float = T.value) -> Array:
            return np.asarray(_factor(by, signals) * (_lagging(signals[a], rate, T) - signals[a]))

        yield Term(place, at, _times(by, f"lag({a}, T) - {a}"), "lag", (a,), unit, (T,), (), late)
        if not by and a != at:

            def behind(signals: Signals, rate: float, T: float = T.value) -> Array:
                return _lagging(signals[a], rate, T)

            yield Term(place, at, f"lag({a}, T)", "late", (a,), unit, (T,), (), behind)
        if (place, a) == ("load", "v"):

            def dragged(signals: Signals, rate: float, T: float = T.value) -> Array:
                return _lagging(np.sign(signals["v"]), rate, T)

            yield Term(place, at, "lag(sgn(v), T)", "late friction", (a,), {}, (T,), (), dragged)
            yield from _slipping_late(site, place, at, T)


def _slipping_late(site: Site, place: str, at: str, T: Shape) -> Iterator[Term]:
    """Friction that slips near rest, behind a lag."""
    vs = site.slow(min(CRITERIA.terms.slow))
    if vs.value > 0:

        def slipping(signals: Signals, rate: float) -> Array:
            v = signals["v"]
            return _lagging(v / np.sqrt(v**2 + vs.value**2), rate, T.value)

        yield Term(place, at, f"lag({SLIP}, T)", "late slip", ("v",), {}, (T, vs), (), slipping)


def _after(site: Site, place: str, at: str) -> Iterator[Term]:
    """A gain that depends on the past size of the signal, as the gain of a supply which gives way under a flow."""
    for share in CRITERIA.terms.time_constants:
        T = Shape("T", share * site.seconds, "s")

        def used(signals: Signals, rate: float, T: float = T.value) -> Array:
            return np.asarray(signals[at] * _lagging(np.abs(signals[at]), rate, T))

        yield Term(place, at, f"{at} * lag(abs({at}), T)", "after", (at,), site.unit((at, 2)), (T,), (), used)


def _play(site: Site, place: str, at: str, a: str) -> Iterator[Term]:
    by, unit = _by(site, place, at, a)
    for share in CRITERIA.terms.plays:
        half = share * float(np.std(site.typical[a]))

        def held(signals: Signals, _rate: float, half: float = half) -> Array:
            x, p, out = signals[a], 0.0, np.empty(len(signals[a]))
            for k, now in enumerate(x):
                p = min(max(p, now - half), now + half)
                out[k] = p - now
            return np.asarray(_factor(by, signals) * out)

        shape = Shape("b", half, site.units[a])
        memory = (f"p := clip(p, {a} - b, {a} + b)",)
        yield Term(place, at, _times(by, f"p - {a}"), "play", (a,), unit, (shape,), memory, held)


def _yielding(site: Site, place: str, at: str) -> Iterator[Term]:
    """A force that builds up along the way and yields smoothly, z' = v − |v| z / b (Dahl 1968)."""
    for share in CRITERIA.terms.plays:
        reach = share * float(np.std(site.typical["x"]))

        def built(signals: Signals, _rate: float, reach: float = reach) -> Array:
            steps, z, out = np.diff(signals["x"], prepend=signals["x"][0]), 0.0, np.empty(len(signals["x"]))
            for k, (step, kept) in enumerate(zip(steps, np.exp(-np.abs(steps) / reach), strict=True)):
                z = math.copysign(reach, step) * (1.0 - kept) + z * kept
                out[k] = z
            return out

        b = Shape("b", reach, site.units["x"])
        rate = f"v - abs(v) * {STATE} / b"
        yield Term(place, at, STATE, "yields", ("x",), site.unit(("x", 1)), (b,), worked_out=built, state=rate)


def _resonant(site: Site, place: str, at: str, a: str) -> Iterator[Term]:
    """A mass on a spring that a signal moves: its motion relative to the signal."""
    for share in CRITERIA.terms.resonances:
        w = share * site.band
        a1, a2 = Shape("a1", 2 * CRITERIA.terms.damping / w, "s"), Shape("a2", 1 / w**2, "s^2")

        def beside(signals: Signals, rate: float, w: float = w) -> Array:
            warped = 0.5 * w / np.tan(0.5 * w / rate)  # the bilinear rule, right at w
            over, under = scipy.signal.bilinear([1.0], [1 / w**2, 2 * CRITERIA.terms.damping / w, 1.0], warped)
            return np.asarray(scipy.signal.lfilter(over, under, signals[a]) - signals[a])

        yield Term(place, at, f"lag2({a}, a1, a2) - {a}", "resonance", (a,), site.unit((a, 1)), (a1, a2), (), beside)


def _by(site: Site, place: str, at: str, a: str) -> tuple[str, Powers]:
    """The factor of a memory of a signal, such as the loop's gain where it is fed back, and the unit of the product."""
    by = "Kp" if place == "controller" and a != at and "Kp" in site.typical else ""
    return by, site.unit((a, 1), *[(by, 1)] * bool(by))


def _lagging(x: Array, rate: float, T: float) -> Array:
    """x behind a lag of T."""
    decay = np.exp(-1.0 / rate / T)
    return np.asarray(scipy.signal.lfilter([1 - decay], [1, -decay], x))


def _factor(by: str, signals: Signals) -> Array | float:
    return signals[by] if by else 1.0


def _times(by: str, text: str) -> str:
    return f"{by} * ({text})" if by else text
