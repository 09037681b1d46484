"""A case as a user writes it: units, matrices, shares, ground motion; and what cannot be used is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from ident.errors import Unusable
from ident.hybrid.case import BUILT_IN, benchmark2020, case_of, modal_damping, qian, read_case
from ident.hybrid.ground_motion import GRAVITY, GroundMotion, read_record
from ident.hybrid.scores import delay, peak, rms, scores
from ident.run import Specimen

ONE = {
    "structure": {"mass": "87.5 kg", "stiffness": "87.5 kN/m", "damping": "3.5 kN*s/m"},
    "physical": {"mass": "10 %", "stiffness": "17.5 kN/m"},
}


def test_a_case_of_one_storey():
    """Numbers with units; a share in per cent is one of the storey's own."""
    case = case_of({**ONE, "gain": 2, "delay": 2, "sample_rate": "2 kHz", "noise": {"displacement": "1 um"}})
    assert case.mass.tolist() == [[87.5]]
    assert case.stiffness.tolist() == [[87.5e3]]
    assert case.physical == Specimen(8.75, 17.5e3, 0.0)
    assert (case.gain, case.delay, case.sample_rate) == (2.0, 2, 2000.0)
    assert case.noise.displacement == pytest.approx(1e-6)
    assert case.numerical_mass[0, 0] == 78.75
    assert case.numerical_stiffness[0, 0] == 70e3


def test_the_built_in_cases_are_read_by_name():
    """The paper's structure, and four of the benchmark problem with their modal damping."""
    assert {name: read_case(name).storeys for name in BUILT_IN} == dict.fromkeys(BUILT_IN, 3) | {"qian": 1}
    assert read_case("qian").physical == qian().physical == Specimen(8.75, 17.5e3)
    for number, ratio, mass in ((1, 0.05, 1000), (2, 0.04, 1100), (3, 0.03, 1300), (4, 0.03, 1000)):
        case = benchmark2020(number)
        A = np.block([[np.zeros((3, 3)), np.eye(3)], [-case.stiffness / mass, -case.damping / mass]])
        poles = scipy.linalg.eigvals(A)
        assert np.allclose(-poles.real / np.abs(poles), ratio)


def test_matrices_in_every_form_are_the_same():
    """Rows with units, bare rows with one unit, and a diagonal; damping as a ratio of every mode."""
    rows = [["200 kN/m", "-100 kN/m"], ["-100 kN/m", "100 kN/m"]]
    data = {
        "structure": {"mass": ["1 t", "2000 kg"], "stiffness": rows, "damping": {"ratio": "5 %"}},
        "physical": {"stiffness": "20 kN/m", "storey": 2},
    }
    first = case_of(data)
    data["structure"] |= {
        "mass": {"matrix": [["1", "0"], ["0", "2"]], "unit": "t"},
        "stiffness": {"matrix": [["200", "-100"], ["-100", "100"]], "unit": "kN/m"},
    }
    second = case_of(data)
    for name in ("mass", "stiffness", "damping"):
        assert np.allclose(getattr(first, name), getattr(second, name))
    assert np.allclose(first.damping, modal_damping(first.mass, first.stiffness, 0.05))
    assert first.place == 1
    assert first.numerical_stiffness[1, 1] == pytest.approx(80e3)


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"structure": {"mass": "87.5", "stiffness": "1 N/m", "damping": "0 N*s/m"}}, "missing-unit"),
        ({"structure": {"mass": ["1 kg", "1 kg"], "stiffness": "1 N/m", "damping": "0 N*s/m"}}, "bad-case"),
        ({"physical": {"mass": "100 kg"}}, "bad-case"),
        ({"physical": {"mass": "1 kg", "storey": 2}}, "bad-case"),
        ({"physical": {"weight": "1 kg"}}, "unknown-key"),
        ({"delay": 0}, "bad-case"),
        ({"gain": 0}, "bad-case"),
        ({"ground": {"kind": "record"}}, "missing-field"),
        ({"ground": {"file": "x.txt", "unit": "mm"}}, "wrong-dimension"),
        ({"sample_rate": "1 s"}, "wrong-dimension"),
        ({"structure": {"mass": "87.5 kg", "stiffness": "-1 N/m", "damping": "0 N*s/m"}, "physical": {}}, "bad-case"),
    ],
)
def test_what_makes_no_case_is_refused(change, code):
    """Each in one line with its field."""
    with pytest.raises(Unusable) as found:
        case_of({**ONE, **change})
    assert found.value.code == code


