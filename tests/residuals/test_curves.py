"""The effect's own characteristic can be read off the curve of the right place."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from ident.comparison.compare import compare
from ident.effects.backlash import BACKLASH
from ident.errors import Unusable
from ident.figures import figure
from ident.fit.settings import Settings
from ident.presets import preset
from ident.residuals.curves import curves
from ident.residuals.decimation import Response
from ident.residuals.traces import traces
from ident.residuals.views import VIEWS, injected, showing, view_of
from ident.workflows import identify, study
from tests.fit.test_windows import cylinder
from tests.residuals.conftest import HIDDEN, TRUE, compared
from tests.short_form import short_form

PLACES = {
    "dead_zone": "spool",
    "coulomb_friction": "friction",
    "pressure_flow": "pressure-flow",
    "quadratic_damping": "friction",
    "gain_asymmetry": "spool",
    "backlash": "play",
}
LEAST = {"backlash": 0.8}
"""Of the residual's power: play is memory, of which a curve against the speed of the spool shows only the ends."""


@cache
def best(name):
    found = curves(compared(name))
    return found[0], np.array(found[0].x), np.array(found[0].y)


@pytest.mark.parametrize("name", short_form(PLACES, "dead_zone", "coulomb_friction"))
def test_the_curve_at_the_place_of_the_effect_explains_most(name):
    """And it takes nearly all of the residual's power but the noise's."""
    curve, _, _ = best(name)
    assert curve.name == PLACES[name]
    assert curve.explained > LEAST.get(name, 0.85)


def test_a_dead_zone_is_a_step_of_its_half_width_against_the_drive_signal():
    """Outside the zone the opening is short by h, inside by all there is."""
    _, x, y = best("dead_zone")
    outside = np.abs(x) > 2.5 * HIDDEN["dead_zone"]
    inner = outside & (np.abs(x) < 0.02)
    assert y[inner] == pytest.approx(-np.sign(x[inner]) * HIDDEN["dead_zone"], rel=0.15)


def test_backlash_is_a_step_of_its_half_width_against_the_speed_of_the_spool():
    """Behind by b whichever way the spool goes; its card shows this curve."""
    _, x, y = best("backlash")
    inner = slice(2, -2)
    moving = np.abs(x[inner]) > 0.05 * np.abs(x).max()
    assert y[inner][moving] == pytest.approx(-np.sign(x[inner][moving]) * HIDDEN["backlash"], rel=0.15)
    shown = view_of(BACKLASH, preset("qian2014"))
    assert shown is not None
    assert shown.name == "play"


def test_dry_friction_is_a_step_of_its_force_at_zero_velocity():
    """Plus and minus Fc, whatever the speed."""
    _, x, y = best("coulomb_friction")
    inner = slice(3, -3)
    assert y[inner] == pytest.approx(np.sign(x[inner]) * HIDDEN["coulomb_friction"], rel=0.2)


@pytest.mark.full
def test_flow_falls_with_the_pressure_against_it_as_the_root_says():
    """sqrt(1 − r P) − 1 along the flow, but for a constant that is the valve's gain."""
    _, x, y = best("pressure_flow")
    inner = slice(4, -2)
    wanted = np.sqrt(1 - HIDDEN["pressure_flow"] * x) - 1
    slope = np.polyfit(x[inner], y[inner], 1)[0] / np.polyfit(x[inner], wanted[inner], 1)[0]
    assert slope == pytest.approx(1.0, rel=0.15)


@pytest.mark.full
def test_turbulent_damping_curves_upwards_with_the_square_of_speed():
    """The curve less a straight line follows v|v| less a straight line, with the right coefficient."""
    curve, x, y = best("quadratic_damping")
    inner = slice(1, -1)
    A = np.column_stack([x * np.abs(x), x])[inner]
    assert np.linalg.lstsq(A, y[inner], rcond=None)[0][0] == pytest.approx(HIDDEN["quadratic_damping"], rel=0.2)
    assert curve.y_unit == "N"


@pytest.mark.full
def test_an_asymmetric_gain_is_a_v():
    """Both directions gain opening of one sign: a |w|."""
    _, x, y = best("gain_asymmetry")
    inner = np.abs(x) > 1e-3
    assert y[inner] == pytest.approx(HIDDEN["gain_asymmetry"] * np.abs(x[inner]), rel=0.2)


def test_noise_alone_shows_no_curve():
    """Nothing is explained where nothing is missing."""
    assert all(curve.explained < 0.03 for curve in curves(compared("dead_zone", 0.0)))


def test_the_right_candidate_predicts_the_curve_that_is_seen():
    """The second model's curve lies on the first one's residual; a wrong candidate's does not."""
    base = compared("coulomb_friction")
    held = TRUE | {"coulomb_friction": HIDDEN["coulomb_friction"]}
    right = compare(base.matrix, identify(base.matrix, Settings(effects=("coulomb_friction",), fixed=held)))
    seen, said = curves(base)[0], curves(base, right)[0]
    assert said.name == seen.name == "friction"
    assert said.y == pytest.approx(seen.y, abs=0.1 * max(seen.y))


def test_what_is_added_to_the_drive_acts_like_the_command():
    """The response to an addition before the valve is that to the command over Kp."""
    base = compared("dead_zone")
    run = base.runs[0].run
    model = base.runs[0].linear
    chain = showing(preset("qian2014").core, ("e",))
    known = TRUE | {"Kp": run.Kp, "mL": run.specimen.mass, "k": run.specimen.stiffness, "cL": 0.0, "A": 4.97e-4}
    values = {name: np.array([known[name]]) for name in chain.symbols}
    step = np.ones((200, 1))
    added = Response.of([injected(chain, "e").linearise(values)], 500.0).to(step)[:, 0, 0]
    commanded = Response.of([model], 500.0).to(step)[:, 0, 0]
    assert run.Kp * added == pytest.approx(commanded, rel=1e-6, abs=1e-9)


def test_a_model_whose_effect_is_off_moves_inside_as_the_linear_one():
    """The compiled kernel's drive signal is the linear core's."""
    base = compared("coulomb_friction")
    off = Settings(effects=("coulomb_friction",), fixed=TRUE | {"coulomb_friction": 0.0})
    same = compare(base.matrix, identify(base.matrix, off))
    for linear, compiled in zip(traces(base, ("w",)).runs, traces(same, ("w",)).runs, strict=True):
        w = linear.signals["w"]
        assert np.std((compiled.signals["w"] - w)[8:]) < 0.005 * np.std(w)


def test_an_unknown_curve_is_refused_with_those_there_are():
    """The remedy names every view."""
    base = compared("dead_zone")
    with pytest.raises(Unusable, match="no curve 'thermal'") as refused:
        figure("residual-curve", study(base.matrix, base.fit), view="thermal")
    assert all(view.name in refused.value.remedy for view in VIEWS[:3])


@pytest.mark.parametrize(("view", "heading"), [("w(x)/w", "w(x)/w: explains"), ("spool", "Spool: explains")])
def test_symbols_keep_their_case_in_a_heading(view, heading):
    """A drive signal w is not its upper case."""
    base = compared("dead_zone")
    drawn = figure("residual-curve", study(base.matrix, base.fit), view=view)
    assert f'"{heading}' in drawn.to_json()


def test_of_a_machine_that_integrates_no_curve_over_whole_runs_is_drawn():
    """It is said so, not that the fit of this very matrix were unstable."""
    matrix = cylinder(2, wander=1e-3)
    fit = identify(matrix, Settings(model="motor"))
    with pytest.raises(Unusable, match="sums up what acts on it"):
        traces(compare(matrix, fit), ())
