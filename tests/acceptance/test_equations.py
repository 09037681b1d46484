"""The program's chain is the paper's: eqs. (10)-(15), eq. (20), and what the independent reference computes."""

from __future__ import annotations

import ast
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from ident.chain.chain import Chain
from ident.equations.equation import Equation
from ident.presets import PRESETS
from ident.simulation.intersample_command import ends
from ident.simulation.recursion import discretise, respond
from tests.reference import qian_reference as reference

CHAIN = PRESETS["qian2014"].chain
INCH = 0.0254
POUND = 4.4482216152605  # N
PSI = POUND / INCH**2
MACHINES = 50  # drawn
EXACT = 1e-12  # relative
BAND = (0.1, 500.0)  # Hz


def values_of(plant: reference.Plant, cell: reference.Cell) -> dict[str, float]:
    """The reference's plant and cell under the program's names."""
    conditions = {"A": plant.A, "mL": cell.mass, "k": cell.stiffness, "cL": cell.damping, "Kp": cell.gain}
    return {name: getattr(plant, name) for name in reference.PARAMETERS} | conditions


def closed_form(v: dict[str, float]) -> tuple[Fraction, list[Fraction]]:
    """Numerator and p1 … p5 of eqs. (10)-(15), in exact arithmetic."""
    f = {name: Fraction(value) for name, value in v.items()}
    m, c, k = f["m0"] + f["mL"], f["c0"] + f["cL"], f["k"]
    Z0, tau, Cl, Ka, A, Kp = f["Z0"], f["tau"], f["Cl"], f["Ka"], f["A"], f["Kp"]
    return Z0 * Kp, [
        Ka * tau * m,
        Ka * tau * c + tau * Cl * m + Ka * m,
        Ka * tau * k + tau * Cl * c + Ka * c + A**2 * tau + m * Cl,
        tau * Cl * k + Ka * k + A**2 + Cl * c,
        Z0 * Kp + Cl * k,
    ]


def of_the_chain(chain: Chain, v: dict[str, float]) -> tuple[list[Fraction], list[Fraction]]:
    """Numerator and denominator of C (sI − A)⁻¹ B, leading coefficient 1, by Leverrier's recursion without rounding."""
    model = chain.linearise(v)
    n = len(model.B)
    A = [[Fraction(float(entry)) for entry in row] for row in model.A]
    B, C = ([Fraction(float(entry)) for entry in vector] for vector in (model.B, model.C))
    denominator, numerator = [Fraction(1)], []
    adjugate = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
    for order in range(1, n + 1):
        numerator.append(sum(C[i] * adjugate[i][j] * B[j] for i in range(n) for j in range(n)))
        product = [[sum(A[i][m] * adjugate[m][j] for m in range(n)) for j in range(n)] for i in range(n)]
        denominator.append(-sum(product[i][i] for i in range(n)) / order)
        adjugate = [[product[i][j] + denominator[-1] * int(i == j) for j in range(n)] for i in range(n)]
    return numerator, denominator


def random_cases(count: int) -> list[dict[str, float]]:
    """Parameters in the bounds of Table 2 with random specimens and gains."""
    rng = np.random.default_rng(7)
    cases = []
    for _ in range(count):
        plant = reference.Plant(**{name: rng.uniform(*reference.BOUNDS[name]) for name in reference.PARAMETERS})
        cell = reference.Cell(*(rng.uniform(0, top) for top in (3, 7e4, 500)), gain=rng.uniform(1, 10))
        cases.append(values_of(plant, cell))
    return cases


def test_the_linearised_chain_has_the_coefficients_of_equations_10_to_15():
    """Each coefficient of its transfer function equals the closed form to 1e-12 relative, at 50 random machines."""
    for v in random_cases(MACHINES):
        gain, p = closed_form(v)
        numerator, denominator = of_the_chain(CHAIN, v)
        assert [float(entry) for entry in numerator[:3]] == [0, 0, 0]
        assert float(abs(numerator[3] * p[0] / gain - 1)) < EXACT
        for ours, theirs in zip(denominator, p, strict=True):
            assert float(abs(ours * p[0] / theirs - 1)) < EXACT


def test_the_frequency_response_is_that_of_equation_10():
    """From 0.1 to 500 Hz the response equals the closed form to 1e-12 of its magnitude, at 50 random machines."""
    frequency = np.geomspace(*BAND, 200)
    s = 2j * np.pi * frequency
    for v in random_cases(MACHINES):
        gain, p = closed_form(v)
        expected = float(gain) / np.polyval([float(entry) for entry in p], s)
        found = CHAIN.linearise(v).frequency_response(frequency)
        assert np.max(np.abs(found - expected) / np.abs(expected)) < EXACT


