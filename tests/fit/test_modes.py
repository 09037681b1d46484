"""A fit is one that a simulation can follow: no mode ends far within a sample, unless the user looks there."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.identification import Identification
from ident.fit.modes import FOLLOWED, extreme, fastest
from ident.fit.settings import Settings
from ident.matrix import Actuator
from ident.presets import preset
from ident.run import Run, Specimen
from ident.workflows import diagnose, identify
from tests.blind.any_machine import Lab


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_what_a_search_finds_is_followed_by_the_diagnosis():
    """A loop with a dead zone, nothing stated: the oil's compliance went to nothing, 500 radians a sample."""
    matrix = Lab.drawn(317, hidden=True).measured()
    fit = identify(matrix, Settings(model="qian2014"))
    found = diagnose(matrix, fit, most=0, propose=False)
    assert found.ladder[0].error["fit"] == pytest.approx(fit.error["fit"], rel=1e-4)


@pytest.mark.full
def test_a_mode_that_nothing_follows_is_looked_for_only_where_the_user_says_so():
    matrix = Lab.drawn(317, hidden=True).measured()
    free = Identification(matrix, Settings(model="qian2014")).objective
    points = np.random.default_rng(1).uniform(size=(200, len(free.space.axes)))
    values = free.space.values(points)
    modes = fastest(free.preset.chain, extreme(free.runs), matrix.actuator, values)
    lost = np.abs(modes) > FOLLOWED
    assert lost.any()
    assert not lost.all()
    assert np.all(free.errors(points)[lost] >= 1e3)
    assert not np.isfinite(free.exact(points[lost][0]).error)
    assert not np.isfinite(free.approximate(points[lost][0]).error)
    held = Identification(matrix, Settings(model="qian2014", fixed={"tau": 1e-9})).objective
    assert not held.space.followed


def test_modes_of_runs_are_those_of_the_fastest_of_them_by_its_own_sample_rate():
    """Of a loop with other masses, gains, outputs and clocks beside each other, each alone by its eigenvalues.

    The valve's lag, which is advanced exactly, asks for no steps: as if q = Kp (r − y).
    """
    chain = preset("qian2014").chain
    cells = [(0.5, 3.0, "displacement", 4096.0), (20.0, 9.0, "displacement", 1024.0), (2.0, 6.0, "load_pressure", 1e3)]
    quiet = {"command": np.zeros(4), "displacement": np.zeros(4), "load_pressure": np.zeros(4)}
    runs = [
        Run(f"r{i}", "", rate, quiet, specimen=Specimen(mass=m), gain=gain, output=output)
        for i, (m, gain, output, rate) in enumerate(cells)
    ]
    actuator = Actuator("A", piston_area=5e-4)
    Z0, tau, Cl, c0, m0, Ka = 2.6e-6, np.array([3.6e-3, 1.2e-3]), 1e-11, 3200.0, 4.25, 1.4e-13
    values = {
        name: np.broadcast_to(value, 2)
        for name, value in {"Z0": Z0, "tau": tau, "Cl": Cl, "c0": c0, "m0": m0, "Ka": Ka}.items()
    }
    alone = []
    for m, gain, _, rate in cells:
        jacobian = [[-Cl / Ka, -5e-4 / Ka, -gain * Z0 / 5e-4 / Ka], [5e-4 / (m0 + m), -c0 / (m0 + m), 0], [0, 1, 0]]
        alone.append(np.broadcast_to(np.abs(np.linalg.eigvals(np.array(jacobian))).max() / rate, tau.shape))
    assert np.abs(fastest(chain, runs, actuator, values)) == pytest.approx(np.max(alone, axis=0), rel=1e-6)
    assert np.abs(fastest(chain, runs[:2], actuator, values)) == pytest.approx(np.max(alone[:2], axis=0), rel=1e-6)


def test_the_speed_of_a_record_is_that_within_the_band_that_is_asked_for():
    """A sine of 2 Hz: ω a/√2 within 5 Hz, nothing within 1 Hz, whichever was asked first."""
    x = 1e-3 * np.sin(2 * np.pi * 2.0 * np.arange(1000) / 500.0)
    run = Run("a", "", 500.0, {"command": x, "displacement": x})
    for _ in range(2):
        assert run.speed_within(2 * np.pi * 5.0) == pytest.approx(2 * np.pi * 2.0 * 1e-3 / np.sqrt(2), rel=1e-6)
        assert run.speed_within(2 * np.pi * 1.0) < 1e-9
