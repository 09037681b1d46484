"""Several actuators on one structure, judged by a loop that is written out plainly."""

from __future__ import annotations

import numpy as np
import pytest

from ident.errors import Unusable
from ident.hybrid.case import case_of
from ident.hybrid.compensation import Compensation
from ident.hybrid.controller import no_controller
from ident.hybrid.coupled_reading import coupled_of
from ident.hybrid.coupled_simulation import machines_of, simulate_coupled
from ident.hybrid.coupled_stability import coupled_critical_delay, delay_map
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.linear_plant import linear_plant
from ident.hybrid.loop_shaping import design
from tests.hybrid.cases import fitted
from tests.hybrid.coupled_cases import FAST, GROUND, beam, table
from tests.reference import coupled_reference as reference

TWO = fitted(), fitted(**FAST)
NONE = no_controller(4096.0)


@pytest.mark.parametrize("joined", [False, True], ids=["apart", "joined"])
def test_two_actuators_on_a_beam_are_those_of_the_flat_reference(joined):
    """Wanted and measured displacements within 1e-4 of their deviations, forces within 1e-3; poles alike."""
    case, loop = beam(joined=joined)
    found = simulate_coupled(TWO, case, (NONE, NONE))
    assert_alike(found, loop)
    assert found.first.radius == pytest.approx(reference.radius(loop, 4096.0), abs=1e-7)


def test_a_table_on_three_actuators_is_that_of_the_flat_reference():
    """Places that are combinations of heave, pitch and roll, joined by the inertia of the table."""
    case, loop = table()
    found = simulate_coupled((fitted(),) * 3, case, (NONE,) * 3)
    assert_alike(found, loop)
    whole = loop._replace(Ms=0 * loop.Ms, Cs=0 * loop.Cs, Ks=0 * loop.Ks)
    d, _, _ = reference.simulate(whole, found.first.ground, 4096.0)
    for p, one in enumerate(found.parts.values()):
        assert np.std(one.reference - d[:, p]) < 1e-7 * np.std(d[:, p])


def assert_alike(found, loop):
    """The records of every part against the reference."""
    d, x, f = reference.simulate(loop, found.first.ground, 4096.0)
    for p, one in enumerate(found.parts.values()):
        for shown, truth, within in (
            (one.numerical, d[:, p], 1e-4),
            (one.measured, x[:, p], 1e-4),
            (one.force, f[:, p], 1e-3),
        ):
            assert np.std(shown - truth) < within * np.std(truth)


@pytest.mark.full
def test_the_critical_delay_of_coupled_parts_is_that_of_the_determinant():
    """Within 1 %, of parts apart and joined, by Newton's method for both unknowns."""
    for joined in (False, True):
        case, loop = beam(joined=joined, ratio=0.01)
        assert coupled_critical_delay(case) == pytest.approx(reference.critical_delay(loop), rel=1e-4)


def test_the_map_over_the_delays_is_that_of_the_flat_reference():
    """Each pair of delays of a lightly damped beam, by the poles of the reference."""
    case, loop = beam(ratio=0.02, gains=(20.0, 16.0))
    delays = [1, 12, 24, 36]
    found = delay_map(machines_of(TWO, case), case, (NONE, NONE), delays)
    truth = [[reference.radius(loop._replace(delays=(a, b)), 4096.0) for b in delays] for a in delays]
    assert np.allclose(found.radius, truth, atol=1e-7)
    assert 0 < found.stable.sum() < found.stable.size


def test_one_part_is_a_case_of_one_actuator():
    """A list of one part gives what the mapping gives, to the last bit."""
    structure = {"mass": "87.5 kg", "stiffness": "87.5 kN/m", "damping": "3.5 kN*s/m"}
    physical = {"mass": "10 %", "stiffness": "17.5 kN/m"}
    data = {"structure": structure, "gain": 5, "piston_area": "497 mm^2", "ground": GROUND | {"duration": "0.5 s"}}
    alone = simulate_hybrid(fitted(), case_of({**data, "physical": physical}))
    several = simulate_coupled((fitted(),), coupled_of({**data, "physical": [physical]}, None, "one"), (NONE,))
    for name in ("numerical", "measured", "force", "reference"):
        assert np.array_equal(getattr(several.first, name), getattr(alone, name)), name
    assert several.first.radius == alone.radius


