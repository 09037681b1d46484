"""Against which signal a term is drawn: that which tells most of it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.discovery.characteristic_plot import characteristic_view
from ident.diagnosis.discovery.term import Term
from ident.presets import preset
from ident.residuals.views import view_called

MODEL = preset("qian2014")


def signals() -> dict[str, np.ndarray]:
    rng = np.random.default_rng(4)
    return {name: rng.standard_normal(5000) for name in ("e", "w", "Q", "P", "v", "x", "R", "y")}


@pytest.mark.parametrize(
    ("at", "text", "of", "view"),
    [
        ("Q", "abs(P)", ("P",), "Q(P)"),
        ("R", "x**3", ("x",), "R(x)"),
        ("w", "w * abs(P)", ("w", "P"), "w(P)/w"),  # its mean along P is nothing, its share of the opening a V
        ("w", "abs(w)", ("w",), "w(w)"),
        ("Q", "t * Q", ("t", "Q"), ""),
        ("R", "P * sgn(v)", ("P", "v"), ""),
    ],
)
def test_a_term_is_drawn_where_it_shows(at, text, of, view):
    known = signals() | {"t": np.linspace(0.0, 1.0, 5000)}
    assert characteristic_view(Term("flow", at, text, "any", of, {}), MODEL, known) == view


def test_a_view_of_what_the_model_lacks_is_none():
    assert view_called("Q(P)", MODEL).signals == ("P",)
    assert view_called("w(P)/w", MODEL).signals == ("P", "w")
    for name in ("Q(Q", "Q(zz)", "zz(P)", "Q(P)/w", "", "()", "P(Q)"):
        assert view_called(name, MODEL) is None
    assert view_called("Q(P)", preset("specimen")) is None
