"""An effect that a user writes down: what is understood, what is refused and where."""

from __future__ import annotations

import contextlib
import re
import warnings

import numpy as np
import pytest

from ident.chain.conditions import conditions
from ident.custom.definition import definition_of, preset_with, read_effect
from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.equations.grammar import parsed
from ident.errors import Unusable
from ident.matrix import Actuator
from ident.presets import PRESETS
from ident.run import Run
from ident.simulation.simulate import responses

GOOD = {
    "name": "overlap", "place": "spool", "equation": "w = w - clip(w, -h, h)",
    "strength": {"symbol": "h", "unit": "mm", "lower": 0, "upper": 1}, "meaning": "the lands overlap",
}  # fmt: skip
CURVE = {"symbol": "cv", "of": "x", "knots": ["-1 mm", 0, "2 mm"], "values": [1, 0.5, 2], "unit": "1",
         "lower": 0, "upper": 4}  # fmt: skip
HOSTILE = {
    "w = __import__('os').system('id')": 5,
    "w = (lambda: w)() * h": 5,
    "w = w.__class__ * h": 6,
    "w = [w for w in h]": 5,
    "w = 2h * w": 6,
    "w = w * h ** 999": 14,
    "w = 9 ** 9 ** 9 * h": 10,
    "w = 1e300 * h": 5,
    "w = w - 'A' * h": 9,
    "w = w + h if": 13,
    "w = w - clip(w, -h, h": 13,
    "w = w - h)": 10,
    "w = w ^ h": 6,
    "w = eval(h)": 5,
    "w = max(w)": 5,
    "w = w == h": 6,
    "w = ｗ * h": 5,
    "w = w − h": 7,
    "w = w * hh": 9,
    "w = w * h\x00": 10,
    "w = " + "(" * 100_000 + "h" + ")" * 100_000: 1001,
    "w = " + "(" * 300 + "h" + ")" * 300: 5,
    "w = h" + " + h" * 240: None,
    "w = " + "-" * 500 + "h": None,
    "W = w * h": 1,
    "Q = Q * h": 1,
    "w' = w * h": 2,
}


def written(**changes: object) -> dict[str, object]:
    """The good definition with some fields changed."""
    return {**GOOD, **changes}


def refusal(definition: object, name: str = "") -> Unusable:
    with pytest.raises(Unusable) as caught:
        read_effect(definition, name)
    return caught.value


@pytest.mark.parametrize(("equation", "character"), HOSTILE.items(), ids=lambda value: str(value)[:30])
def test_what_is_no_equation_is_refused_with_the_character(equation, character):
    """Code, huge numbers, deep brackets, look-alikes, missing brackets, foreign names."""
    error = refusal(written(equation=equation))
    assert error.where.startswith("equation, character ")
    assert character is None or error.where == f"equation, character {character}"
    assert error.remedy


def test_the_line_and_the_rate_are_named():
    """Several lines, and the rate of a state."""
    assert refusal(written(equation=["w = w - h", "w = w +"])).where == "equation, line 2, character 8"
    state = {"symbol": "z", "rate": "(w - z) / hidden"}
    error = refusal(written(equation="w = w - h * z", state=state))
    assert (error.where, error.code) == ("state rate, character 11", "unknown-name")


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"equation": "w = 2 * w + h"}, "not-off"),
        ({"equation": "w = lag(w + h, Ts)", "shape": {"Ts": "1 ms"}}, "not-off"),
        ({"equation": "w = w / h"}, "not-off"),
        ({"equation": "w = z", "state": {"symbol": "z", "rate": "(w - z) / h"}}, "not-off"),
        ({"equation": "w = w * 2"}, "unused-strength"),
        ({"equation": "w = w + h * Q"}, "algebraic-loop"),
        ({"name": "dead_zone"}, "name-taken"),
        ({"name": "over__lap"}, "bad-name"),
        ({"strength": {"symbol": "q", "unit": "mm", "lower": 0, "upper": 1}}, "name-taken"),
        ({"strength": {"symbol": "k", "unit": "mm", "lower": 0, "upper": 1}}, "name-taken"),
        ({"strength": {"symbol": "t", "unit": "s", "lower": 0, "upper": 1}}, "name-taken"),
        ({"strength": {"symbol": "h", "lower": 0, "upper": 1}}, "missing-unit"),
        ({"strength": {"symbol": "h", "unit": "furlongs/x", "lower": 0, "upper": 1}}, "unknown-unit"),
        ({"strength": {"symbol": "h", "unit": "mm", "lower": 1, "upper": 2}}, "outside-bounds"),
        ({"strength": {"symbol": "h", "unit": "mm", "lower": 0, "upper": 0}}, "empty-bounds"),
        ({"strength": {"symbol": "h", "unit": "mm", "lower": "0 s", "upper": 1}}, "wrong-dimension"),
        ({"shape": {"h": "1 ms"}}, "name-taken"),
        ({"place": "gearbox"}, "unknown-place"),
        ({"state": {"symbol": "z", "rate": "w", "initial": 1}}, "bad-state"),
        ({"equation": "w = w + h * displacement"}, "unknown-name"),
        ({"curve": CURVE | {"of": "supply_presure"}}, "unknown-name"),
        ({"curve": CURVE | {"symbol": "Q"}}, "name-taken"),
        ({"curve": CURVE | {"values": [0, 1]}}, "bad-curve"),
        ({"curve": CURVE | {"knots": [0, 0, 1]}}, "bad-curve"),
        ({"curve": CURVE | {"knots": ["0 N", "1 mm", "2 mm"]}}, "bad-curve"),
        ({"curve": CURVE | {"values": [0, 1, 7]}}, "outside-bounds"),
        ({"curve": CURVE | {"draw": "freehand"}}, "unknown-draw"),
        ({"run": "rm"}, "unknown-key"),
    ],
)
def test_a_definition_that_makes_no_sense_is_refused(changes, code):
    """Not off at 0, nothing to act on, names that mean two things, units and bounds."""
    assert refusal(written(**changes)).code == code


