"""Defects of the machine: stages, effects, holds, the kernel that integrates them."""

from tests.mutations.mutation import Mutation

_EQUATIONS = ("tests/acceptance/test_equations.py",)
_CONTRACT = "tests/effects/test_contract.py"


def _of(effect: str) -> tuple[str, ...]:
    """The test that holds one effect against the reference."""
    return (f"{_CONTRACT}::test_the_kernel_agrees_with_the_reference[{effect}]",)


MACHINE = (
    Mutation("valve-lag", "ident/stages/valve.py", "dq = (e - q1) / tau", "dq = (e - 1.01 * q1) / tau",
             "a factor of 1.01 in the pilot stage", _EQUATIONS),
    Mutation("leakage-sign", "ident/stages/pressure.py", "P' = (Q - L - A * v) / Ke", "P' = (Q + L - A * v) / Ke",
             "the sign of the leakage", _EQUATIONS),
    Mutation("specimen-mass", "ident/stages/load.py", "a = (D - R - f - S) / (m0 + mL)", "a = (D - R - f - S) / m0",
             "the specimen's mass dropped", _EQUATIONS),
    Mutation("measured-force", "ident/stages/load.py", '("S = fm"', '("S = -fm"',
             "the sign of the measured load", ("tests/fit/test_loads.py",)),
    Mutation("flow-gain", "ident/stages/flow.py", '"Q = Z0 / A * w",', '"Q = 1.01 * Z0 / A * w",',
             "a factor of 1.01 in the flow gain", _EQUATIONS),
    Mutation("play-width", "ident/stages/bench.py", "clip(wb__old, q - B, q + B)", "clip(wb__old, q - B, q + 1.01 * B)",
             "a factor of 1.01 in one bound of the play", ("tests/bench/test_model.py",)),
    Mutation("dead-zone", "ident/effects/dead_zone.py", "-h * (1 - a)", "-1.01 * h * (1 - a)",
             "a factor of 1.01 in one bound of the dead zone", _of("dead_zone")),
    Mutation("turbulent-damping", "ident/effects/quadratic_damping.py", "c2 * v * abs(v)", "c2 * v * v",
             "damping that drives the rod one way", _of("quadratic_damping")),
    Mutation("supply-droop", "ident/effects/supply_droop.py", "(abs(Q) - z) / T", "(Q - z) / T",
             "a fold: the supply would not notice flow the other way", _of("supply_droop")),
    Mutation("dry-friction", "ident/effects/coulomb_friction.py", "Ff = Ff + Fc", "Ff = Ff + 1.01 * Fc",
             "a factor of 1.01 in dry friction", _of("coulomb_friction")),
    Mutation("hold-of-the-recursion", "ident/simulation/recursion.py", 'if hold == "zoh":', 'if hold != "zoh":',
             "the two holds exchanged", _EQUATIONS),
    Mutation("hold-of-the-kernel", "ident/simulation/inputs.py", "[:] = samples[:, None]",
             "[:] = np.roll(samples, 1)[:, None]", "a held command late by a sample", _of("backlash")),
    Mutation("whole-step-of-a-filter", "ident/simulation/filters.py", "of_constant - 3 * of_ramp + 2 * of_parabola",
             "of_constant - 3 * of_ramp + of_parabola", "a term of the filter's gains", _of("sensor_lag")),
    Mutation("begun-late", "ident/simulation/inputs.py", "2 / delay - 1", "1 / delay - 1",
             "how a late command begins",
             (f"{_CONTRACT}::test_a_command_that_begins_with_a_jump_may_be_late_by_a_sample",)),
    Mutation("friction-of-the-bench", "ident/bench/response.py", "needed = friction + sign * load",
             "needed = 1.01 * friction + sign * load", "a factor of 1.01 in the bench's friction",
             ("tests/bench/test_model.py",)),
)  # fmt: skip
"""Defects of the machine."""