def test_actuators_of_other_equations_and_controllers_run_beside_each_other():
    """A fifth of a spring behind a lag, and Qian's machine with friction under live estimates: as bit by bit alone.

    Where the structure does not join them, nothing does.
    """
    data = {
        "structure": {
            "mass": ["87.5 kg", "87.5 kg"],
            "stiffness": ["87.5 kN/m", "87.5 kN/m"],
            "damping": ["3.5 kN*s/m", "3.5 kN*s/m"],
        },
        "physical": [{"storey": 1, "mass": "8 kg", "stiffness": "17 kN/m"}, {"storey": 2, "stiffness": "17 kN/m"}],
        "gain": 5,
        "piston_area": "497 mm^2",
        "ground": GROUND | {"duration": "0.5 s"},
    }
    case, slow = coupled_of(data, None, "two"), fitted("first_order", gain=1.0, tau=0.02)
    on = {"dead_zone.half_width": 1e-5}
    found = simulate_coupled((fitted(), slow), case, (Compensation(4096.0), NONE), {})
    alone = [
        simulate_hybrid(fit, one, acting)
        for fit, one, acting in zip((fitted(), slow), case.cases, (Compensation(4096.0), NONE), strict=True)
    ]
    for one, single in zip(found.parts.values(), alone, strict=True):
        assert np.std(one.measured - single.measured) < 1e-9 * np.std(single.measured)
    assert simulate_coupled((fitted(), fitted()), case, (NONE, NONE), on).first.radius is None


def test_two_degrees_of_freedom_bring_both_actuators_to_the_reference():
    """Each controller designed for its part alone: at most 1 % off the reference, and the whole is stable."""
    case, _ = beam(2.0, joined=False, delays=(1, 1))
    controllers = []
    for fit, part in zip(TWO, case.cases, strict=True):
        plant = linear_plant(fit, part.physical, part.gain, part.piston_area)
        controllers.append(design(plant.model, part.sample_rate, structure="two-degree").controller)
    found = simulate_coupled(TWO, case, controllers)
    assert found.stable
    assert all(one.scores.reference_rms <= 0.01 for one in found.parts.values())
    assert found.scores.reference_rms == max(one.scores.reference_rms for one in found.parts.values())


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"physical": []}, "no part"),
        ({"physical": [{"storey": 1}, {"storey": 1}]}, "not independent"),
        ({"physical": [{"storey": 1, "name": "a"}, {"storey": 2, "name": "a"}]}, "1 names"),
        ({"physical": [{"place": [1]}]}, "one number for each"),
        ({"physical": [{"storey": 1, "mass": "100 kg"}]}, "part 1.*no mass is left"),
        ({"physical": [{"storey": 3}]}, "part 1.*storey 3"),
        ({"specimen": {"stiffness": ["0 N/m", "5 N/m"]}}, "where no part moves it"),
        ({"specimen": {"stiffness": "5 N/m"}}, "1 rows"),
        ({"specimen": {}, "physical": [{"storey": 1, "mass": "1 kg"}]}, "stated twice"),
    ],
)
def test_what_makes_no_case_of_several_parts_is_refused(change, where):
    """Each in one line that names the part or the field."""
    structure = {"mass": ["9 kg", "9 kg"], "stiffness": ["9 kN/m", "9 kN/m"], "damping": ["1 N*s/m", "1 N*s/m"]}
    with pytest.raises(Unusable, match=where):
        coupled_of({"structure": structure, "physical": [{"storey": 1}], **change}, None, "two")


def test_the_inertia_of_a_specimen_needs_machines_with_forces():
    """A machine that moves whatever it takes feels no mass."""
    case, _ = table(0.1)
    with pytest.raises(Unusable, match="no force"):
        simulate_coupled((fitted("first_order"),) * 3, case, (NONE,) * 3)


def test_a_loop_that_one_gain_makes_unstable_is_told_that_gain():
    """Alone it brings a gain margin of 3 dB, by the poles of the reference.

    At 3 dB more than the remedy the flat loop is stable, at 5 dB more it is not.
    """
    case, loop = beam(0.1, gains=(60.0, 16.0), delays=(1, 1))
    judged = simulate_coupled(TWO, case, (NONE, NONE)).first.stability
    first = judged.remedies[0]
    assert (judged.state, first.name) == ("unstable", "left.Kp")
    assert "left.Kp" in judged.text[-1]
    assert judged.mode.frequency == pytest.approx(50.8, rel=0.01)
    radii = [
        reference.radius(loop._replace(Kp=(60.0 * first.factor * 10 ** (level / 20), 16.0)), 4096.0)
        for level in (0.0, 3.0, 5.0)
    ]
    assert radii[0] < 1.0
    assert radii[1] < 1.0
    assert radii[2] > 1.0
