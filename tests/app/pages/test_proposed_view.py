"""The card of a proposed term says what it stands instead of, and what that leaves where neither was fitted."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.pages.proposed_view import proposed
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.verification import Contradiction
from tests.app.pages.test_diagnosis_view import found

EFFECT = {"name": "proposed_1", "place": "load", "equation": ["R = R + s * (v**3)"]}
TERM = Proposal(place=("load",), equation="R = R + s * (v**3)", effect=EFFECT, error={"fit": 0.01, "verify": 0.02})


def card(verify: float | None, **of_term: object):
    stored = found()
    *steps, last = stored.found.ladder
    ladder = (*steps, replace(last, error={"fit": 0.01, "verify": verify}))
    (made,) = proposed(
        replace(stored, found=replace(stored.found, ladder=ladder, proposals=(replace(TERM, **of_term),))), None
    )
    return made


@pytest.mark.parametrize(
    ("names", "verify", "said"),
    [
        (("dead_zone",), 0.0158, "dead zone (error 1.58 % on validation data)"),
        (("dead_zone", "lead"), 0.0158, "dead zone, lead (error 1.58 % on validation data)"),
        (("dead_zone",), None, "dead zone"),
        ((), 0.0158, ""),
    ],
)
def test_what_it_stands_instead_of_is_said_with_what_that_leaves(names, verify, said):
    assert card(verify, instead_of=names).instead_of == said


def test_runs_to_verify_that_speak_against_it_are_said_first():
    against = Contradiction("proposed_1", 0.0158, 0.026, 3.1, ("dead_zone",))
    told = card(0.0158, instead_of=("dead_zone",), contradicted=against).against
    assert told.startswith("With it in place of dead zone the error on validation data rises from 1.58 % to 2.6")
    assert card(0.0158).against == ""


@pytest.mark.parametrize(("std_error", "determined"), [(1e-12, True), (15023e-12, False), (None, False)])
def test_a_term_whose_strength_is_not_determined_says_so_and_is_no_main_offer(std_error, determined):
    made = card(0.0158, strength=35e-12, std_error=std_error)
    assert made.determined is determined
    assert made.strength.startswith("not identifiable") is not determined
