"""What a diagnosis prints beside its tables, and what a fit takes from one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from app.cli.diagnosis_tables import show_diagnosis
from app.cli.fit_options import settings
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Diagnosis, Rung, Verdict

STRENGTH = {"symbol": "s", "lower": -1e-10, "upper": 1e-10}
LEAK = {
    "name": "proposed_1",
    "place": "flow",
    "equation": ["Q = Q + s * abs(P)"],
    "strength": {**STRENGTH, "unit": "m^3/(s*Pa)"},
}
FORCE = {
    "name": "proposed_2",
    "place": "load",
    "equation": ["R = R + s * P"],
    "strength": {**STRENGTH, "unit": "N/Pa"},
}


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


def test_what_is_printed_ends_with_the_command_that_makes_the_recommended_fit(capsys):
    """By the file that the JSON was written to; where nothing is to be added there is none."""

    def printed(verdict: Verdict | None = None, **found: Any) -> str:
        show_diagnosis(
            Diagnosis(candidates=(), verdict=verdict or Verdict(), **found), Path("my data"), Path("out/found.json")
        )
        return " ".join(capsys.readouterr().out.split())

    values = {"Z0": ParameterEstimate(3e-6, "m^4/s", None, "Z0")}
    first = Rung(error={"fit": 0.2}, parameters=values)
    ladder = (first, Rung(added="dead_zone", error={"fit": 0.0463}, parameters=values))
    command = "`servoident fit 'my data' --start out/found.json` makes the fit with "
    assert f"{command}dead zone. It begins where the diagnosis ended, at an error of 4.63 %." in printed(ladder=ladder)
    against = printed(Verdict(standing="contradicted", contradicted_by=("dead_zone",)), ladder=ladder)
    assert command not in against
    assert "`servoident compare 'my data' --fit without.json --fit with.json`" in against
    told = printed(ladder=ladder, proposals=(term(LEAK, "coulomb_friction"),))
    assert (
        f"{command}Coulomb friction and proposed 1. It begins where the diagnosis ended, at an error of 10.0 %. --terms"
        in told
    )
    assert "--start" not in printed(ladder=(first,))


@pytest.mark.parametrize(
    ("terms", "beside"),
    [
        (None, ("specimen_hysteresis",)),
        (2, ("specimen_hysteresis",)),
        (1, ("specimen_hysteresis", "coulomb_friction")),
    ],
)
def test_a_fit_with_proposed_terms_has_the_effects_that_they_were_found_beside(diagnosis, terms, beside):
    """A measured damper: without these the fit leaves 35 % where the diagnosis promised 12."""
    given = ("qian2014", ["dead_zone"], "ga", None, None, "none", 0, None, [diagnosis])
    taken = ("proposed_1", "proposed_2")[:terms]
    assert settings(*given, terms=terms).effects == ("dead_zone", *beside, *taken)
    once = ("qian2014", ["specimen_hysteresis"], *given[2:])
    assert settings(*once, terms=terms).effects == (*beside, *taken)