@pytest.mark.parametrize(
    "text", [b"a: &x 1", b"!!python/object/apply:os.system [id]", b"[1, 2]", b"x" * 1_100_000, b"\xff"]
)
def test_a_file_that_is_no_plain_mapping_is_refused(text):
    """Tags, anchors, lists, too much, no text."""
    assert refusal(text).code in ("yaml-tag", "yaml-alias", "not-an-effect", "not-yaml")


def test_a_file_and_its_data_are_the_same_effect():
    """The text of a file, called after it, and the same as plain data."""
    text = 'place: spool\nequation: w - clip(w, -h, h)\nstrength: {symbol: h, unit: mm, lower: 0, upper: "1 mm"}\n'
    found = read_effect(text, "our-overlap")
    assert found == read_effect(definition_of(text, "our-overlap"))
    assert (found.name, found.texts) == ("our_overlap", ("w = w - clip(w, -h, h)",))
    assert (found.strength.unit, found.strength.upper) == ("m", 1e-3)


def test_a_curve_is_a_line_of_its_own_whose_values_are_shapes():
    """In SI, and held unless a fit is given bounds: the kernel draws it through its knots and straight on beyond."""
    own = read_effect(written(equation="w = w - h * cv", curve=CURVE))
    assert own.texts[0] == "cv = lines(x, -0.001, cv_1, 0.0, cv_2, 0.002, cv_3)"
    assert [(p.name, p.value, p.upper) for p in own.shape] == [("cv_1", 1, 4), ("cv_2", 0.5, 4), ("cv_3", 2, 4)]
    drawn = Equation(own.texts[0]).value({"x": np.array([-1e-3, 1e-3, 4e-3]), "cv_1": 1.0, "cv_2": 0.5, "cv_3": 2.0})
    assert drawn == pytest.approx([1.0, 1.25, 3.5])


def test_what_an_effect_calls_like_a_channel_is_its_own():
    """A symbol that was kept before channels had names still means what it meant."""
    own = read_effect(
        written(equation="w = w - clip(w, -force, force)", strength=GOOD["strength"] | {"symbol": "force"})
    )
    assert "force" not in preset_with("qian2014").with_effects((own,)).chain.symbols


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("sign(-3)", -1),
        ("2 if 1 < x <= 3 else 5", 2),
        ("max(1, x, 2)", 3),
        ("(x > 1) + (x > 2) - (x > 9)", 2),
        ("not x > 2 or x < 1", 0),
        ("1 < x and x < 4", 1),
        ("sin(pi / 2) + cos(0) + tanh(0)", 2),
    ],
)
def test_the_grammar_means_what_it_says(text, value):
    """In numbers, and by the compiled kernel."""
    assert Equation(f"y = {text}").value({"x": np.float64(3.0)}) == pytest.approx(value)
    assert kernel_value(re.sub(r"\bx\b", "(2 + h)", text)) == pytest.approx(value)


def test_time_runs_from_the_start_of_the_record_also_inside_a_step():
    """The integral of 3 t² over a record is t³, exactly: Simpson's rule at every step."""
    own = {
        "name": "clock",
        "place": "sensor",
        "equation": "y = y + h * z",
        "state": {"symbol": "z", "rate": "3 * t**2"},
    }
    x = simulated(read_effect(written(**own)))
    assert x == pytest.approx((np.arange(len(x)) / 100) ** 3, abs=1e-12)


def kernel_value(text: str) -> float:
    """What the kernel makes of an expression: the reading of a machine at rest."""
    own = read_effect(written(place="sensor", equation=f"y = y + h * ({text})"))
    return float(simulated(own)[-1])


def simulated(own: Effect) -> np.ndarray:
    """Twenty samples at 100 Hz of a machine at rest, the strength 1."""
    still = np.zeros(20)
    run = Run("run", "", 100.0, {"command": still, "displacement": still})
    model = PRESETS["first_order"].with_effects((own,))
    values = (
        {p.in_equations: p.value for p in model.parameters} | conditions(run, Actuator("")) | {own.symbol("h"): 1.0}
    )
    return responses(model.chain, [run], {name: np.array([[value]]) for name, value in values.items()})[:, 0, 0]


def test_an_effect_is_refused_by_a_model_that_lacks_its_place():
    """The same definition, asked for with another model."""
    assert preset_with("qian2014", ("overlap",), (GOOD,)).effects[0].name == "overlap"
    with pytest.raises(Unusable, match="not a signal of the place"):
        preset_with("drive", ("overlap",), (GOOD,))


def test_a_parser_of_strict_texts_never_raises_anything_else():
    """Random texts of the grammar's letters end in a tree or a refusal."""
    rng = np.random.default_rng(1)
    letters = np.array(list("wh()+-*/.<>=,'\"[]{}:;@!^%~ 019etif\\\n"))
    with warnings.catch_warnings():  # of the parser alone: what others left is no warning of these texts
        warnings.simplefilter("error")
        for _ in range(2000):
            text = "".join(rng.choice(letters, rng.integers(1, 40)))
            with contextlib.suppress(Unusable):
                parsed(text, 0, strict=True)
