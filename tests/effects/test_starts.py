"""From where a parameter's search begins stands with the parameter; no general room recognises it by unit or name."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from ident.custom.definition import read_effect
from ident.effects import CATALOGUE, EFFECTS
from ident.errors import Unusable
from ident.parameter import Starts
from tests.conftest import ROOT

_OTHERWISE = {
    "ident/fit/bulk_modulus.py": "which parameter is a compressibility, that is not searched otherwise for it",
    "ident/fit/wider_bounds.py": "which bounds are widened: those of masses, lags and delays, whatever they are called",
    "ident/design/experiment.py": "in which unit a signal is printed",
}
ROOMS = ("diagnosis", "fit", "bench", "presets", "design")
_NAMES = {parameter.name for effect in CATALOGUE for parameter in effect.parameters}
OWN = {
    "name": "pulse",
    "place": "flow",
    "equation": "Q = Q * (1 + dep * sin(2 * pi * fp * t))",
    "strength": {"symbol": "dep", "unit": "1", "lower": 0, "upper": 0.5},
    "shape": {"fp": {"unit": "Hz", "lower": 1, "upper": 100, "value": 10, "start": "spectral lines"}},
}


def decisions(source: str) -> Iterator[str]:
    """Where a parameter's unit, or its name, is compared with a text or looked up in a table that is written there."""
    tree = ast.parse(source)
    constants = {
        target.id
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            if any(_is("unit", one) for one in sides) and any(_is_text(one, constants) for one in sides):
                yield ast.unparse(node)
            named = any(_is("name", one) or _is("symbol", one) for one in sides)
            if named and any(isinstance(one, ast.Constant) and one.value in _NAMES for one in sides):
                yield ast.unparse(node)
        if isinstance(node, ast.Subscript | ast.Call):
            table = node.value if isinstance(node, ast.Subscript) else getattr(node.func, "value", None)
            keys = [node.slice] if isinstance(node, ast.Subscript) else node.args
            if isinstance(table, ast.Dict) and any(_is("unit", key) for key in keys):
                yield ast.unparse(node)


def _is(attribute: str, node: ast.expr) -> bool:
    return isinstance(node, ast.Attribute) and node.attr == attribute


def _is_text(node: ast.expr, constants: set[str]) -> bool:
    parts = node.elts if isinstance(node, ast.Tuple | ast.List | ast.Set) else [node]
    return any(
        (isinstance(part, ast.Constant) and isinstance(part.value, str))
        or (isinstance(part, ast.Name) and part.id in constants)
        for part in parts
    )


@pytest.mark.parametrize("room", ROOMS)
def test_no_general_room_decides_by_a_unit_or_the_name_of_a_parameter(room):
    found = {
        path.relative_to(ROOT).as_posix(): list(decisions(path.read_text()))
        for path in sorted(Path(ROOT, "ident", room).rglob("*.py"))
    }
    assert {path: where for path, where in found.items() if where and path not in _OTHERWISE} == {}


@pytest.mark.parametrize(
    "line",
    [
        'parameter.unit == "1/s"',
        'p.unit in ("s", "m")',
        'p.name == "phase"',
        '{"Pa": 1.0}.get(p.unit)',
        'ANGLE = "1"\nfound = p.unit == ANGLE',
    ],
)
def test_such_a_decision_would_be_found(line):
    assert list(decisions(line))


def test_what_an_effect_states_is_of_its_kind():
    """A phase is a plain number, a frequency 1/s, a time s, an end of the stroke 1/m, a top speed s/m."""
    units = {
        Starts.PHASE: "1",
        Starts.SPECTRAL_LINES: "1/s",
        Starts.STROKE_END: "1/m",
        Starts.TOP_SPEED: "s/m",
        Starts.STROKE_MIDDLE: "m",
        Starts.TIME: "s",
        Starts.FRICTION: "Pa",
        Starts.FRICTION_GRADIENT: "Pa/m",
        Starts.FINELY: "m",
        Starts.RESONANCE: "1/s",
        Starts.RELAXATION: "s",
    }
    any_unit = (Starts.ALONG_RANGE, Starts.AS_KNOWN)
    stated = [(p.start, p.unit) for e in CATALOGUE for p in e.parameters if p.start not in any_unit]
    assert {start for start, _ in stated} == units.keys()
    assert all(units[start] == unit for start, unit in stated)
    assert [e.name for e in EFFECTS if any(p.start is Starts.PHASE for p in e.shape)] == ["supply_ripple"]


def test_a_users_own_effect_states_where_its_search_begins():
    (frequency,) = read_effect(OWN, model="qian2014").shape
    assert (frequency.start, frequency.searched) == (Starts.SPECTRAL_LINES, True)
    held = {**OWN, "shape": {"fp": {"unit": "Hz", "lower": 1, "upper": 100, "value": 10}}}
    assert not read_effect(held, model="qian2014").shape[0].searched
    known = {**OWN, "shape": {"fp": {**OWN["shape"]["fp"], "start": "as known"}}}
    assert not read_effect(known, model="qian2014").shape[0].searched
    wrong = {**OWN, "shape": {"fp": {**OWN["shape"]["fp"], "start": "lines"}}}
    with pytest.raises(Unusable, match="spectral lines"):
        read_effect(wrong, model="qian2014")


def test_the_time_of_a_users_own_lag_begins_with_the_machines():
    lag = {
        "name": "slow",
        "place": "sensor",
        "equation": "y = lag(y, Ts)",
        "strength": {"symbol": "Ts", "unit": "ms", "lower": 0, "upper": 3},
    }
    assert read_effect(lag, model="qian2014").strength.start is Starts.TIME
