"""Where the shapes of terms begin: each shape that a machine may have lies within reach of one of them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from ident.diagnosis.discovery.term import Shape, Term
from ident.diagnosis.discovery.term_library import TermLibrary

UNITS = {"R": "N", "v": "m/s", "x": "m", "Q": "m^3/s", "t": "s"}
BAND, SECONDS = 10.0, 2.0  # Hz, of the shortest run
EVEN = np.linspace(0.0, 1.0, 10_001)  # its quantiles are their own values


@cache
def terms() -> tuple[Term, ...]:
    """All terms of a load and of a flow whose signals are spread evenly."""
    signals = {"R": EVEN, "v": EVEN, "x": EVEN, "Q": EVEN}
    places = {"R": "load", "Q": "flow"}
    read = {"R": ["v", "x", "R"], "Q": ["Q"]}
    return tuple(TermLibrary(places, read, signals, UNITS, 2 * np.pi * BAND, SECONDS).terms())


def begun(kind: str, symbol: str) -> np.ndarray:
    """Where a shape of a kind of term begins."""
    return np.array(
        [shape.value for term in terms() if term.kind == kind for shape in term.shapes if shape.symbol == symbol]
    )


DEVIATION = float(np.std(EVEN))


@pytest.mark.parametrize(
    ("kind", "symbol", "least", "most", "unit", "ratio"),
    [
        ("beyond", "h", 0.235, 0.99, 1.0, 1.3),  # of the largest size
        ("friction near rest", "vs", 0.03, 0.7, 1.0, 1.8),  # of the largest speed
        ("slip", "vs", 0.045, 0.055, 1.0, 1.15),
        ("lag", "T", 0.011, 1.1, 1.0 / BAND, 1.9),  # of a period at the end of the band
        ("play", "b", 0.06, 1.05, DEVIATION, 1.8),
        ("yields", "b", 0.06, 1.05, DEVIATION, 1.8),
        ("fading", "T", 0.009, 1.1, SECONDS, 2.3),  # of the run
        ("after", "T", 0.009, 1.1, SECONDS, 2.3),
        ("hill", "d", 0.066, 0.39, 0.9, 1.6),  # of the range, less single samples
        ("resonance", "a2", 0.91, 59.0, 1.0 / (2 * np.pi * BAND) ** 2, 1.39),  # the inverse square of a frequency
        ("resonance", "a1", 0.222, 1.34, 1.0 / (2 * np.pi * BAND), 1.18),  # twice the damping over the frequency
    ],
)
def test_a_shape_lies_near_one_from_which_a_refit_begins(kind, symbol, least, most, unit, ratio):
    """Within a ratio, from the least that a term of this kind may have to the most."""
    known = begun(kind, symbol)
    for true in unit * np.geomspace(least, most, 100):
        assert np.exp(np.abs(np.log(known / true)).min()) < ratio


def test_a_hill_anywhere_along_the_way_lies_near_one_from_which_a_refit_begins():
    known = begun("hill", "xm")
    assert max(np.abs(known - place).min() for place in np.linspace(0.0, 1.0, 201)) < 0.08


def test_a_refit_moves_a_shape_by_a_factor_of_eight():
    lower, upper = Shape("h", 1.0, "1").bounds
    assert lower < 1 / 7.0 < 7.0 < upper < 9.0


def test_a_refit_moves_a_frequency_beyond_half_of_the_way_to_the_next_line_and_not_to_it():
    """Of every line of the spectrum of the shortest run."""
    frequencies = [
        shape for term in terms() if term.kind == "periodic" for shape in term.shapes if shape.symbol == "fp"
    ]
    for number, frequency in enumerate(frequencies[::2], 1):
        assert frequency.value == pytest.approx(number / SECONDS)
        assert number + 0.6 < frequency.bounds[1] * SECONDS < number + 0.8
