"""A value of a wrong kind, given to a function of the library's face, is refused in one line that names it."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import ident
from ident.errors import Unusable
from ident.fit.choices import Choices
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.words.record_description import Stated
from tests.conftest import ROOT

FUNCTIONS = [name for name in ident.__all__ if inspect.isfunction(getattr(ident, name))]
SAMPLES: dict[str, Any] = {"str": "some text", "float": 5, "Mapping": {"some": 1}, "Sequence": ["some"], "bool": True}
"""A value of each kind, by the word that an annotation has where it is a right one."""
WITHIN = {
    "effects": [[5], 5, "dead_zone"],
    "custom": [[5], "some"],
    "bounds": [{"tau": 5}, {"tau": ("1 ms", object())}],
    "fixed": [{"tau": object()}, {5: 1.0}],
    "options": [{"population": "many"}, ["population"]],
    "seed": [1.5, "1", True],
    "budget": ["10 s"],
    "preprocessing": [{"force_sign": "no"}, ["force_sign"], {5: False}],
    "model": [5, ["qian2014"]],
    "method": [5],
    "load": [None],
}
"""Of the choices of a fit, some that are wrong inside."""
STATED = {
    "units": [5, "mm", ["mm"], {"command": 5}], "columns": [5, "x", {"command": []}], "sample_rate": [4096, []],
    "time": ["t", 5], "actuator": ["SW-1", 5], "specimen": ["1 kg", 5, {"mass": []}], "gain": [[], {}],
    "amplitude": [5, []], "kind": [5], "hold": [5, []], "output": [5, {}, [5]], "use": [5, []], "id": [[], {}],
    "skip_rows": ["two", 1.5], "dialect": ["semicolon", {"sign": ";"}], "rows": [5, "1:5", (1, "2")],
    "split": [0.3, [1, 2], {"validation": 5}], "trend": [5],
}  # fmt: skip


def wrong(function: str) -> Iterator[tuple[str, str, Any]]:
    """Each parameter of a function with values that its annotation does not allow."""
    for name, parameter in inspect.signature(getattr(ident, function)).parameters.items():
        if parameter.kind is inspect.Parameter.VAR_KEYWORD or parameter.annotation == "Any":
            continue
        said = str(parameter.annotation).replace("int", "float")
        yield function, name, object()
        yield from ((function, name, value) for kind, value in SAMPLES.items() if kind not in said)
        if parameter.default is inspect.Parameter.empty:
            yield function, name, None


CASES = [case for function in FUNCTIONS for case in wrong(function)]


@pytest.fixture(scope="module")
def matrix() -> Matrix:
    return ident.simulate(seconds=0.0625, small=True)


@pytest.fixture(scope="module")
def fit(matrix: Matrix) -> FitResult:
    truth = {"Z0": 2.592e-6, "tau": 3.6e-3, "Cl": 1e-11, "c0": 3200.0, "m0": 4.25, "Ka": 1.39e-13}
    return ident.identify(matrix, fixed=truth)


def refused(call: Any, name: str) -> str:
    """The one line with which a call is refused; it names the argument."""
    with pytest.raises(Unusable) as error:
        call()
    said = str(error.value)
    assert "\n" not in said
    assert len(said) < 400
    assert name in said, said
    return said


@pytest.mark.parametrize(("function", "name", "value"), CASES, ids=[f"{f} {n} {type(v).__name__}" for f, n, v in CASES])
def test_a_value_of_a_wrong_kind_is_refused_in_one_line(
    matrix: Matrix, fit: FitResult, function: str, name: str, value: Any
) -> None:
    """Each function × each parameter × values that are no such thing; all else that is given is right."""
    diagnosis = ident.load(ROOT / "tests" / "stored" / "diagnosis.json")
    right = {
        "matrix": matrix,
        "fit": fit,
        "result": fit,
        "found": diagnosis,
        "name": "time",
        "path": "matrix",
        "arrays": {"command": np.zeros(8), "displacement": np.zeros(8)},
        "table": {},
        "program": "qian",
    }
    called = getattr(ident, function)
    needed = {
        key: right[key]
        for key, parameter in inspect.signature(called).parameters.items()
        if parameter.default is inspect.Parameter.empty and parameter.kind is not inspect.Parameter.VAR_KEYWORD
    }
    said = refused(lambda: called(**{**needed, name: value}), name)
    assert function in said


def test_every_function_and_every_choice_is_tried() -> None:
    """So many functions and pairs of parameter and value; the choices of a fit and what is stated of a record too."""
    assert set(FUNCTIONS) >= {
        "read_matrix",
        "check",
        "identify",
        "compare",
        "diagnose",
        "propose",
        "simulate",
        "figure",
        "save",
        "load",
        "next_run",
    }
    assert len(CASES) > 150
    assert WITHIN.keys() == Choices.__annotations__.keys()
    assert STATED.keys() == Stated.__annotations__.keys()


@pytest.mark.parametrize(("name", "value"), [(n, v) for n, values in WITHIN.items() for v in values])
def test_a_choice_of_a_wrong_kind_is_refused_in_one_line(matrix: Matrix, name: str, value: Any) -> None:
    refused(lambda: ident.identify(matrix, **{name: value}), name)


@pytest.mark.parametrize(("name", "value"), [(n, v) for n, values in STATED.items() for v in values])
def test_what_is_stated_of_a_record_in_a_wrong_kind_is_refused_in_one_line(tmp_path, name: str, value: Any) -> None:
    (tmp_path / "run.csv").write_text("command,displacement\n" + "".join(f"{n % 7},{n % 5}\n" for n in range(64)))
    right = {"units": {"command": "mm", "displacement": "mm"}, "sample_rate": "1 kHz"}
    stated = {**right, name: value} if name != "time" else {"units": right["units"], name: value}
    with pytest.raises(Unusable) as error:
        ident.read_matrix(tmp_path / "run.csv", **stated)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(("figure", "option"), [
    ("time", "run"), ("time", "start"), ("time", "seconds"), ("time", "low"), ("bode", "kp"), ("bode", "amplitude"),
    ("bode", "specimen"), ("bode", "use"), ("bode", "axis"), ("bode", "candidate"), ("residual-map", "kp"),
    ("residual-curve", "view"), ("residual-correlation", "lags"), ("residual-correlation", "run"),
    ("sensitivity", "run"),
])  # fmt: skip
@pytest.mark.parametrize("value", [object(), [1], {"some": 1}], ids=["object", "list", "dict"])
def test_an_option_of_a_figure_of_a_wrong_kind_is_refused_in_one_line(fit, figure, option, value) -> None:
    refused(lambda: ident.figure(fit, figure, **{option: value}), option)


def test_what_counts_as_a_number_a_text_or_a_list_elsewhere_counts_here(matrix: Matrix) -> None:
    """Numbers of NumPy, tuples, sets, generators' lists and paths are no wrong kinds."""
    truth = {"tau": np.float64(3.6e-3), "m0": 4, "Z0": "2.592e-6 m^4/s", "Cl": 1e-11, "c0": 3200.0, "Ka": 1.39e-13}
    found = ident.identify(matrix, effects=("dead_zone",), fixed={**truth, "dead_zone.half_width": 0}, seed=np.int64(1))
    assert found.values["m0"] == 4.0