def test_equation_20_is_reproduced_in_inches_and_pounds():
    """Table 4 at Kp = 2 with m and k from the printed p1 and p5: 12.44, and p2, p4 within 1 % of print."""
    plant = reference.Plant()
    p1, p2, p4, p5 = 2.129e-8, 1.181e-5, 0.703, 13.98  # as printed, in⁴·s⁻¹ and so on
    mass = p1 * INCH**4 / (plant.Ka * plant.tau)
    stiffness = (p5 * INCH**4 - 2 * plant.Z0) / plant.Cl
    assert mass == pytest.approx(17.7, rel=0.01)
    assert stiffness == pytest.approx(64e3, rel=0.01)

    cell = reference.Cell(mass - plant.m0, stiffness, damping=400.0, gain=2.0)
    numerator, denominator = of_the_chain(CHAIN, values_of(plant, cell))
    imperial = p1 / float(denominator[0])
    assert float(numerator[3]) * imperial == pytest.approx(12.44, rel=2e-3)
    found = [float(entry) * imperial for entry in denominator]
    assert found[1] == pytest.approx(p2, rel=0.01)
    assert found[3] == pytest.approx(p4, rel=0.01)
    assert found[2] == pytest.approx(4.15e-3, rel=0.01), "the s² term that the print has lost"


def test_the_literal_unit_of_Z0_would_be_unstable_where_the_paper_tested():
    """At Kp = 10 the chain is stable with 2.592e-6 m⁴/s and unstable with 1.48e-5."""
    cell = reference.Cell(0.0, 0.0, 0.0, gain=10.0)
    for Z0, stable in ((2.592e-6, True), (1.48e-5, False)):
        poles = np.linalg.eigvals(CHAIN.linearise(values_of(reference.Plant(Z0=Z0), cell)).A)
        assert bool(poles.real.max() < 0) is stable


# ------------------------------------------------------------------------- against the integrated reference

CELL = reference.Cell(0.98, 67.6e3, 150.0, 7.0)
TOLERANCE = 1e-6  # of the output's standard deviation


def deviation(chain: Chain, hold: str) -> float:
    """How far the program's simulation is from the reference's, over the output's standard deviation."""
    plant = reference.Plant()
    command = reference.band_limited_noise(4096, 1e-3, np.random.default_rng(11))
    expected = reference.simulate(plant, CELL, command, hold)
    batch = {name: np.array([value]) for name, value in values_of(plant, CELL).items()}
    found = respond(discretise(chain.linearise(batch), reference.SAMPLE_RATE, hold), ends(command))[0]
    return float(np.std(found - expected) / np.std(expected))


def test_the_simulation_agrees_with_the_reference(hold):
    """The exact recursion and the integrated equations give one output to 1e-6, command straight or held."""
    assert deviation(CHAIN, hold) < TOLERANCE


def test_the_two_holds_differ(hold):
    """Taking one hold for the other is seen: the comparison is not blind to it."""
    plant, other = reference.Plant(), {"linear": "zoh", "zoh": "linear"}[hold]
    command = reference.band_limited_noise(4096, 1e-3, np.random.default_rng(11))
    one, two = (reference.simulate(plant, CELL, command, kind) for kind in (hold, other))
    assert np.std(one - two) > 100 * TOLERANCE * np.std(one)


class OnePercentMore(ast.NodeTransformer):
    """Multiplies the n-th name of an expression by 1.01."""

    def __init__(self, wanted: int) -> None:
        self.wanted, self.seen = wanted, -1

    def visit_Name(self, node: ast.Name) -> ast.expr:
        self.seen += 1
        return ast.BinOp(ast.Constant(1.01), ast.Mult(), node) if self.seen == self.wanted else node


def changed(equation: Equation, wanted: int) -> Equation:
    """The equation with its n-th name taken 1 % too large."""
    left, _, right = equation.text.partition("=")
    tree = OnePercentMore(wanted).visit(ast.parse(right.strip(), mode="eval"))
    return Equation(f"{left}= {ast.unparse(ast.fix_missing_locations(tree))}", equation.place, equation.meaning)


def in_order(equation: Equation) -> list[str]:
    """The names of an equation as they are visited."""
    visitor = OnePercentMore(-1)
    names = []
    visitor.visit_Name = lambda node: (names.append(node.id), node)[1]  # type: ignore[method-assign]
    visitor.visit(ast.parse(equation.python, mode="eval"))
    return names


SILENT = {"f", "Ff", "M", "aB"}  # dry friction, which a linear chain has none of, and a base, which stands still
SHOWN = {equation.target for equation in CHAIN.needed("displacement")}
MUTATIONS = [
    (equation, wanted)
    for stage in CHAIN.stages
    for equation in stage.equations
    if (equation.target in SHOWN or equation.is_rate) and equation.target not in SILENT
    for wanted, name in enumerate(in_order(equation))
    if name not in SILENT
]


@pytest.mark.parametrize(("equation", "wanted"), MUTATIONS, ids=lambda entry: getattr(entry, "text", str(entry)))
def test_a_coefficient_that_is_one_percent_off_is_found(equation, wanted):
    """Whichever term of whichever equation of the chain is 1 % wrong, the comparison with the reference fails."""
    stages = tuple(
        replace(stage, equations=tuple(changed(e, wanted) if e is equation else e for e in stage.equations))
        for stage in CHAIN.stages
    )
    assert deviation(Chain(stages, CHAIN.outputs), "linear") > TOLERANCE
