"""Dry friction whose limit depends on the speed and on what is filtered, against an integrator of its own."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ident.effects.effect import Effect
from ident.parameter import Parameter
from ident.presets import preset
from ident.run import Run
from ident.simulation.simulate import responses

MASS, VISCOUS, LIMIT, SLOPE, SLOW, TIME = 2.0, 8.0, 3.0, 1.5, 4.0, 0.05  # kg, N·s/m, N, N·s/m, N·s/m, s
RATE, SAMPLES = 200.0, 600


def warming(filtered: str) -> Effect:
    """A limit that rises with the speed at once, and with a filtered speed later."""
    slope = Parameter("slope", "b", "N*s/m", 0.0, 1e3, 0.0, "rise with the speed")
    shape = (
        Parameter("limit", "Fw", "N", 0.0, 1e3, LIMIT, "limit at rest"),
        Parameter("slow", "bs", "N*s/m", 0.0, 1e3, SLOW, "rise with the filtered speed"),
    )
    text = f"Ff = Ff + Fw + b * abs(v) + bs * {filtered}"
    return Effect("warming", "load", "a limit that rises", slope, (text,), shape=shape)


def reference(u: np.ndarray) -> np.ndarray:
    """The speed of a mass that never stops: its friction has the limit, against the motion."""
    t = np.arange(SAMPLES) / RATE

    def rates(time: float, state: np.ndarray) -> list[float]:
        v, z = state
        friction = LIMIT + SLOPE * abs(v) + SLOW * z
        return [(np.interp(time, t, u) - VISCOUS * v - friction) / MASS, (abs(v) - z) / TIME]

    return solve_ivp(rates, (0.0, t[-1]), [0.0, 0.0], t_eval=t, rtol=1e-9, atol=1e-12, max_step=0.5 / RATE).y[0]


@pytest.mark.parametrize(("filtered", "close"), [(f"lag(abs(v), {TIME})", 1e-3), (f"lag2(abs(v), {TIME}, 0.0)", 1e-3)])
def test_a_limit_that_depends_on_the_speed_and_on_a_filtered_speed_is_that_of_the_reference(filtered, close):
    u = 20.0 + 12.0 * np.sin(np.arange(SAMPLES) / RATE * 25.0)
    channels, units = {"command": u, "velocity": np.zeros_like(u)}, {"command": "N", "velocity": "m/s"}
    run = Run("run", "", RATE, channels, units, output="velocity")
    model = preset("drive").with_effects((warming(filtered),))
    known = {p.in_equations: p.value for p in model.parameters} | {"mL": 0.0, "k": 0.0, "cL": 0.0}
    known |= {"m0": MASS, "c0": VISCOUS, "k0": 0.0, "warming__slope": SLOPE}
    got = responses(model.chain, [run], {name: np.array([[value]]) for name, value in known.items()}, 2)[:, 0, 0]
    wanted = reference(u)
    assert wanted[1:].min() > 0.0
    assert np.std(got - wanted) < close * np.std(wanted)
