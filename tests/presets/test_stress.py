"""A coupon or a foam is tested by its strain and its stress: the force for each area has the unit of a pressure."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import ident
from ident.errors import Unusable
from ident.readers.column_names import channel_of
from ident.readers.description import describe
from ident.readers.limits import LIMITS

MODULUS, VISCOSITY = 2.0e6, 3.0e4  # Pa, Pa*s: Kelvin and Voigt's solid, as of a foam


def coupon(folder: Path, unit: str, scale: float) -> Path:
    """A folder with a record of stress = E strain + eta (rate of strain); strains of some percent for 40 s."""
    t = np.arange(4000) / 100
    rates = (0.31, 0.83, 1.7)
    strain = sum(0.02 / w * np.sin(w * t) for w in rates)
    rate = sum(0.02 * np.cos(w * t) for w in rates)
    stress = MODULUS * strain + VISCOSITY * rate + np.random.default_rng(1).normal(0, 20, len(t))
    folder.mkdir(exist_ok=True)
    np.savetxt(
        folder / "a.csv", np.column_stack([100 * strain, stress / scale]), delimiter=",", header="e,s", comments=""
    )
    (folder / "matrix.yaml").write_text(f"""
actuator: {{serial: FOAM}}
runs:
  - id: a
    file: a.csv
    sample_rate: 100 Hz
    output: force
    channels: {{displacement: {{column: e, unit: '%'}}, force: {{column: s, unit: {unit}}}}}
""")
    return folder


@pytest.mark.parametrize(("unit", "scale"), [("kPa", 1e3), ("MPa", 1e6), ("N/mm^2", 1e6)])
def test_a_stress_is_the_answer_of_a_specimen_and_its_stiffness_is_a_modulus(tmp_path, unit, scale):
    fit = ident.identify(ident.read_matrix(coupon(tmp_path / "m", unit, scale)))
    assert fit.model == "specimen"
    by_name = fit.parameters
    assert (by_name["kS"].unit, by_name["cS"].unit) == ("Pa", "Pa*s")
    assert by_name["kS"].value == pytest.approx(MODULUS, rel=2e-3)
    assert by_name["cS"].value == pytest.approx(VISCOSITY, rel=2e-3)


CYLINDER = """
actuator: {serial: A}
runs:
  - {id: only, file: a.csv, sample_rate: 10 Hz, channels: {command: {column: 0, unit: V},
     displacement: {column: 1, unit: mm}, force: {column: 2, unit: bar}}}
"""


def test_a_stress_that_is_no_output_is_refused_with_what_it_may_be():
    with pytest.raises(Unusable, match="load_pressure") as refused:
        describe(CYLINDER.encode(), LIMITS)
    assert refused.value.code == "stress"


def test_a_column_in_bar_is_not_taken_for_a_force():
    """A pressure is measured in the same unit: only who records a stress can say so."""
    assert channel_of("Actual", "bar") == ""
    assert channel_of("Actual", "kN") == "force"
