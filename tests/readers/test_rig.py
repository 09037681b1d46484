"""The limits of a rig: read from matrix.yaml, a profile or a file of their own, and held against peaks."""

from __future__ import annotations

import pytest

from ident.errors import Unusable
from ident.matrix import Actuator
from ident.plain import read, written
from ident.readers import read_matrix
from ident.readers.rig import read_rig, rig_in
from ident.rig.limits import RigLimits
from schemas.result import ActuatorStated

TEXT = """\
stroke: 6 in
speed: 500 mm/s
acceleration: 2 g
force: 10 kN
flow: 60 l/min
supply_pressure: 210 bar
"""
LIMITS = RigLimits(0.1524, 0.5, 19.6133, 1e4, 1e-3, 21e6)


def indented(text: str) -> str:
    """The text one level deeper, under its key."""
    return "rig:\n" + "".join(f"  {line}\n" for line in text.splitlines())


def close(found: RigLimits | None) -> bool:
    """Whether these are the limits of the text."""
    return found is not None and found.stated == pytest.approx(LIMITS.stated, rel=1e-12)


@pytest.mark.parametrize("text", [TEXT, indented(TEXT), "serial: A\n" + indented(TEXT)])
def test_a_file_holds_them_by_themselves_or_under_their_key(tmp_path, text):
    """So a matrix.yaml, a profile of the laboratory and a list of limits are all read."""
    (tmp_path / "lab.yaml").write_text(text)
    assert close(read_rig(tmp_path / "lab.yaml"))


@pytest.mark.parametrize("given", [indented(TEXT), "rig: lab.yaml\n"])
def test_a_matrix_states_them_or_names_the_profile_that_does(matrix, given):
    """The stroke of the rig counts before that of the actuator; what only the actuator states counts too."""
    matrix.text += given
    (matrix.path / "lab.yaml").write_text(indented(TEXT))
    assert close(read_matrix(matrix.write()).actuator.rig)


def test_the_actuators_own_sizes_stand_where_the_rig_states_none():
    """A rig may allow less of the stroke than the cylinder has."""
    own = Actuator("A", stroke=0.2, supply_pressure=7e6)
    assert own.rig_limits == RigLimits(stroke=0.2, supply_pressure=7e6)
    assert Actuator("A", stroke=0.2, rig=RigLimits(stroke=0.1)).rig_limits == RigLimits(stroke=0.1)


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("speed: 3", "missing-unit", "lab.yaml speed: 3 has no unit"),
        ("speed: 3 mm", "wrong-dimension", "lab.yaml speed"),
        ("flow: 0 l/min", "not-positive", "lab.yaml flow"),
        ("sped: 3 m/s", "unknown-key", "did you mean speed?"),
        ("rig: {}", "no-limits", "lab.yaml rig"),
        ("rig: 3 m/s", "not-a-mapping", "lab.yaml rig"),
    ],
)
def test_a_limit_that_cannot_be_read_is_named(text, code, words):
    with pytest.raises(Unusable) as refused:
        rig_in(text.encode(), "lab.yaml")
    assert refused.value.code == code
    assert words in str(refused.value)


def test_a_run_takes_a_share_of_each_limit_the_tightest_first():
    """Of the stroke a piston may go half from the middle; what has no peak is not judged."""
    of = RigLimits(stroke=0.1, speed=0.5, force=1e4)
    first, second = of.utilisation({"speed": 0.6, "stroke": 0.03})
    assert (first.limit, first.share, first.exceeded) == ("speed", pytest.approx(1.2), True)
    assert (second.limit, second.share, second.exceeded) == ("stroke", pytest.approx(0.6), False)
    assert of.unjudged({"speed": 0.6, "stroke": 0.03}) == ("force",)
    assert of.utilisation({"speed": float("nan")})[0].exceeded


def test_a_result_keeps_them_with_the_actuator():
    """As written, read again, and as the service sends it; an actuator without them is written as before."""
    data = written(Actuator("A", rig=LIMITS))
    assert read(Actuator, data).rig == LIMITS
    assert ActuatorStated(**data).rig.model_dump() == LIMITS.stated
    assert "rig" not in written(Actuator("A"))
