"""The error against the number of terms that a search proposes, and the choice of so many."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from app.cli.arguments import additions
from app.pages.diagnosis_view import missing
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.discovery.term_count_curve import term_count_curve
from ident.diagnosis.result import Rung
from ident.diagnosis.tables import proposal_rows
from ident.errors import Unusable
from tests.app.pages.test_diagnosis_view import found

LADDER = (
    Rung(added=None, error={"fit": 0.04, "verify": 0.05}, offset=None, nats=None, parameters={}),
    Rung(added="dead_zone", error={"fit": 0.03, "verify": 0.04}, offset=None, nats=20.0, parameters={}),
)


def term(number: int, error: float, shapes: int, instead_of: tuple[str, ...] = ()) -> Proposal:
    effect = {
        "name": f"proposed_{number}",
        "place": "flow",
        "equation": [f"Q = Q + s * P**{number + 1}"],
        "strength": {"symbol": "s", "unit": f"m^3/s/Pa^{number + 1}", "lower": -1.0, "upper": 1.0},
        "meaning": "proposed by search",
        "source": "proposed by search",
    }
    return Proposal(
        place=("flow",),
        equation=effect["equation"][0],
        effect=effect,
        shapes=shapes,
        error={"fit": error, "verify": error},
        instead_of=instead_of,
    )


TERMS = (term(1, 0.02, 1), term(2, 0.01, 2))


@pytest.mark.parametrize(("instead_of", "latest", "error"), [((), "dead_zone", 0.03), (("dead_zone",), "", 0.04)])
def test_none_of_the_terms_is_what_the_search_began_beside(instead_of, latest, error):
    none, one, both = term_count_curve([term(1, 0.02, 1, instead_of), TERMS[1]], LADDER)
    assert (none.terms, none.shapes, none.latest, none.error["fit"]) == (0, 0, latest, error)
    assert (one.terms, one.shapes, one.error["fit"]) == (1, 1, 0.02)
    assert (both.terms, both.shapes, both.latest, both.error["fit"]) == (2, 3, TERMS[1].equation, 0.01)
    assert term_count_curve([], LADDER) == ()


def test_terminal_and_page_show_the_error_against_the_number_of_terms():
    stored = found()
    stored = replace(stored, found=replace(stored.found, proposals=TERMS, ladder=LADDER))
    rows = list(proposal_rows(stored.found))
    assert [row[0] for row in rows] == ["0", "1", "2"]
    assert rows[0][1] == "(with dead_zone)"
    assert [row[4] for row in rows] == ["3.00 %", "2.00 %", "1.00 %"]
    assert [choice.terms for choice in missing(stored, None).choices] == [0, 1, 2]
    assert missing(found(), None).choices == ()


def test_so_many_terms_of_a_diagnosis_are_taken(tmp_path):
    file = tmp_path / "D.json"
    file.write_text(json.dumps(replace(found().found, proposals=TERMS).to_json()))
    assert [one["name"] for one in additions([file])[0].custom] == ["proposed_1", "proposed_2"]
    assert [one["name"] for one in additions([file], 1)[0].custom] == ["proposed_1"]
    for terms in (0, 3):
        with pytest.raises(Unusable, match="give 1 to 2"):
            additions([file], terms)
    with pytest.raises(Unusable, match="no diagnosis"):
        additions([], 1)
