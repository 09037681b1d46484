"""The actuator of a bench as C, MAT and FMU: against the kernel, and against an independent actuator in one file."""

from __future__ import annotations

import io
import zipfile
from dataclasses import replace

import numpy as np
import pytest
import scipy.io

from ident.errors import Unusable
from ident.export import as_fmu, as_header, exported
from ident.export.blocks import as_blocks
from ident.fit.result import Estimate, FitResult
from ident.matrix import Actuator
from ident.presets import preset
from ident.run import Run, Specimen
from ident.simulation.simulate import responses
from ident.stages.bench import FRACTIONS, node_names
from tests.export.machines import compiled, compiler, fitted, largest_error, unit_of_control
from tests.reference.kononykhin_reference import STROKE, Truth, _advance

RATE = 1000.0
TRUTH = Truth(B=0.4, I0=1.2, nonlinearity=0.0)
"""Of straight lines: there the table of the model is the reference's characteristic."""


def of_bench(truth: Truth = TRUTH, *effects: str) -> FitResult:
    """A fit whose values are those of the reference, SI."""
    model = preset("kononykhin", effects)
    values = {"T": truth.T, "B": truth.B / 100, "I0": truth.I0 / 100, "kp": truth.kp * 1e8, "dPfr": truth.dPfr * 1e6}
    speeds = truth.speed(100 * np.array([*FRACTIONS, *(-one for one in FRACTIONS)])) / 1000
    values |= dict(zip(node_names(), speeds.tolist(), strict=True))
    values |= {p.name: p.upper / 5 for p in model.parameters if "." in p.name}
    given = {p.name: Estimate(values[p.name], p.unit, 0.0, p.lower, p.upper, False) for p in model.parameters}
    actuator = Actuator("B-1", supply_pressure=truth.Ps * 1e6)
    return replace(fitted(), model="kononykhin", effects=effects, parameters=given, settings={}, actuator=actuator)


def current() -> np.ndarray:
    """Two sines of 5 and 20 % of the rated current from rest, and a rest at the end."""
    t = np.arange(4000) / RATE
    return (0.05 * np.sin(4 * np.pi * t) + 0.2 * np.sin(np.pi * t)) * (t < 3.5)


def reference(u: np.ndarray, truth: Truth = TRUTH) -> tuple[np.ndarray, np.ndarray]:
    """Position from the start (m) and pressure difference (Pa) of the flat file, the current held, the play centred."""
    state = np.array([0.0, 0.0, 0.5 * STROKE, 0.0, 0.0, 0.0])
    out = np.empty((2, len(u)))
    for k, value in enumerate(100 * u):
        out[:, k] = (state[2] - 0.5 * STROKE) / 1000, 1e6 * state[3]
        _advance(
            state,
            value,
            value,
            1 / RATE,
            truth.T,
            truth.B,
            truth.I0,
            truth.kp,
            truth.dPfr,
            truth.Ps,
            truth.G,
            truth.asymmetry,
            0.0,
            0.0,
            0.0,
            0.0,
            64,
        )
    return out[0], out[1]


@pytest.mark.parametrize("effects", [(), ("command_delay", "spring_load")])
def test_the_header_of_a_bench_answers_as_kernel_and_reference_do(effects, tmp_path):
    """To 1e-9 of the kernel, in standard deviations; to 1e-5 of an actuator that other rules simulate."""
    machine, u = exported(of_bench(TRUTH, *effects), sample_rate=RATE), current()
    found = compiled(machine, u, tmp_path)
    values = {name: np.array([[value]]) for name, value in machine.values.items()}
    for place, channel in enumerate(machine.outputs):
        run = Run("run", "", RATE, {"command": u, "current": u, channel: u}, output=channel, hold="zoh")
        kernel = responses(machine.chain, [run], values, machine.steps)[:, 0, 0]
        assert largest_error(found[:, place], kernel) <= 1e-9
    if not effects:
        position, _ = reference(u)
        assert largest_error(found[:, machine.outputs.index("displacement")], position) <= 1e-5


def test_the_code_of_a_control_unit_is_small_and_takes_no_memory(tmp_path):
    """Code, tables and state together below 64 kB; nothing but the mathematical library is called."""
    (tmp_path / "machine.h").write_text(as_header(exported(of_bench(), sample_rate=RATE)))
    calls = (
        "void step(double u, double *y) { servoident_step(&m, u, y); }\nvoid reset(void) { servoident_reset(&m); }\n"
    )
    size, called = unit_of_control(f'#include "machine.h"\nstatic servoident_machine m;\n{calls}', tmp_path)
    assert size < 64 * 1024
    assert called <= {"sqrt", "memset", "memcpy", "fmod"}


def test_the_mat_file_of_a_bench_holds_its_blocks():
    """Constants, and the characteristic as a look-up table that rises through zero."""
    held = scipy.io.loadmat(io.BytesIO(as_blocks(exported(of_bench(), sample_rate=RATE))), squeeze_me=True)
    assert (held["T"], held["B"], held["Ts"]) == pytest.approx((0.02, 0.004, 1e-3))
    assert held["Speeds"] == pytest.approx(TRUTH.speed(100 * held["Currents"]) / 1000)
    assert np.all(np.diff(held["Speeds"]) > 0)


def test_the_unit_of_a_bench_is_written():
    """As FMI 2 with its sources."""
    compiler()
    assert (
        "modelDescription.xml" in zipfile.ZipFile(io.BytesIO(as_fmu(exported(of_bench(), sample_rate=RATE)))).namelist()
    )


@pytest.mark.parametrize(
    ("given", "code"),
    [
        ({"gain": 2.0}, "no-export"),
        ({"specimen": Specimen(mass=1.0)}, "no-export"),
        ({"specimen": Specimen(stiffness=1e5)}, "not-stated"),
    ],
)
def test_what_an_actuator_of_a_bench_has_not_is_refused(given, code):
    with pytest.raises(Unusable) as refused:
        exported(of_bench(), **given)
    assert refused.value.code == code
