"""Defects that a regression has to find: equations of each stage, three effects, eq. (17), the hold."""

from tests.mutations.mutation import Mutation

_TEST = "tests/app/test_unchanged.py::test_an_approved_fit_is_found_again"


def _of(case: str) -> tuple[str, ...]:
    """The recheck of one approved fit."""
    return (f"{_TEST}[{case}]",)


_LINEAR = _of("linear")

REGRESS = (
    Mutation("regress-controller", "ident/stages/controller.py", '("e = Kp * (r - y_in)", "proportional position',
             '("e = 1.01 * Kp * (r - y_in)", "proportional position', "a factor of 1.01 in the gain", _LINEAR),
    Mutation("regress-valve", "ident/stages/valve.py", "dq = (e - q1) / tau", "dq = (e - 1.01 * q1) / tau",
             "a factor of 1.01 in the pilot stage", _LINEAR),
    Mutation("regress-flow", "ident/stages/flow.py", '"Q = Z0 / A * w",', '"Q = -Z0 / A * w",',
             "the sign of the flow", _LINEAR),
    Mutation("regress-leakage", "ident/stages/pressure.py", '("L = Cl * P", "laminar', '("L = -Cl * P", "laminar',
             "the sign of the leakage", _LINEAR),
    Mutation("regress-piston", "ident/stages/pressure.py", "P' = (Q - L - A * v) / Ke", "P' = (Q - A * v) / Ke",
             "the leakage dropped", _LINEAR),
    Mutation("regress-force", "ident/stages/pressure.py", '("D = A * P", "the load', '("D = 1.01 * A * P", "the load',
             "a factor of 1.01 in the piston's force", _LINEAR),
    Mutation("regress-load", "ident/stages/load.py", "a = (D - R - f - S) / (m0 + mL)", "a = (D - R - f - S) / m0",
             "the specimen's mass dropped", _LINEAR),
    Mutation("regress-sensor", "ident/stages/sensor.py", '("y = y_fb", "the record shows',
             '("y = 1.01 * y_fb", "the record shows',
             "a factor of 1.01 in the reading", _LINEAR),
    Mutation("regress-dead-zone", "ident/effects/dead_zone.py", "-h * (1 - a)", "-1.01 * h * (1 - a)",
             "a factor of 1.01 in one bound of the dead zone", _of("dead_zone")),
    Mutation("regress-friction", "ident/effects/coulomb_friction.py", "Ff = Ff + Fc", "Ff = Ff + 1.01 * Fc",
             "a factor of 1.01 in dry friction", _of("coulomb_friction")),
    Mutation("regress-damping", "ident/effects/quadratic_damping.py", "c2 * v * abs(v)", "1.01 * c2 * v * abs(v)",
             "a factor of 1.01 in turbulent damping", _of("quadratic_damping")),
    Mutation("regress-eq-17", "ident/comparison/compare.py",
             "return bounded(float(np.std(self.residual) / np.std(self.run.measured)))",
             "return bounded(float(1.01 * np.std(self.residual) / np.std(self.run.measured)))",
             "a factor of 1.01 in eq. (17)", _LINEAR),
    Mutation("regress-hold", "ident/simulation/recursion.py", 'if hold == "zoh":', 'if hold != "zoh":',
             "the two holds exchanged", _of("held")),
    Mutation("regress-ramp", "ident/simulation/recursion.py", "[powers[:, 0] - powers[:, 1], powers[:, 1]]",
             "[powers[:, 0], powers[:, 1]]",
             "a term of the ramp dropped", _LINEAR),
)  # fmt: skip
"""Each is put into a copy; the recheck of an approved fit has to say that something moved."""
