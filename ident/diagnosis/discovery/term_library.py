"""The library of terms that may be missing at a place, written as equations and worked out on samples.

Terms are drawn from forms: powers, roots, absolute values, signs, one-sided parts and thresholds of one signal;
products of two; hills of the position; lags and play; auxiliary channels. Each becomes an effect of its own, ``at = at
+ s term``, whose strength s has the unit of the signal that it acts on over the unit of the term.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.compressibility_terms import compressibility_terms
from ident.diagnosis.discovery.dynamic_terms import SLIP, dynamic_terms, error_terms
from ident.diagnosis.discovery.site import Site
from ident.diagnosis.discovery.term import LIMIT, Shape, Term, multiplied
from ident.units.grammar import powers_of

ALONE = "valve"
"""A place whose terms read its own signal alone."""
_OF_ONE = (
    ("{a} * abs({a})", "square", 2),
    ("abs({a})", "size", 1),
    ("sgn({a})", "sign", 0),
    ("{a}**3", "cube", 3),
    ("{a}**2", "even square", 2),
)
"""Functions of one signal: text, kind, and the power of its unit. No answer depends on it: the text says it."""


@dataclass(frozen=True)
class TermLibrary(Site):
    """All terms for the places of a chain."""

    def terms(self) -> Iterator[Term]:
        """Every term, the simplest forms first."""
        for at, place in self.places.items():
            signals = self.signals[at]
            for a in signals:
                yield from self._of_one(place, at, a)
            if place == ALONE:
                continue
            yield from error_terms(self, place, at)
            for a in signals:
                for b in signals:
                    if a != b:
                        yield from self._of_two(place, at, a, b)
            yield from self._of_speed(place, at)
            yield from self._of_position(place, at)
            yield from self._with_conditions(place, at)
            yield from self._periodic(place, at)
        if "flow" in self.places.values():
            yield from compressibility_terms(self)

    def _of_one(self, place: str, at: str, a: str) -> Iterator[Term]:
        for text, kind, power in _OF_ONE:
            plain = Term(place, at, text.format(a=a), kind, (a,), self.unit((a, power)))
            yield self._dragging(plain, a, "1" if kind == "sign" else "")
        scale = Shape("a0", float(np.std(self.typical[a])), self.units[a], free=False)
        yield Term(place, at, f"sgn({a}) * sqrt(abs({a}) / a0)", "root", (a,), {}, (scale,))
        for share in CRITERIA.terms.thresholds:
            width = Shape("h", float(np.quantile(np.abs(self.typical[a]), share)), self.units[a])
            if width.value > 0:
                for text, kind in (
                    ("{a} - clip({a}, -h, h)", "beyond"),
                    ("max({a} - h, 0)", "above"),
                    ("min({a} + h, 0)", "below"),
                ):
                    yield Term(place, at, text.format(a=a), kind, (a,), self.unit((a, 1)), (width,))
                if a == at:
                    text = f"{a} / sqrt(1 + ({a} / h)**2) - {a}"
                    yield Term(place, at, text, "saturation", (a,), self.unit((a, 1)), (width,))
        yield from dynamic_terms(self, place, at, a)

    def _of_two(self, place: str, at: str, a: str, b: str) -> Iterator[Term]:
        for text, kind, powers, symmetric in (
            ("{a} * {b}", "product", (1, 1), True),
            ("{a} * abs({b})", "grows with", (1, 1), False),
            ("{a} * sgn({b})", "turns with", (1, 0), False),
            ("abs({a}) * sgn({b})", "size along", (1, 0), False),
            ("max({a}, 0) * {b}", "one-sided product", (1, 1), False),
            ("min({a}, 0) * {b}", "one-sided product", (1, 1), False),
            ("{a} * {b}**2", "grows with square", (1, 2), False),
            ("{a}**2 * sgn({b})", "square along", (2, 0), False),
            ("abs({a}) * {b} * abs({b})", "square grown", (1, 2), False),
        ):
            if not symmetric or a < b:
                unit = self.unit((a, powers[0]), (b, powers[1]))
                taken = text.removesuffix(" * sgn({b})").format(a=a) if kind in ("size along", "square along") else ""
                yield self._dragging(Term(place, at, text.format(a=a, b=b), kind, (a, b), unit), b, taken)

    def _of_speed(self, place: str, at: str) -> Iterator[Term]:
        """Dry friction that is larger, or smaller, near rest than in motion."""
        if place != "load" or "v" not in self.signals[at]:
            return
        for share in CRITERIA.terms.slow:
            vs = self.slow(share)
            if vs.value > 0:
                near_rest = "exp(-(v / vs)**2)"
                rubbing = Term(place, at, f"sgn(v) * {near_rest}", "friction near rest", ("v",), {}, (vs,))
                yield self._dragging(rubbing, "v", near_rest)
        yield from self._slipping(place, at)

    def _slipping(self, place: str, at: str) -> Iterator[Term]:
        """Friction that slips smoothly near rest, as that of a wet seal, alone and in proportion to each signal."""
        vs = self.slow(min(CRITERIA.terms.slow))
        if vs.value > 0:
            yield Term(place, at, SLIP, "slip", ("v",), {}, (vs,))
            for a in self.signals[at]:
                if a != "v":
                    yield Term(place, at, f"abs({a}) * {SLIP}", "slip with", (a, "v"), self.unit((a, 1)), (vs,))

    def _of_position(self, place: str, at: str) -> Iterator[Term]:
        if "x" not in self.typical:
            return
        x = self.typical["x"]
        span = float(np.ptp(np.quantile(x, CRITERIA.terms.hills)))  # single samples do not count
        for share, wide in product(CRITERIA.terms.hills, CRITERIA.terms.hill_widths) if span > 0 else ():
            middle = Shape(
                "xm", float(np.quantile(x, share)), self.units["x"], lower=float(x.min()), upper=float(x.max())
            )
            shapes = (middle, Shape("d", wide * span, self.units["x"]))
            hill = "exp(-((x - xm) / d)**2)"
            yield Term(place, at, hill, "hill", ("x",), {}, shapes)
            for b in self.signals[at]:
                if b in (at, "v") and b != "x":
                    yield Term(place, at, f"{b} * {hill}", "hill of", (b, "x"), self.unit((b, 1)), shapes)
            if "v" in self.signals[at]:
                rubbing = Term(place, at, f"sgn(v) * {hill}", "friction at", ("v", "x"), {}, shapes)
                yield self._dragging(rubbing, "v", hill)

    def _with_conditions(self, place: str, at: str) -> Iterator[Term]:
        """Terms that grow with a condition of the run, where it differs, with a recorded channel, or with time."""
        for name in self.recorded:
            yield Term(place, at, name, "recorded", (name,), self.unit((name, 1)))
        for name in (*self.varied, *self.recorded, "t"):
            unit = {"t": "s"}.get(name) or self.units.get(name, "1")
            for a in self.signals[at]:
                powers = multiplied(self.unit((a, 1)), powers_of(unit) or {}, 1)
                yield Term(place, at, f"{name} * {a}", "condition", (name, a), powers)
                if a == "v":
                    powers = dict(powers_of(unit) or {})
                    rubbing = Term(place, at, f"{name} * sgn({a})", "friction with", (name, a), powers)
                    yield self._dragging(rubbing, a, name)
        if "t" not in self.varied:
            yield Term(place, at, "t", "drift", ("t",), {"s": 1.0})
        for share in CRITERIA.terms.time_constants:
            T = Shape("T", share * self.seconds, "s")
            for a in self.signals[at]:
                if a in (at, "v"):
                    yield Term(place, at, f"{a} * (1 - exp(-t / T))", "fading", ("t", a), self.unit((a, 1)), (T,))
                if (place, a) == ("load", "v"):
                    rubbing = Term(place, at, f"sgn({a}) * exp(-t / T)", "fading friction", ("t", a), {}, (T,))
                    yield self._dragging(rubbing, a, "exp(-t / T)")

    def _dragging(self, term: Term, along: str, limit: str) -> Term:
        """A term that turns with the sign of `along`: dry friction where `along` is the speed of the moving mass."""
        if limit and (term.place, along) == ("load", "v") and LIMIT in self.units:
            return replace(term, limit=limit)
        return term

    def _periodic(self, place: str, at: str) -> Iterator[Term]:
        """Periodic terms, one for each frequency of the band that the shortest run resolves.

        They only modulate: an added wave of one phase in every run would look like hum in the records.
        """
        if place not in ("flow", "spool") or (place == "spool" and "flow" in self.places.values()):
            return
        step = 1.0 / self.seconds
        for number in range(1, int(self.band / (2 * np.pi) / step)):
            f = Shape("fp", number * step, "1/s", spread=1.0 + CRITERIA.terms.frequency_spread / number)
            for phase in (0.0, 0.5 / 2):  # sin(2 π (f t + 1/4)) = cos(2 π f t)
                turn = Shape("g", phase, "1", lower=-0.5, upper=0.5)
                text = f"{at} * sin(2 * pi * (fp * t + g))"
                yield Term(place, at, text, "periodic", (at, "t"), self.unit((at, 1)), (f, turn))
