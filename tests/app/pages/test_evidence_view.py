"""The figure on a card is one in which its effect can be seen."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.pages.evidence_view import evidence, telling_run
from ident.diagnosis.result import Ranked
from ident.plain import read
from schemas.matrix import RunView
from tests.app.pages.test_diagnosis_view import candidate, found

SHOWN = RunView.model_construct(id="r7", output="displacement")


@pytest.mark.parametrize(
    ("effect", "shown"),
    [
        ("backlash", ("residual-curve", "candidate=d%3Abacklash&view=play")),
        ("dead_zone", ("residual-curve", "candidate=d%3Adead_zone&view=spool")),
        ("lead", ("bode", "candidate=d%3Alead&run=r7")),
    ],
)
def test_a_curve_shows_the_effect_or_else_the_bode_plot_of_one_run(effect, shown):
    assert evidence(read(Ranked, candidate(effect, 0.01)), found(), None, SHOWN) == shown


def test_a_model_without_such_a_figure_shows_none():
    """A bench has no Bode plot of commands and no residual curve: a card there asked for one that was refused."""
    bench = replace(found(), found=replace(found().found, model="kononykhin"))
    for effect in ("command_delay", "spring_load", "dead_zone"):
        assert evidence(read(Ranked, candidate(effect, 0.01)), bench, None, SHOWN) is None


def test_where_what_a_run_shows_is_summed_up_its_bode_plot_does():
    """A specimen that is moved: the spring sums up the speed, and the curve was refused in red on the card."""
    moved = replace(found(), found=replace(found().found, model="specimen"))
    run = RunView.model_construct(id="first", output="force")
    shown = evidence(read(Ranked, candidate("coulomb_friction", 0.01)), moved, None, run)
    assert shown == ("bode", "candidate=d%3Acoulomb_friction&run=first")


def test_a_diagnosis_over_windows_shows_none():
    """Over a whole run a machine that integrates shows what disturbed it: the figure was refused in red."""
    windows = replace(found(), found=replace(found().found, horizon=0.8))
    assert evidence(read(Ranked, candidate("dead_zone", 0.01)), windows, None, SHOWN) is None


def test_the_telling_run_is_the_worst_of_the_smallest_amplitude():
    def run(name, amplitude):
        return RunView.model_construct(id=name, amplitude=amplitude)

    runs = [run("a", 1.0), run("b", 0.5), run("c", 0.5), run("d", None)]
    assert telling_run(runs, {"a": 0.9, "b": 0.1, "c": 0.2, "d": 0.8}).id == "c"
    assert telling_run([run("d", None)], {}).id == "d"
    assert telling_run([], {}) is None
