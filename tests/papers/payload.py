"""Qian et al. 2014, section 1: a magnetorheological damper as the payload of a hybrid simulation, from its record."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import scipy.integrate

from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.linear_plant import linear_plant
from ident.hybrid.loop_shaping import design
from ident.hybrid.machine import machine
from ident.hybrid.scores import rms
from ident.hybrid.specimen_effects import reference_of
from ident.readers import read_matrix
from ident.run import Specimen
from ident.workflows import identify
from tests.hybrid.cases import fitted, of_qian
from tests.papers.row import Measured, Row

RECORD = Path(__file__).resolve().parents[3] / "shared" / "data" / "mr_damper"
RATE = 4096.0


@cache
def damper() -> FitResult:
    """The fit of the measured record: mass, viscous friction, and a force that yields."""
    return identify(read_matrix(RECORD), Settings(model="specimen", effects=("specimen_hysteresis",), seed=1))


def payload() -> tuple[Measured, ...]:
    fit, actuator = damper(), fitted()
    of = fit.values
    held = {name: of[name] for name in of if name.startswith("specimen_hysteresis")}
    case = of_qian(3.0, physical=Specimen(of["mS"], 0.0, of["cS"]))
    ground = case.ground.samples(RATE)
    times = np.arange(len(ground)) / RATE
    fy, way = held["specimen_hysteresis.force"], held["specimen_hysteresis.yield_displacement"]

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, v, z = state
        a = -np.interp(t, times, ground) - (3.5e3 * v + 87.5e3 * x + fy * z) / 87.5
        return [v, a, v / way * (1 - abs(z) * (0.5 + 0.5 * np.sign(v * z)))]

    truth = scipy.integrate.solve_ivp(
        rates, (0, times[-1]), [0, 0, 0], t_eval=times, rtol=1e-8, atol=1e-12, max_step=2 / RATE
    ).y[0]
    plant = linear_plant(actuator, case.physical, case.gain, case.piston_area)
    both = design(plant.model, RATE, structure="two-degree").controller
    runs = [simulate_hybrid(actuator, case, one, held).scores for one in (None, both)]
    return (
        Measured("error of the damper's model, fitted and held back", 100 * (fit.error["fit"] or np.nan), "%", 20.0),
        Measured("and", 100 * (fit.error["verify"] or np.nan), "%", 20.0),
        Measured(
            "the structure with it from SciPy",
            100 * rms(reference_of(machine(actuator, case, held), case, ground), truth),
            "%",
            0.05,
        ),
        Measured("hybrid simulation without a controller", 100 * (runs[0].reference_rms if runs[0] else np.nan), "%"),
        Measured("with two degrees of freedom", 100 * (runs[1].reference_rms if runs[1] else np.nan), "%", 2.0),
    )


ROWS = (
    Row(
        "Q33",
        "sections 1 and 3",
        "a magnetorheological damper as payload, from its public record",
        "usually MR dampers",
        "the record; own least squares of 17 and 18 %; SciPy",
        payload,
        long=True,
    ),
)
