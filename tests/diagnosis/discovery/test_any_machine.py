"""A search for terms on any machine and any data: what cannot be built or is not finite is left out, and counted."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

from ident.diagnosis.discovery.candidate_terms import places_of, terms_of_runs
from ident.diagnosis.discovery.search import TermSearch, _built
from ident.diagnosis.discovery.term import CURVE, STATE
from ident.diagnosis.discovery.term_to_effect import STRENGTH
from ident.presets import PRESETS
from ident.progress import silent
from tests.diagnosis.discovery.any_machine import KINDS, MACHINES, models_of, records, simulated


class Fitted:
    """What a candidate is added to."""

    effects = ()


def test_the_machines_are_every_preset_of_stages_and_twenty_more():
    assert {"qian2014", "strano", "specimen", "motor", "force_loop", "drive", "first_order", "open_valve"} <= {
        *MACHINES
    }
    assert len(MACHINES) == 34
    assert len(set(MACHINES)) == len(MACHINES)


def test_no_signal_of_a_machine_bears_the_name_of_a_number_of_a_term():
    """A term whose threshold h is a level of the machine could not be made an effect, and was left out in silence."""
    machines = [preset for name, preset in PRESETS.items() if name in MACHINES]
    assert len(machines) > 10
    assert not [preset.name for preset in machines if {STRENGTH, CURVE, STATE} & {*preset.chain.units}]


def test_a_term_adds_to_signals_alone():
    """In a valve of second order the rate of the spool is a state, which no effect of one's own can redefine."""
    assert "dq" in places_of(PRESETS["qian2014"])
    assert "dq" in PRESETS["strano"].core.states
    assert list(places_of(PRESETS["strano"])) == ["e", "w", "Q", "R", "y_fb", "y"]


@pytest.mark.parametrize("model", MACHINES)
def test_what_a_search_offers_can_be_built_whatever_the_data_are(model, full):
    """No exception and no warning, and every number is one; what is not to be had is counted.

    In the short form each preset and a sixth of the drawn machines has data of one kind, all kinds in turn; in the full
    one each machine has data of every kind.
    """
    if not full and model not in PRESETS and MACHINES.index(model) % 6:
        pytest.skip("like the others: run with --full")
    models, values = models_of(model)
    turn = MACHINES.index(model)
    tried = [(kind, curves) for kind in KINDS for curves in (False, True)]
    for kind, curves in tried if full else [(KINDS[turn % len(KINDS)], turn % 3 == 0)]:
        with np.errstate(all="ignore"):
            told = records(models, kind)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            offered = terms_of_runs(models, values, told, curves)
        assert 0 <= offered.left_out <= offered.looked_at
        assert offered.left_out == 0 or kind == "unstable"
        assert offered.candidates or curves or kind in ("noise-free", "unstable")
        for candidate in offered.candidates:
            assert np.isfinite([candidate.strength, candidate.share]).all(), (kind, candidate.equation)
            built = _built(models, Fitted, "proposed_1", candidate, offered)
            # Bounds of a strength of what is beyond any number are no numbers either: no effect can have them.
            assert built or kind == "unstable" or _closes_a_circle(models, candidate, offered), candidate.equation


def _closes_a_circle(models, candidate, offered) -> bool:
    """Whether each of two terms is an effect of the machine by itself, but both at once are not."""
    alone = [replace(candidate, terms=(term,), signs=(1.0,)) for term in candidate.terms]
    return len(alone) > 1 and all(_built(models, Fitted, "proposed_1", one, offered) for one in alone)


def test_terms_that_are_not_finite_are_counted():
    """Of data beyond any number there are some."""
    models, values = models_of("qian2014")
    with np.errstate(all="ignore"):
        told = records(models, "unstable")
    assert terms_of_runs(models, values, told).left_out > 0


def test_of_a_signal_at_rest_there_is_no_term():
    """The spool's rate stays zero in these records: a root of it over its size, which is none, would be no number."""
    models, values = models_of("machine:controller=p,of=velocity,valve=first,flow=to_speed,sensor=velocity")
    told = records(models, "noise-free")
    assert not any(record.signals["dq"].any() for record in told)
    assert terms_of_runs(models, values, told).left_out == 0


def test_a_residual_of_rounding_alone_is_not_explained():
    """A model that leaves nothing leaves nothing to a term either, and no number overflows."""
    models, values = models_of("specimen")
    told = tuple(replace(record, residual=1e-300 * record.residual) for record in records(models, "finite"))
    assert all(candidate.share < 1e-9 for candidate in terms_of_runs(models, values, told).candidates)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("model", MACHINES)
def test_a_whole_search_comes_to_its_end_whatever_the_data_are(model, kind, full):
    """From the values that the records were made with: it proposes a term, or says what it refused, or nothing."""
    if not full:  # 112 searches
        pytest.skip("half an hour: run with --full")
    models, values = simulated(model, kind)
    base = models.refit((), values)
    if not base.stable:
        pytest.skip("the machine is unstable in the middle of its search space")
    found = TermSearch(models, base, silent, given=(), asked=False, most=1).run()
    assert found.complete
    assert 0 <= found.left_out <= found.looked_at
    for one in found.proposals:
        assert np.isfinite([one.strength, one.nats, one.bar, one.error["fit"]]).all()
        assert one.nats > one.bar
