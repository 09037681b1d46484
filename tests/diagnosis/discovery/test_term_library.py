"""Every term that a search looks at can be worked out on samples, and is an effect that a model takes."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from ident.chain.conditions import CONDITIONS
from ident.custom.definition import read_effect
from ident.diagnosis.discovery.candidate_terms import _PLACES, _SIGNALS, _known_there, _there
from ident.diagnosis.discovery.dynamic_terms import error_terms
from ident.diagnosis.discovery.term import Term, ratio
from ident.diagnosis.discovery.term_library import TermLibrary
from ident.diagnosis.discovery.term_to_effect import as_fitted, definition, equation_text
from ident.presets import PRESETS
from tests.effects import dimensions

MODEL = PRESETS["qian2014"]
UNITS = {name: quantity.unit for name, quantity in CONDITIONS.items()} | dict(MODEL.chain.units)
RATE, BAND, SECONDS = 800.0, 2 * np.pi * 80.0, 0.5
SIZES = {"w": 1e-3, "Q": 1e-5, "P": 1e6, "v": 0.05, "x": 1e-3, "F": 300.0, "e": 1e-3, "R": 200.0, "dq": 0.5}
SIZES |= {"y": 1e-3, "y_fb": 1e-3}


def signals() -> dict[str, np.ndarray]:
    rng = np.random.default_rng(4)
    found = {name: size * rng.standard_normal(400) for name, size in SIZES.items()}
    return found | {
        "Kp": np.full(400, 7.0),
        "mL": np.full(400, 1.0),
        "k": np.full(400, 3e4),
        "t": np.arange(400) / RATE,
    }


@cache
def every() -> tuple[Term, ...]:
    """The whole library."""
    library = TermLibrary(
        _PLACES, _there(MODEL, _PLACES, _SIGNALS, signals()), signals(), UNITS, BAND, SECONDS, ("Kp", "mL", "k")
    )
    return tuple(library.terms())


@cache
def terms() -> dict[tuple[str, str], Term]:
    """The first of each form at each place; what the transducer reads is one of its own."""
    listed = every()
    assert len({(term.at, term.text, *(shape.value for shape in term.shapes)) for term in listed}) == len(listed)
    return {("reading" if term.at == "y_fb" else term.place, term.kind): term for term in reversed(listed)}


@pytest.mark.parametrize("place", sorted({*_PLACES.values(), "reading"}))
def test_each_term_of_a_place_is_worked_out_and_is_an_effect(place):
    of_place = {form: term for form, term in terms().items() if form[0] == place}
    assert of_place
    for term in of_place.values():
        is_worked_out_and_is_an_effect(term, signals())


def is_worked_out_and_is_an_effect(term: Term, known: dict[str, np.ndarray]) -> None:
    samples = term.samples(known, RATE)
    assert samples.shape == (400,)
    assert np.all(np.isfinite(samples))
    assert np.std(samples) > 0 or term.kind == "hill"
    own = definition("proposed_1", (term,), (1.0,), 1e-3, known, UNITS)
    effect = read_effect(own, model="qian2014")
    assert effect.strength.lower < 0 or term.limit
    assert effect.strength.upper > 0
    for parameter in effect.parameters[1:]:
        assert parameter.lower < parameter.upper
        assert parameter.lower <= parameter.value <= parameter.upper


def test_the_unit_of_a_strength_is_that_of_its_place_over_that_of_the_term():
    of_pressure = Term("flow", "Q", "abs(P)", "size", ("P",), {"Pa": 1.0})
    assert ratio("m^3/s", of_pressure.unit) == "m^3*s^-1*Pa^-1"
    assert dimensions.of("m^3/(s*Pa)") == dimensions.of(ratio("m^3/s", of_pressure.unit))


@pytest.mark.parametrize("kind", ["lag", "play"])
def test_what_remembers_is_worked_out_by_hand(kind):
    term, known = terms()["spool", kind], signals()
    x, (shape,) = known["w"], term.shapes
    state, expected = 0.0, []
    for now in x:
        if kind == "lag":
            state += (1 - np.exp(-1 / RATE / shape.value)) * (now - state)
        else:
            state = min(max(state, now - shape.value), now + shape.value)
        expected.append(state - now)
    assert term.samples(known, RATE) == pytest.approx(np.array(expected), abs=1e-12)


def test_what_a_controller_makes_of_its_error_is_worked_out_by_hand_and_has_a_state_of_its_own():
    known = signals()
    summed, changing = (terms()["controller", kind] for kind in ("integral", "rate"))
    assert summed.samples(known, RATE)[9] == pytest.approx(known["e"][:10].sum() / RATE)
    assert changing.samples(known, RATE)[5] == pytest.approx((known["e"][6] - known["e"][4]) * RATE / 2)
    own = definition("proposed_1", (summed,), (1.0,), 0.3, known, UNITS)
    assert equation_text(own) == "z' = e; e = e + s * (z)"
    assert own["strength"]["unit"] == "s^-1"
    assert own["strength"]["upper"] == pytest.approx(3.0)  # ten times what a regression made of it
    assert dimensions.of(definition("p", (changing,), (1.0,), 1e-3, known, UNITS)["strength"]["unit"]) == dimensions.of(
        "s"
    )
    bare = TermLibrary(_PLACES, _there(MODEL, _PLACES, _SIGNALS, signals()), known, {"e": "m"}, BAND, SECONDS)
    assert not list(error_terms(bare, "controller", "e"))  # a machine in open loop has no error


def test_what_yields_follows_the_way_at_first_and_then_gives_no_more_than_its_reach():
    """z' = v − |v| z / b on a ramp from rest: z = b (1 − exp(−x / b)), and back from its reach twice as far."""
    term = terms()["load", "yields"]
    assert (term.text, term.state) == ("z", "v - abs(v) * z / b")
    (b,) = (shape.value for shape in term.shapes)
    x = np.concatenate([np.linspace(0.0, 20.0 * b, 500), np.linspace(20.0 * b, 18.0 * b, 500)])
    z = term.samples({**signals(), "x": x}, RATE)
    assert z[:500] == pytest.approx(b * (1.0 - np.exp(-x[:500] / b)), abs=1e-9 * b)
    assert z[-1] == pytest.approx(b * (2.0 * np.exp(-2.0) - 1.0), abs=1e-6 * b)
    own = definition("proposed_1", (term,), (1.0,), 1e3, signals(), UNITS)
    assert read_effect(own, model="qian2014").texts == ("z' = v - abs(v) * z / b", "R = R + s * (z)")


