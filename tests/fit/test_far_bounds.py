"""Bounds or values in a wrong unit are named as the likely cause of a fit that explains nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ident.fit.far_bounds import far_from
from ident.fit.settings import Settings
from ident.presets import preset
from ident.readers import read_matrix
from ident.workflows import identify
from tests.hidden_dead_zone import write
from tests.short_form import short_form

QUICK = {"population": 30, "generations": 5, "elite": 4}


@pytest.fixture(scope="module")
def matrix(tmp_path_factory):
    return read_matrix(write(tmp_path_factory.mktemp("far") / "matrix"))


@pytest.mark.parametrize(
    "known", short_form([True, False], True), ids=["bounds of the machine", "a machine of unknown size"]
)
def test_seconds_for_milliseconds_are_the_first_cause(matrix, known):
    """Beside the ranges that hold for this machine, and beside those that its runs give."""
    if not known:
        matrix = replace(matrix, actuator=replace(matrix.actuator, piston_area=None))
    fit = identify(matrix, Settings(bounds={"tau": (1.0, 6.0)}, options=QUICK))
    assert fit.error["fit"] > 0.8
    said = next(note for note in fit.notes if "ikely cause" in note)
    assert "the bounds given for tau are 1 s to 6 s, " in said
    assert "times the range of this machine (write 1 ms:6 ms if milliseconds were meant)" in said
    assert said.index("bounds given") < said.index("wrong sign")


def test_of_a_sound_fit_nothing_is_said(matrix):
    fit = identify(matrix, Settings(bounds={"tau": (1e-3, 6e-3)}, options=QUICK))
    assert not any("bounds given" in note for note in fit.notes)


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (Settings(bounds={"tau": (1.0, 6.0)}), "write 1 ms:6 ms if milliseconds were meant"),
        (Settings(fixed={"tau": 3.6}), "value given for tau is 3.6 s, 1500 times the range of this machine"),
        (Settings(bounds={"dead_zone": (0.0, 0.5)}, effects=("dead_zone",)), "write 0 mm:0.5 mm if millimetres"),
        (Settings(bounds={"Ka": (1e-7, 2e-7)}), "(without it "),
        (Settings(bounds={"tau": (1e-6, 6e-6)}), "tau are 1e-06 s to 6e-06 s, 1/1000 of the range"),
        (Settings(bounds={"m0": (3000.0, 6000.0)}), "write 3000 g:6000 g if grams were meant"),
    ],
)
def test_a_unit_that_fits_the_machine_is_proposed(settings, said):
    """Where one of the usual ones does; else the range that is searched where nothing is given."""
    (cause,) = far_from(settings, preset("qian2014", settings.effects), {})
    assert said in str(cause)


@pytest.mark.parametrize(
    "settings",
    [
        Settings(bounds={"tau": (1e-4, 1e-2)}),
        Settings(bounds={"tau": (5e-2, 1e-1)}),
        Settings(fixed={"m0": 20.0}),
        Settings(bounds={"tau": (1e-3, 1e3)}),
        Settings(bounds={"dead_zone": (0.0, 1e-3)}, effects=("dead_zone",)),
        Settings(fixed={"dead_zone": 0.0}, effects=("dead_zone",)),
        Settings(),
    ],
)
def test_what_a_user_may_well_want_is_no_cause(settings):
    """Somewhat elsewhere, wide enough to hold the machine's own range, or off."""
    assert not list(far_from(settings, preset("qian2014", settings.effects), {}))


def test_on_a_bench_too():
    (cause,) = far_from(Settings(model="kononykhin", fixed={"T": 20.0}), preset("kononykhin"), {})
    assert "the value given for T is 20 s, 1000 times the range of this machine (write 20 ms if milliseconds" in str(
        cause
    )
