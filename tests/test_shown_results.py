"""Every result of the library shows itself: to ``print``, at the prompt and in a notebook, by one builder of tables."""

from __future__ import annotations

import inspect
import json
import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

import ident
from ident.bench.analysis import Analysis
from ident.bench.position_loop import AmplitudeMargin, PositionLoop, Regulator
from ident.comparison.profile import Profile
from ident.comparison.side_by_side import of_fits
from ident.design.experiment import Experiment
from ident.diagnosis.result import Diagnosis
from ident.hybrid.changed_machine import Change
from ident.hybrid.controller import no_controller
from ident.hybrid.controller_design import design_controller
from ident.hybrid.coupled_simulation import machines_of, simulate_coupled
from ident.hybrid.coupled_stability import delay_map
from ident.hybrid.feedforward_tracking import FeedforwardTracking
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.share_map import share_map
from ident.hybrid.tracked_run import track
from ident.hybrid.what_if import what_if
from ident.matrix import Actuator
from ident.residuals.survey import survey
from ident.run import Specimen
from ident.words.result_tables import MOST_ROWS, Listing, TabularResult, html, text
from tests.hybrid.cases import fitted, of_qian
from tests.hybrid.coupled_cases import beam as several

LONGEST = 8000
"""Characters that a result may print, two screens: the fields of a matrix of 27 runs are more than 20,000."""
LIBRARY = Path(ident.__file__).parent
STORED = Path(__file__).parent / "stored" / "diagnosis.json"


@cache
def results() -> dict[str, TabularResult]:
    """One of each kind, by the name of its class."""
    matrix = ident.simulate(seconds=0.25, small=True)
    fit = ident.identify(matrix, fixed={"tau": "3.6 ms"}, seed=1, options={"population": 20, "generations": 4})
    compared = ident.compare(matrix, fit)
    found, case, machine = survey(compared), of_qian(0.5), fitted()
    of_area = fitted_of_an_area()
    curve = tuple(0.1 * k for k in range(600))
    many = (
        matrix,
        matrix.runs[0],
        ident.check(matrix),
        fit,
        compared,
        compared.runs[0],
        found,
        found.budget,
        Diagnosis.from_json(json.loads(STORED.read_text())),
        of_fits([fit, fit]),
        track(matrix.runs[0]),
        Experiment(
            specimen=Specimen(2.0),
            gain=7.0,
            amplitude=1e-3,
            signal="blwn",
            frequency=30.0,
            seconds=4.0,
            sample_rate=4096.0,
            separation=3.0,
            std_errors={"Z0": 0.5},
        ),
        Profile("tau", "s", (1e-3, 2e-3), (0.1, 0.2), (0.0, 9.0), 1e-3, None),
        what_if(of_area, Change(specimen=Specimen(5.0)), (2.0, 3.0)),
        simulate_hybrid(machine, case),
        share_map(machine, case, masses=[0.0, 0.5], stiffnesses=[0.0, 0.9]),
        (beam := simulate_coupled((machine, machine), several(0.25)[0], [no_controller(4096.0)] * 2)),
        delay_map(machines_of((machine, machine), beam.case), beam.case, [no_controller(4096.0)] * 2, (1, 2)),
        design_controller(machine, Specimen(8.75, 17.5e3), sample_rate=4096.0, gain=2.0, piston_area=497e-6, delay=1),
        FeedforwardTracking(gain=20.0, limit=40.0, draws=0, feedback_rms=1e-3, both_rms=1e-4, drawn_feedback_rms=None,
                 drawn_both_rms=None, drawn_ratio=None, t=curve, reference=curve, feedback=curve, both=curve,
                 low=curve, high=curve),
        PositionLoop("kononykhin", Regulator(100.0), 0.003, (AmplitudeMargin(0.05, 0.1, -5.0, False, text="at 5 %"),),
                     None, None, "stable"),
        Analysis(notes=("a note",)), ident.plan({"gains": [5.0], "amplitudes": ["1 mm"]}),
    )  # fmt: skip
    return {type(one).__name__: one for one in many if one is not None}


def fitted_of_an_area():
    """The same machine with the area that a change of it is measured by."""
    return replace(fitted(), actuator=Actuator("A", piston_area=497e-6, stroke=0.1))


def kinds() -> list[str]:
    """Every class of the library that shows itself, by its source."""
    found = [re.findall(r"^class (\w+)\(.*\bTabularResult\)", path.read_text(), re.M) for path in LIBRARY.rglob("*.py")]
    return sorted(name for names in found for name in names)


def test_each_kind_of_result_is_tried_here():
    assert kinds() == sorted(results())


@pytest.mark.parametrize("kind", kinds())
def test_print_and_prompt_show_the_tables_of_a_notebook_and_no_arrays(kind):
    result = results()[kind]
    listed = list(result.listings())
    assert repr(result) == str(result) == f"{result}" == text(listed)
    assert result._repr_html_() == html(result.listings())
    for one in listed:
        for cell in (one,) if isinstance(one, str) else (*one.header, *(c for row in one.rows for c in row)):
            assert cell in str(result)
    assert 10 < len(str(result)) < LONGEST
    assert "array(" not in str(result)
    assert f"{kind}(" not in str(result)


def test_what_the_functions_of_the_face_give_shows_itself():
    """Their annotations name it, so that no result of the face is left out; a chart shows itself in another way."""
    gives = {
        name: inspect.signature(getattr(ident, name)).return_annotation for name in ident.__all__ if name.islower()
    }
    named = {part.strip() for given in gives.values() for part in str(given).split("|")}
    assert named - {"AltairChart", "None"} <= set(kinds())


def test_a_long_table_shows_its_ends_and_counts_what_lies_between():
    shown = Listing("T", ("run", "error"), [(f"r{k}", f"{k} %") for k in range(MOST_ROWS + 5)], ("error",)).text()
    lines = shown.splitlines()
    assert (lines[:3], lines[-1]) == (["T", "run  error", "r0     0 %"], "r64   64 %")
    assert "… 5 more rows …" in lines
    assert len(lines) == MOST_ROWS + 3


def test_a_result_without_tables_is_refused_by_its_name():
    class Bare(TabularResult):
        """Nothing is registered for it."""

    with pytest.raises(NotImplementedError, match="Bare"):
        print(Bare())
