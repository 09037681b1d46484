"""What a diagnosis prints beside its tables."""

from __future__ import annotations

from types import SimpleNamespace

from app.cli.diagnosis_tables import show_diagnosis
from ident.diagnosis.proposals.proposal import Proposal


def test_the_command_that_adds_terms_names_the_effects_that_they_stand_beside(capsys):
    """A measured damper: without these the fit leaves 35 % where the diagnosis promised 12."""

    def printed(*beside: str) -> str:
        term = Proposal(place=("load",), equation="R = R + s * v**3", effect={}, error={"fit": 0.1}, beside=beside)
        show_diagnosis(SimpleNamespace(proposals=(term,), listings=list, seed=0, seconds=1.0))
        return " ".join(capsys.readouterr().out.split())

    assert "`servoident fit MATRIX --custom D.json` adds the terms" in printed()
    told = printed("specimen_hysteresis", "coulomb_friction")
    assert "--custom D.json --effect specimen_hysteresis --effect coulomb_friction` adds the terms" in told