def test_a_file_that_is_not_there_is_refused():
    """Neither a name nor a file."""
    with pytest.raises(Unusable, match="qian"):
        read_case("quian")


def test_a_record_is_read_with_its_unit_and_step(tmp_path):
    """Rows of several numbers behind a header, in g; straight lines between them at the sample rate of the loop."""
    file = tmp_path / "motion.at2"
    file.write_text("PEER, a station\nNPTS= 6, DT= .02 SEC\n 0.0 0.1 -.2\n 1.0E-1 0 0.\n")
    assert read_record(file).tolist() == [0.0, 0.1, -0.2, 0.1, 0.0, 0.0]
    (tmp_path / "case.yaml").write_text(
        "structure: {mass: 1 kg, stiffness: 1 N/m, damping: 0 N*s/m}\nphysical: {}\n"
        "ground: {file: motion.at2, unit: g, step: 0.02 s, scale: 0.5}\n"
    )
    found = read_case(tmp_path / "case.yaml").ground.samples(400.0)
    assert len(found) == 41
    assert found[8] == pytest.approx(0.05 * GRAVITY)
    assert found[12] == pytest.approx(-0.025 * GRAVITY)
    assert qian().with_ground(file).ground.samples(400.0)[16] == pytest.approx(-0.2 * GRAVITY)


def test_a_column_of_a_record_is_taken_alone(tmp_path):
    """Time beside acceleration: the column is named by its number."""
    file = tmp_path / "two.txt"
    file.write_text("0.00 0.1\n0.02 0.2\n0.04 0.3\n")
    assert read_record(file, 1).tolist() == [0.1, 0.2, 0.3]
    for broken in ("0 0.1\nword\n", "", "0 1\n2\n"):
        file.write_text(broken)
        with pytest.raises(Unusable):
            read_record(file, 1)


@pytest.mark.parametrize("motion", [GroundMotion("sine", frequency=600.0), GroundMotion(band=(0.0, 600.0))])
def test_a_motion_faster_than_the_loop_samples_is_refused(motion):
    """600 Hz at 1000 Hz would be shown as another frequency."""
    with pytest.raises(Unusable, match="cannot be sampled"):
        motion.samples(1000.0)


def test_noise_and_sine_have_the_size_that_was_asked_for():
    """The RMS of the noise within its band, the peak of the sine; one seed, one motion."""
    shaken = GroundMotion(duration=4.0, amplitude=2.0, band=(1.0, 20.0), seed=5)
    found = shaken.samples(1000.0)
    power, frequency = np.abs(np.fft.rfft(found)) ** 2, np.fft.rfftfreq(len(found), 1e-3)
    assert np.sqrt(np.mean(found**2)) == pytest.approx(2.0)
    assert power[(frequency < 0.99) | (frequency > 20.01)].sum() < 1e-12 * power.sum()
    assert np.array_equal(found, shaken.samples(1000.0))
    assert not np.array_equal(found, replace(shaken, seed=6).samples(1000.0))
    assert GroundMotion("sine", duration=2.0, amplitude=3.0, frequency=2.0).samples(1000.0).max() == pytest.approx(3.0)


def test_scores_say_what_they_compare():
    """A copy a little late and a little large, between samples; each score names two displacements."""
    rate, t = 1000.0, np.arange(4000) / 1000.0
    wanted = np.sin(2 * np.pi * t) + 0.3 * np.sin(2 * np.pi * 3.7 * t)
    late = np.sin(2 * np.pi * (t - 0.0123)) + 0.3 * np.sin(2 * np.pi * 3.7 * (t - 0.0123))
    assert delay(wanted, late, rate) == pytest.approx(0.0123, abs=1e-4)
    assert delay(late, wanted, rate) == pytest.approx(-0.0123, abs=1e-4)
    assert rms(1.1 * wanted, wanted) == pytest.approx(0.1)
    assert peak(1.1 * wanted, wanted) == pytest.approx(0.1)
    found = scores(1.1 * wanted, wanted, 0.5 * wanted, rate)
    assert found.tracking_rms == pytest.approx(0.1)
    assert found.reference_rms == pytest.approx(1.2)
    assert found.reference_peak == pytest.approx(1.2)
    assert found.numerical_rms == pytest.approx(1.0)