def test_a_definition_is_restated_as_the_last_refit_left_it():
    """Later terms move the shape of an earlier one, and its strength beyond ten times its first estimate."""
    own = definition("proposed_1", (terms()["load", "yields"],), (1.0,), 1e-9, signals(), UNITS)
    effect = read_effect(own, model="qian2014")
    strength, b = effect.added
    far = 3.0 * own["strength"]["upper"]
    found = as_fitted(own, effect, {strength.in_equations: -far, b.in_equations: 1.5 * b.value})
    assert found["shape"]["b"]["value"] == pytest.approx(1.5 * b.value)
    assert -found["strength"]["lower"] == found["strength"]["upper"] == pytest.approx(10.0 * far)
    near = as_fitted(own, effect, {strength.in_equations: far / 300.0, b.in_equations: b.value})
    assert near["strength"] == own["strength"]
    assert near["shape"] == own["shape"]


def test_a_valve_s_own_speed_is_all_that_terms_there_are_of():
    of_valve = [term for term in every() if term.place == "valve"]
    assert {term.of for term in of_valve} == {("dq",)}
    assert {"beyond", "cube", "lag", "play"} <= {term.kind for term in of_valve}


def test_a_signal_that_follows_at_once_is_none_of_a_place():
    motor = PRESETS["motor"]
    assert _known_there(motor, "controller", "e", "v")
    assert not _known_there(motor, "controller", "e", "w")  # no valve between
    assert _known_there(MODEL, "controller", "e", "w")
    assert not _known_there(MODEL, "spool", "w", "Q")
    assert not _known_there(MODEL, "load", "R", "F")


def test_friction_sticks_and_what_drives_does_not():
    """What turns with the sign of the mass's speed adds to dry friction, where it brakes: no sign chatters at rest."""
    for form, limit in (
        (("load", "size along"), None),
        (("load", "friction with"), "Kp"),
        (("load", "fading friction"), "exp(-t / T)"),
        (("load", "friction at"), "exp(-((x - xm) / d)**2)"),
    ):
        term = next(one for one in every() if (one.place, one.kind) == form and one.limit)
        assert limit in (None, term.limit)
        assert term.text in (f"{term.limit} * sgn(v)", f"sgn(v) * {term.limit}")
        braking = definition("proposed_1", (term,), (1.0,), 1e-3, signals(), UNITS)
        assert braking["equation"] == [f"Ff = Ff + s * ({term.limit})"]
        assert braking["strength"]["lower"] == 0.0
        driving = definition("proposed_1", (term,), (1.0,), -1e-3, signals(), UNITS)
        assert driving["equation"] == [f"R = R + s * ({term.text})"]
    assert all(one.place == "load" and "sgn(v)" in one.text for one in every() if one.limit)
