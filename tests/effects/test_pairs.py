"""Every two effects of the catalogue at once against the independent reference: what one makes of the other."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from ident.chain.conditions import conditions
from ident.effects import EFFECTS
from ident.matrix import Actuator
from ident.parallel import each
from ident.presets import preset
from ident.run import Run, Specimen
from ident.simulation.simulate import responses
from tests.effects.test_contract import CELLS, PLANT, command, strength
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear
from tests.reference.plain_cases import CASES

Pairs = list[tuple[str, str]]
PAIRS: Pairs = [(first.name, second.name) for first, second in combinations(EFFECTS, 2)]
SOME = 8  # every which pair in the short form: each effect is in several
SHARE = 0.4  # of the strength at which one effect is compared: two of full strength may leave little of the machine
STEPS = 8  # a sample
SAMPLES = 1024  # a quarter of a second, in which every effect acts
BOTH = 2.0  # times what the effect of the two may miss that may miss more
FAR = {
    frozenset(("specimen_joint", "specimen_hysteresis")): 3e-3,  # yields with the speed of half a step before
    # The lead makes kicks of a held command's jumps: a step long here, of no length there.
    frozenset(("lead", "valve_rate_limit")): 0.2,
    frozenset(("lead", "command_delay")): 2e-3,
    frozenset(("lead", "backlash")): 5e-4,
}


def deviations(cell: linear.Cell, number: int, hold: str, pairs: Pairs) -> dict[frozenset[str], float]:
    """For each pair the kernel of the whole catalogue against the reference, over the output's deviation."""
    u, model = command(number)[:SAMPLES], preset("qian2014", tuple(effect.name for effect in EFFECTS))
    run = Run(
        "run",
        "",
        linear.SAMPLE_RATE,
        {"command": u, "displacement": np.zeros_like(u)},
        gain=cell.gain,
        specimen=Specimen(cell.mass, cell.stiffness, cell.damping),
        hold=hold,
    )
    known = {p.in_equations: p.value for p in model.parameters} | conditions(run, Actuator("", piston_area=PLANT.A))
    batch = {name: np.full((1, len(pairs)), value) for name, value in known.items()}
    strengths = {e.name: (e.added[0].in_equations, e.strength.symbol, SHARE * strength(e)) for e in EFFECTS}
    for i, pair in enumerate(pairs):
        for name in pair:
            symbol, _, value = strengths[name]
            batch[symbol][0, i] = value
    got = responses(model.chain, [run], batch, STEPS)[:, 0].T

    def wanted(pair: tuple[str, str]) -> np.ndarray:
        hidden = {f"{name}.{strengths[name][1]}": strengths[name][2] for name in pair}
        return reference.respond(PLANT, reference.named(hidden), cell, u, hold).displacement

    truth = each(wanted, pairs)
    return {
        frozenset(pair): float(np.std(ours - theirs) / np.std(theirs))
        for pair, ours, theirs in zip(pairs, got, truth, strict=True)
    }


@pytest.mark.parametrize(("number", "hold"), [(0, "linear"), (2, "zoh")])
def test_two_effects_at_once_agree_with_the_reference(number, hold, full):
    """All pairs, in the short form every eighth; friction that sticks to ten times the tolerance of the rest."""
    if hold == "zoh" and not full:
        pytest.skip("as many pairs again: run with --full")
    pairs = PAIRS if full else PAIRS[::SOME]
    assert {name for pair in pairs for name in pair} == {effect.name for effect in EFFECTS}
    found = deviations(CELLS[number], number, hold, pairs)
    allowed = {pair: FAR.get(pair, BOTH * max(CASES[name].close for name in pair)) for pair in found}
    assert {tuple(sorted(pair)): miss for pair, miss in found.items() if not miss < allowed[pair]} == {}
