"""What only follows is advanced exactly, whatever its time constant; what is read or bent on its way is not."""

from __future__ import annotations

import numpy as np
import pytest

from ident.chain.exact_lags import with_exact_lags
from ident.presets import PRESETS, preset
from ident.run import Run
from ident.simulation.simulate import Simulation


@pytest.mark.parametrize("name", ["qian2014", "open_valve", "force_loop"])
def test_the_lag_of_a_valve_is_no_rate(name):
    chain = PRESETS[name].chain
    written = with_exact_lags(chain)
    assert set(chain.states) - set(written.states) == {"q1"}
    (lag,) = (equation for equation in written.equations if equation.target == "q1")
    assert lag.python == "lag(e, tau)"
    assert written.symbols == chain.symbols
    assert "dq" not in {equation.target for equation in written.equations}


@pytest.mark.parametrize("effects", [("valve_rate_limit",), ("spool_stiction",), ("dead_zone", "valve_rate_limit")])
def test_a_rate_that_an_effect_bends_stays_one(effects):
    chain = preset("qian2014", effects).chain
    assert with_exact_lags(chain) == chain


@pytest.mark.parametrize("name", ["first_order", "motor", "strano"])
def test_what_is_read_elsewhere_or_all_that_there_is_stays_a_rate(name):
    chain = PRESETS[name].chain
    assert with_exact_lags(chain) == chain


@pytest.mark.parametrize("hold", ["linear", "zoh"])
@pytest.mark.parametrize("samples", [3.0, 0.3, 0.003])
def test_a_valve_and_a_cylinder_answer_a_command_as_they_do_in_closed_form(hold, samples):
    """τ q' = u − q, x' = g q, of any time constant: of a step of 1 at t = 0, x = g (t − τ (1 − exp(−t/τ))).

    A drawn command comes up within the first sample; x is the mean of the steps that begin in it, each with its own
    delay s: ∫ x(t − s) ds over 0 ≤ s ≤ T.
    """
    rate, g = 1000.0, 0.02
    tau, t = samples / rate, np.arange(1, 400) / rate
    command = np.append(0.0, np.ones(400)) if hold == "linear" else np.ones(401)
    run = Run("step", "", rate, {"command": command, "displacement": command}, hold=hold)
    chain = PRESETS["open_valve"].chain
    # Without leak, friction and the oil's spring the cylinder integrates the flow: the mass is light, the oil stiff.
    values = dict.fromkeys(chain.symbols, 0.0)
    values |= {"Z0": g * 1e-6, "tau": tau, "A": 1e-3, "m0": 1.0, "c0": 1e4, "Ka": 1e-14}
    start = np.array([[[0.0, 0.0, 0.0, 0.0]]])
    at = {name: np.array([[value]]) for name, value in values.items() if name in chain.symbols}
    found = np.concatenate([rows for rows, _, _ in Simulation(chain, (run,), at, 8, start).outputs()])[:, 0, 0]

    def integral(t: np.ndarray) -> np.ndarray:
        """∫ x dt from 0, of a step at 0."""
        return g * (t**2 / 2 - tau * t + tau**2 * -np.expm1(-t / tau))

    stepped = g * (t - tau * -np.expm1(-t / tau))
    drawn = (integral(t) - np.where(t > 1 / rate, integral(t - 1 / rate), 0.0)) * rate
    wanted = drawn if hold == "linear" else stepped
    assert np.max(np.abs(found[1 : len(wanted) + 1] - wanted)) < 2e-3 * g * t[-1]
