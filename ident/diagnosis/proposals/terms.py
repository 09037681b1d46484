"""What may be missing at a place: a term of the signals there, written as an equation and worked out on samples.

Terms are drawn from forms: powers, roots, absolute values, signs, one-sided parts and thresholds of one signal;
products of two; hills of the position; lags and play; what was recorded beside the machine. Each becomes an effect of
its own, ``at = at + s term``, whose strength s has the unit of the signal that it acts on over that of the term.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np
import scipy  # signal, which takes most of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.equations.equation import Equation
from ident.equations.interpolation import interpolated
from ident.units.grammar import Powers, powers_of

Array = NDArray[np.float64]
Signals = Mapping[str, Array]
_QUANTILES = (0.3, 0.5, 0.7, 0.85, 0.95)  # of the size of a signal: thresholds
_HILLS, _HILL = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95), (0.1, 0.25)  # quantiles of the position, widths in its range
_LAGS = (0.02, 0.06, 0.2, 0.6)  # of a period at the end of the band, times 2π
_PLAYS = (0.1, 0.3, 0.6)  # of the deviation of a signal
_RESONANCES, _DAMPED = (0.15, 0.2, 0.27, 0.36, 0.48, 0.65, 0.9), 0.1  # of the end of the band; of critical damping
_FADING = (0.15, 0.5)  # of the shortest run
CURVE = "h"
"""What a free curve is called in a term."""
LIMIT = "Ff"
"""The signal that says what dry friction takes at most, of machines whose load sticks."""
_REMEMBERED = {("controller", "x"), ("flow", "P"), ("load", "v"), ("load", "x")}  # places of another signal's memory


@dataclass(frozen=True)
class Shape:
    """A number within a term: its symbol, its value where the search saw it, its unit, and whether a refit moves it.

    Within its bounds where they are given, else by the factor `spread` to either side.
    """

    symbol: str
    value: float
    unit: str
    free: bool = True
    spread: float = 8.0
    lower: float | None = None
    upper: float | None = None

    @property
    def bounds(self) -> tuple[float, float]:
        """Between what a refit moves it."""
        low, high = sorted((self.value / self.spread, self.value * self.spread))
        return low if self.lower is None else self.lower, high if self.upper is None else self.upper


@dataclass(frozen=True)
class Curve:
    """A curve of a signal through knots, h in a term: its values there where the search saw them.

    That at the knot `held` is 1 and stays, for the strength is its size; a refit moves the others.
    """

    of: str
    knots: tuple[float, ...]
    values: tuple[float, ...]
    held: int = 0

    def samples(self, signals: Signals) -> Array:
        """Between the knots straight, and beyond them."""
        table = np.ravel(np.column_stack([self.knots, self.values])).tolist()
        return np.asarray(interpolated("lines", signals[self.of], *table))


@dataclass(frozen=True)
class Term:
    """A term at a place: `at` is the signal that it adds to, `text` its equation, `unit` that of the term.

    `kind` names its form and `of` the signals that it is of; `memory` are equations of its own that go before.
    `worked_out` gives its samples where the equation alone does not. Of dry friction of the moving mass `limit` is what
    it takes at most: such a term sticks. Of a `curve` the equation has h.
    """

    place: str
    at: str
    text: str
    kind: str
    of: tuple[str, ...]
    unit: Powers
    shapes: tuple[Shape, ...] = ()
    memory: tuple[str, ...] = ()
    worked_out: Callable[[Signals, float], Array] | None = field(default=None, compare=False, repr=False)
    limit: str = ""
    curve: Curve | None = None

    def samples(self, signals: Signals, rate: float) -> Array:
        """The term on the signals of a run, (n,)."""
        if self.worked_out is not None:
            return self.worked_out(signals, rate)
        known = {**signals, **{shape.symbol: shape.value for shape in self.shapes}}
        if self.curve is not None:
            known[CURVE] = self.curve.samples(signals)
        value = Equation(f"d = {self.text}").value(known)
        return np.broadcast_to(np.asarray(value, dtype=np.float64), next(iter(signals.values())).shape)

    @property
    def free_shapes(self) -> int:
        """How many of its shapes a refit moves."""
        return sum(shape.free for shape in self.shapes)

    @property
    def fitted(self) -> int:
        """How many numbers within it a refit moves, those of a curve with them."""
        return self.free_shapes + (len(self.curve.knots) - 1 if self.curve else 0)

    @property
    def form(self) -> tuple[str, str, tuple[str, ...]]:
        """What terms have in common that differ by where their shapes begin alone."""
        return self.at, self.kind, self.of


@dataclass(frozen=True)
class Library:
    """All terms for the places of a chain: `places` maps a place to the signal that is added to.

    `signals` are those that terms there may be of, `typical` all their samples, `units` as the chain has them; `band`
    is the end of the command's, rad/s, `seconds` the length of the shortest run, `varied` the conditions that differ,
    `recorded` the channels beside the machine.
    """

    places: Mapping[str, str]
    signals: Mapping[str, Sequence[str]]
    typical: Signals
    units: Mapping[str, str]
    band: float
    seconds: float
    varied: Sequence[str] = ()
    recorded: Sequence[str] = ()

    def terms(self) -> Iterator[Term]:
        """Every term, the simplest forms first."""
        for place, at in self.places.items():
            signals = self.signals[place]
            for a in signals:
                yield from self._of_one(place, at, a)
            for a in signals:
                for b in signals:
                    if a != b:
                        yield from self._of_two(place, at, a, b)
            yield from self._of_position(place, at)
            yield from self._with_conditions(place, at)
            yield from self._periodic(place, at)

    def _of_one(self, place: str, at: str, a: str) -> Iterator[Term]:
        for text, kind, power in (
            ("{a} * abs({a})", "square", 2), ("abs({a})", "size", 1), ("sgn({a})", "sign", 0), ("{a}**3", "cube", 3),
            ("{a}**2", "even square", 2),
        ):  # fmt: skip
            plain = Term(place, at, text.format(a=a), kind, (a,), self._unit((a, power)))
            yield self._dragging(plain, a, "1" if kind == "sign" else "")
        scale = Shape("a0", float(np.std(self.typical[a])), self.units[a], free=False)
        yield Term(place, at, f"sgn({a}) * sqrt(abs({a}) / a0)", "root", (a,), {}, (scale,))
        for share in _QUANTILES:
            width = Shape("h", float(np.quantile(np.abs(self.typical[a]), share)), self.units[a])
            if width.value > 0:
                for text, kind in (
                    ("{a} - clip({a}, -h, h)", "beyond"), ("max({a} - h, 0)", "above"), ("min({a} + h, 0)", "below"),
                ):  # fmt: skip
                    yield Term(place, at, text.format(a=a), kind, (a,), self._unit((a, 1)), (width,))
        if a == at or (place, a) in _REMEMBERED:
            yield from self._late(place, at, a)
            yield from self._play(place, at, a)
        if a == at or (place, a) == ("load", "x"):
            yield from self._resonant(place, at, a)

    def _late(self, place: str, at: str, a: str) -> Iterator[Term]:
        by, unit = self._by(place, at, a)
        for share in _LAGS:
            T = Shape("T", share / self.band * 2 * np.pi, "s")

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

    def _play(self, place: str, at: str, a: str) -> Iterator[Term]:
        by, unit = self._by(place, at, a)
        for share in _PLAYS:
            half = share * float(np.std(self.typical[a]))

            def held(signals: Signals, _rate: float, half: float = half) -> Array:
                x, p, out = signals[a], 0.0, np.empty(len(signals[a]))
                for k, now in enumerate(x):
                    p = min(max(p, now - half), now + half)
                    out[k] = p - now
                return np.asarray(_factor(by, signals) * out)

            shape = Shape("b", half, self.units[a])
            memory = (f"p := clip(p, {a} - b, {a} + b)",)
            yield Term(place, at, _times(by, f"p - {a}"), "play", (a,), unit, (shape,), memory, held)

    def _resonant(self, place: str, at: str, a: str) -> Iterator[Term]:
        """A mass on a spring that a signal moves: its motion beside that."""
        for share in _RESONANCES:
            w = share * self.band
            a1, a2 = Shape("a1", 2 * _DAMPED / w, "s"), Shape("a2", 1 / w**2, "s^2")

            def beside(signals: Signals, rate: float, w: float = w) -> Array:
                warped = 0.5 * w / np.tan(0.5 * w / rate)  # the bilinear rule, right at w
                over, under = scipy.signal.bilinear([1.0], [1 / w**2, 2 * _DAMPED / w, 1.0], warped)
                return np.asarray(scipy.signal.lfilter(over, under, signals[a]) - signals[a])

            yield Term(
                place, at, f"lag2({a}, a1, a2) - {a}", "resonance", (a,), self._unit((a, 1)), (a1, a2), (), beside
            )

    def _by(self, place: str, at: str, a: str) -> tuple[str, Powers]:
        """What multiplies a memory of a signal, as the loop's gain does where it is fed back, and its unit."""
        by = "Kp" if place == "controller" and a != at and "Kp" in self.typical else ""
        return by, self._unit((a, 1), *[(by, 1)] * bool(by))

    def _of_two(self, place: str, at: str, a: str, b: str) -> Iterator[Term]:
        for text, kind, powers, symmetric in (
            ("{a} * {b}", "product", (1, 1), True), ("{a} * abs({b})", "grows with", (1, 1), False),
            ("{a} * sgn({b})", "turns with", (1, 0), False), ("abs({a}) * sgn({b})", "size along", (1, 0), False),
            ("max({a}, 0) * {b}", "one-sided product", (1, 1), False),
            ("{a} * {b}**2", "grows with square", (1, 2), False),
            ("{a}**2 * sgn({b})", "square along", (2, 0), False),
            ("abs({a}) * {b} * abs({b})", "square grown", (1, 2), False),
        ):  # fmt: skip
            if not symmetric or a < b:
                unit = self._unit((a, powers[0]), (b, powers[1]))
                taken = text.removesuffix(" * sgn({b})").format(a=a) if kind in ("size along", "square along") else ""
                yield self._dragging(Term(place, at, text.format(a=a, b=b), kind, (a, b), unit), b, taken)

    def _of_position(self, place: str, at: str) -> Iterator[Term]:
        if "x" not in self.typical:
            return
        x = self.typical["x"]
        span = float(np.ptp(np.quantile(x, [0.02, 0.98])))
        for share, wide in product(_HILLS, _HILL) if span > 0 else ():
            middle = Shape(
                "xm", float(np.quantile(x, share)), self.units["x"], lower=float(x.min()), upper=float(x.max())
            )
            shapes = (middle, Shape("d", wide * span, self.units["x"]))
            hill = "exp(-((x - xm) / d)**2)"
            yield Term(place, at, hill, "hill", ("x",), {}, shapes)
            for b in self.signals[place]:
                if b in (at, "v") and b != "x":
                    yield Term(place, at, f"{b} * {hill}", "hill of", (b, "x"), self._unit((b, 1)), shapes)
            if "v" in self.signals[place]:
                rubbing = Term(place, at, f"sgn(v) * {hill}", "friction at", ("v", "x"), {}, shapes)
                yield self._dragging(rubbing, "v", hill)

    def _with_conditions(self, place: str, at: str) -> Iterator[Term]:
        """Terms that grow with a condition of the run, where it differs, with a recorded channel, or with time."""
        for name in self.recorded:
            yield Term(place, at, name, "recorded", (name,), self._unit((name, 1)))
        for name in (*self.varied, *self.recorded, "t"):
            unit = {"t": "s"}.get(name) or self.units.get(name, "1")
            for a in self.signals[place]:
                powers = _multiplied(self._unit((a, 1)), powers_of(unit) or {}, 1)
                yield Term(place, at, f"{name} * {a}", "condition", (name, a), powers)
                if a == "v":
                    powers = dict(powers_of(unit) or {})
                    rubbing = Term(place, at, f"{name} * sgn({a})", "friction with", (name, a), powers)
                    yield self._dragging(rubbing, a, name)
        if "t" not in self.varied:
            yield Term(place, at, "t", "drift", ("t",), {"s": 1.0})
        for share in _FADING:
            T = Shape("T", share * self.seconds, "s")
            for a in self.signals[place]:
                if a in (at, "v"):
                    yield Term(place, at, f"{a} * (1 - exp(-t / T))", "fading", ("t", a), self._unit((a, 1)), (T,))
                if (place, a) == ("load", "v"):
                    rubbing = Term(place, at, f"sgn({a}) * exp(-t / T)", "fading friction", ("t", a), {}, (T,))
                    yield self._dragging(rubbing, a, "exp(-t / T)")

    def _dragging(self, term: Term, along: str, limit: str) -> Term:
        """A term that turns with the sign of `along`: dry friction where that is the speed of the moving mass."""
        if limit and (term.place, along) == ("load", "v") and LIMIT in self.units:
            return replace(term, limit=limit)
        return term

    def _periodic(self, place: str, at: str) -> Iterator[Term]:
        """What comes and goes with time, each frequency of the band that the shortest run resolves.

        Only what modulates: a sum with a wave of one phase in every run is what hum in the records looks like.
        """
        if place not in ("flow", "spool") or (place == "spool" and "flow" in self.places):
            return
        step = 1.0 / self.seconds
        for number in range(1, int(self.band / (2 * np.pi) / step)):
            f = Shape("fp", number * step, "1/s", spread=1.0 + 0.7 / number)
            for phase in (0.0, 0.25):
                turn = Shape("g", phase, "1", lower=-0.5, upper=0.5)
                text = f"{at} * sin(2 * pi * (fp * t + g))"
                yield Term(place, at, text, "periodic", (at, "t"), self._unit((at, 1)), (f, turn))

    def _unit(self, *of: tuple[str, int]) -> Powers:
        found: Powers = {}
        for name, power in of:
            found = _multiplied(found, powers_of(self.units[name]) or {}, power)
        return found


def _lagging(x: Array, rate: float, T: float) -> Array:
    """x behind a lag of T."""
    decay = np.exp(-1.0 / rate / T)
    return np.asarray(scipy.signal.lfilter([1 - decay], [1, -decay], x))


def _factor(by: str, signals: Signals) -> Array | float:
    return signals[by] if by else 1.0


def _times(by: str, text: str) -> str:
    return f"{by} * ({text})" if by else text


def _multiplied(a: Powers, b: Powers, power: int) -> Powers:
    found = dict(a)
    for name, of in b.items():
        found[name] = found.get(name, 0.0) + power * of
    return {name: of for name, of in found.items() if of}


def ratio(of: str, to: Powers) -> str:
    """The unit of one signal over that of a term, as text: "m^3*s^-1*Pa^-1"."""
    powers = _multiplied(powers_of(of) or {}, to, -1)
    return "*".join(name if power == 1 else f"{name}^{power:g}" for name, power in powers.items()) or "1"
