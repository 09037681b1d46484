"""What a program asks for: the papers' runs as `simulate` has them, and every combination of lists of one's own."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from ident.errors import Unusable
from ident.planning.plan import Plan, plan
from ident.planning.programs import Settings, program_of, qian_program
from ident.rig.limits import RigLimits
from ident.run import Specimen
from ident.synthesis.bench_matrix import plans as bench_records
from ident.synthesis.matrix import plans as matrix_runs


def test_the_program_of_qian_is_the_matrix_that_simulate_plays():
    """63 runs to fit and 21 to verify, under the same ids, specimens, gains and amplitudes."""
    program = qian_program(Settings(seconds=1.0))
    asked = [(run.id, run.specimen, run.gain, run.use, run.signal.amplitude) for run in program.runs]
    assert asked == [(p.id, p.specimen, p.gain, p.use, pytest.approx(0.0254 * p.inches)) for p in matrix_runs()]
    assert len({run.signal.seed for run in program.runs}) == 84


def test_the_program_of_kononykhin_is_the_set_that_simulate_plays():
    """Without a fit and with the paper's stroke; nothing of it is judged by the command alone."""
    made = plan("kononykhin", rig=RigLimits(stroke=0.1, speed=0.2))
    assert [run.id for run in made.runs] == [p.id for p in bench_records(0.1)]
    assert made.unjudged == ("stroke", "speed")
    assert all(run.share is None for run in made.runs)


def test_levels_are_beyond_the_dead_space_found_so_far():
    """No amplitude and no level is within 1.5 times of it, and the laws are about the zero shift."""
    levels = [p for p in bench_records(0.1, offset=0.01, dead_space=0.1) if p.kind == "speed-levels"]
    assert [p.settings[1] for p in levels] == pytest.approx([0.15, 0.25, 0.5, 0.75, 1.0])
    assert {p.settings[0] for p in levels} == {0.01}


def test_a_program_of_ones_own_is_every_combination():
    """Each list counts; verify gains only verify; a kind may have a frequency of its own."""
    program = program_of(
        {
            "gains": [5, "7.5"],
            "verify": {"gains": [6]},
            "amplitudes": ["1 mm", "0.1 in"],
            "specimens": [{"mass": "0.87 kg"}],
            "kinds": ["blwn", {"kind": "sine", "frequency": "5 Hz"}, "sweep"],
            "sample_rate": "1000 Hz",
            "seconds": "2 s",
            "band": "40 Hz",
            "ramp": "0.5 s",
        },
        Settings(),
    )
    assert Counter((run.gain, run.use) for run in program.runs) == {(5, "fit"): 6, (7.5, "fit"): 6, (6, "verify"): 6}
    assert {run.specimen for run in program.runs} == {Specimen(mass=0.87)}
    frequencies = {(run.signal.kind, run.signal.frequency) for run in program.runs}
    assert frequencies == {("blwn", 40), ("sine", 5), ("sweep", 40)}
    signal = program.runs[0].signal
    command = signal.command()
    assert (len(command), signal.ramp) == (2000, 0.25)
    assert np.sqrt(np.mean(command**2)) == pytest.approx(1e-3)
    assert abs(command[[0, -1]]).max() < 1e-12


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"amplitudes": []}, "not-a-list"),
        ({"amplitudes": ["3"]}, "missing-unit"),
        ({"amplitudes": ["0 mm"]}, "not-positive"),
        ({"gains": [-1]}, "bad-gain"),
        ({"kinds": ["noise"]}, "unknown-kind"),
        ({"kinds": [{"kind": "sine", "frequency": "3 kHz"}]}, "out-of-range"),
        ({"gain": 5}, "unknown-key"),
        ({"ramp": "20 s"}, "bad-value"),
        ({"gains": [1] * 1001}, "too-large"),
    ],
)
def test_what_cannot_be_a_program_is_refused(change, code):
    with pytest.raises(Unusable) as refused:
        program_of({"amplitudes": ["1 mm"], **change}, Settings(seconds=1.0))
    assert refused.value.code == code


def test_a_plan_is_read_as_it_was_written():
    """Plain data holds all of it: the service makes the files again from what it keeps."""
    for program in ({"amplitudes": ["0.1 mm"], "seconds": "1 s"}, "kononykhin"):
        made = plan(program, rig=RigLimits(stroke=0.1))
        assert Plan.from_json(made.to_json()) == made
