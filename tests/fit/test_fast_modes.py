"""A mode too fast for the finest step is said: beyond 12.8 radians a sample, 32 steps are longer than 0.4 each."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify
from tests.reference import measured_load_reference as reference
from tests.reference.qian_reference import Plant

PLANT, GAIN = Plant(), 7.0


def fastest() -> float:
    """The fastest mode without specimen, 1/s, of a valve that follows at once: its lag asks for no steps."""
    system = reference.system(PLANT, GAIN)[:4, :4]
    lag = int(np.flatnonzero(np.isclose(np.diag(system), -1.0 / PLANT.tau))[0])
    rest = np.arange(4) != lag
    reduced = system[np.ix_(rest, rest)] + np.outer(system[rest, lag], system[lag, rest]) * PLANT.tau
    return float(np.abs(np.linalg.eigvals(reduced)).max())


FASTEST = fastest()


def notes(radians: float, searched: bool) -> list[str]:
    """What a fit says of fast modes where the fastest one goes so far in a sample."""
    command = 1e-3 * np.sin(np.arange(200) ** 2 / 400)
    channels = {"command": command, "displacement": 0.9 * command}
    run = Run("run", "", FASTEST / radians, channels, gain=GAIN)
    fixed = {name: getattr(PLANT, name) for name in ("Z0", "tau", "Cl", "c0", "m0", "Ka")}
    given = {} if searched else {"coulomb_friction": 10.0}
    options = {"generations": 2, "population": 10, "elite": 2}
    settings = Settings(effects=("coulomb_friction",), fixed={**fixed, **given}, options=options)
    found = identify(Matrix(Actuator("A", piston_area=PLANT.A), (run,)), settings)
    return [note for note in found.notes if "radians per sample" in note]


@pytest.mark.parametrize(("radians", "said"), [(12.0, False), (13.5, True), (40.0, True)])
def test_a_mode_that_is_cut_is_said(radians, said):
    """Also where nothing is searched: the model itself is then followed roughly."""
    found = notes(radians, searched=False)
    assert len(found) == said
    if said:
        assert f"{radians:.3g} radians per sample" in found[0]


def test_vectors_of_the_search_that_are_cut_are_counted():
    """Two generations of ten, all of one machine but for its friction."""
    found = notes(13.5, searched=True)
    assert len(found) == 2
    assert found[0].startswith("20 candidate models had dynamics that are too fast")
