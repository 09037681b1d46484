"""What a diagnosis prints beside its tables, and what a fit takes from one."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from app.cli.diagnosis_tables import show_diagnosis
from app.cli.fit_options import settings
from ident.diagnosis.proposals.proposal import Proposal
from ident.diagnosis.result import Diagnosis, Verdict

STRENGTH = {"symbol": "s", "lower": -1e-10, "upper": 1e-10}
LEAK = {
    "name": "proposed_1", "place": "flow", "equation": ["Q = Q + s * abs(P)"],
    "strength": {**STRENGTH, "unit": "m^3/(s*Pa)"},
}  # fmt: skip
FORCE = {
    "name": "proposed_2", "place": "load", "equation": ["R = R + s * P"], "strength": {**STRENGTH, "unit": "N/Pa"},
}  # fmt: skip


def term(effect: dict, *beside: str) -> Proposal:
    """A proposal of an effect, found beside others."""
    of = {"place": (effect["place"],), "equation": effect["equation"][0], "effect": effect, "error": {"fit": 0.1}}
    return Proposal(**of, beside=beside)


@pytest.fixture
def diagnosis(tmp_path) -> Path:
    """The JSON of a diagnosis that proposes two terms, with the second of which one effect is left out again."""
    terms = (term(LEAK, "specimen_hysteresis", "coulomb_friction"), term(FORCE, "specimen_hysteresis"))
    found = Diagnosis(candidates=(), verdict=Verdict(), proposals=terms, version="0.1.0", data_hash="abc")
    file = tmp_path / "D.json"
    file.write_text(json.dumps(found.to_json()))
    return file


def test_the_command_that_adds_terms_says_what_it_adds(capsys):
    def printed(*beside: str) -> str:
        show_diagnosis(SimpleNamespace(proposals=(term(LEAK, *beside),), listings=list, seed=0, seconds=1.0))
        return " ".join(capsys.readouterr().out.split())

    assert "`servoident fit MATRIX --custom D.json` adds the terms, with" in printed()
    assert "--custom D.json` adds the terms and what they stand beside, with" in printed("coulomb_friction")


@pytest.mark.parametrize(("terms", "beside"), [
    (None, ("specimen_hysteresis",)), (2, ("specimen_hysteresis",)), (1, ("specimen_hysteresis", "coulomb_friction")),
])  # fmt: skip
def test_a_fit_with_proposed_terms_has_the_effects_that_they_were_found_beside(diagnosis, terms, beside):
    """A measured damper: without these the fit leaves 35 % where the diagnosis promised 12."""
    given = ("qian2014", ["dead_zone"], "ga", None, None, "none", 0, None, [diagnosis])
    taken = ("proposed_1", "proposed_2")[:terms]
    assert settings(*given, terms=terms).effects == ("dead_zone", *beside, *taken)
    once = ("qian2014", ["specimen_hysteresis"], *given[2:])
    assert settings(*once, terms=terms).effects == (*beside, *taken)
